"""Violations of limits in words, the gravest rule first and within it the worst."""

import pytest

from tpss.results.standards.useful_voltage import Section, steps_in_window, train_table, zone_table
from tpss.results.standards.violations import (
    excursion_in_words,
    find_violations,
    kilovolts,
    minutes,
)
from tpss.results.standards.voltage_limits import find_excursions
from tpss.scenario.standards import VoltageLimits

from made_up import made_up

LIMITS = VoltageLimits()


def violations(voltages, limits=LIMITS, least_kv=None):
    dataset = made_up(voltage_kv=voltages, force_kn={name: [1.0] * 6 for name in voltages})
    window = steps_in_window(dataset, 0.0, None)
    return find_violations(
        find_excursions(dataset, limits),
        zone_table(dataset, [Section("all", "", 0.0, 10.0)], {"": (0.0, 10.0)}, window, least_kv),
        train_table(dataset, window, least_kv),
        limits,
    )


def test_a_violation_is_told_with_duration_limit_place_and_extreme():
    (found,) = violations({"eastbound 7": [13.0, 11.9, 11.4, 11.5, 11.8, 13.0]})
    assert found.words == (
        "train eastbound 7: 4.0 min below 12.0 kV near km 2.0 (lowest 11.40 kV at 2.0 min)"
    )
    assert (found.standard, found.rule) == ("EN 50163", "below Umin1 for more than 2 min")


def test_the_gravest_rule_comes_first_and_within_it_the_worst():
    found = violations(
        {
            "long": [11.9] * 6,
            "low": [13, 10.9, 13, 13, 13, 13],
            "lower": [13, 10.5, 13, 13, 13, 13],
            "high": [15, 18.5, 15, 15, 15, 15],
        }
    )
    assert [(each.subject, each.rule) for each in found] == [
        ("train lower", "below Umin2"),
        ("train low", "below Umin2"),
        ("train high", "above Umax2"),
        ("train long", "below Umin1 for more than 2 min"),
    ]


def test_a_stretch_that_the_run_cut_lasted_at_least_so_long():
    (found,) = violations({"a": [11.9, 11.9, 11.9, 13.0, 13.0, 13.0]})
    assert found.words.startswith("train a: at least 3.0 min below 12.0 kV")


def test_an_excursion_that_is_allowed_is_no_violation_but_has_words():
    voltages = {"a": [15.0, 17.5, 15.0, 15.0, 15.0, 15.0]}
    assert violations(voltages) == []
    (found,) = find_excursions(made_up(voltage_kv=voltages), LIMITS)
    assert excursion_in_words(found) == (
        "train a: 1.0 min above 17.25 kV near km 1.0 (highest 17.50 kV at 1.0 min)"
    )


def test_mean_useful_voltages_below_the_minimum_are_told_zones_first():
    found = violations({"a": [13.4] * 6, "b": [13.0] * 6, "c": [13.6] * 6}, least_kv=13.5)
    assert [each.words for each in found] == [
        "zone all: mean useful voltage 13.33 kV, below 13.5 kV",
        "train b: mean useful voltage 13.00 kV, below 13.5 kV",
        "train a: mean useful voltage 13.40 kV, below 13.5 kV",
    ]


@pytest.mark.parametrize(
    ("value", "words"), [(12.0, "12.0 kV"), (17.25, "17.25 kV"), (13.5, "13.5 kV")]
)
def test_a_limit_has_as_many_decimals_as_it_needs(value, words):
    assert kilovolts(value) == words


@pytest.mark.parametrize(
    ("value", "words"),
    [(4.5, "4.5 min"), (120.0, "120.0 min"), (0.05, "0.05 min"), (0.125, "0.12 min")],
)
def test_a_short_time_keeps_two_digits(value, words):
    assert minutes(value) == words
