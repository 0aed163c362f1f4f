"""Voltages at the pantograph against the limits of EN 50163.

Limits of 15 kV 16.7 Hz: Umin2 11 kV, Umin1 12 kV, Umax1 17.25 kV, Umax2 18 kV; at most 2 min below Umin1
and 5 min above Umax1. Steps of 1 min; trains go 1 km in each.

    train a    13  11.5  11.2  11.8  13   three minutes below 12 kV, 1 to 4 km, lowest 11.2 kV at 2 km
    train b    13  11.5  13    11.5  13   one minute twice: allowed
    train c    13  10.9  13    13    13   one minute below 11 kV, which no train may be
    train d    12  17.25 11.99 -     -    Umin1 and Umax1 may be permanent; it arrives after 3 min
"""

import numpy as np
import pytest

from tpss.results.standards.voltage_limits import bounds, find_excursions, voltage_table
from tpss.scenario.standards import VoltageLimits

from made_up import made_up, nan

LIMITS = VoltageLimits()
VOLTAGES = {
    "a": [13.0, 11.5, 11.2, 11.8, 13.0],
    "b": [13.0, 11.5, 13.0, 11.5, 13.0],
    "c": [13.0, 10.9, 13.0, 13.0, 13.0],
    "d": [12.0, 17.25, 11.99, nan, nan],
}
DATASET = made_up(voltage_kv=VOLTAGES)


def table(dataset, limits=LIMITS):
    found = find_excursions(dataset, limits)
    return voltage_table(dataset, found, limits).set_index("train")


def test_the_limits_are_those_of_the_standard_the_gravest_first():
    listed = [
        (bound.name, bound.limit_kv, bound.side, bound.allowed_min) for bound in bounds(LIMITS)
    ]
    assert listed == [
        ("Umin2", 11.0, "below", 0.0),
        ("Umax2", 18.0, "above", 0.0),
        ("Umin1", 12.0, "below", 2.0),
        ("Umax1", 17.25, "above", 5.0),
    ]


def test_an_excursion_says_when_where_and_how_far():
    (found,) = (each for each in find_excursions(DATASET, LIMITS) if each.train == "a")
    assert (found.limit, found.from_min, found.to_min, found.duration_min) == (
        "Umin1",
        1.0,
        4.0,
        3.0,
    )
    assert (found.from_km, found.to_km) == (1.0, 4.0)
    assert (found.extreme_kv, found.extreme_km, found.extreme_min) == (11.2, 2.0, 2.0)
    assert (found.cut, found.violation) == (False, True)


def test_times_and_longest_stretches_are_counted_for_each_train():
    low = table(DATASET)[["below_umin1_min", "longest_below_umin1_min", "below_umin2_min"]]
    assert low.to_numpy().tolist() == [[3, 3, 0], [2, 1, 0], [1, 1, 1], [1, 1, 0]]


def test_the_verdict_names_the_rules_that_were_broken():
    assert table(DATASET).verdict.to_dict() == {
        "a": "below Umin1 for more than 2 min",
        "b": "within the limits",
        "c": "below Umin2",
        "d": "within the limits",
    }


def test_lowest_and_highest_voltage_are_those_of_the_steps():
    row = table(DATASET).loc["d"]
    assert (row.lowest_kv, row.highest_kv) == (11.99, 17.25)


def test_two_minutes_are_allowed_whatever_the_time_step():
    """Twelve steps of a sixth of a minute; the thirteenth is too many."""
    for steps, verdict in ((12, "within the limits"), (13, "below Umin1 for more than 2 min")):
        voltages = {"a": [13.0] + [11.5] * steps + [13.0]}
        assert table(made_up(step_min=1.0 / 6.0, voltage_kv=voltages)).verdict["a"] == verdict


def test_five_minutes_above_are_allowed_and_none_above_umax2():
    voltages = {
        "a": [15.0] + [17.5] * 5 + [15.0],
        "b": [17.5] * 6 + [15.0],
        "c": [18.1] + [15.0] * 6,
    }
    found = table(made_up(voltage_kv=voltages))
    assert found.above_umax1_min.tolist() == [5.0, 6.0, 1.0]
    assert found.verdict.tolist() == [
        "within the limits",
        "above Umax1 for more than 5 min",
        "above Umax2",
    ]


def test_a_stretch_that_the_run_cuts_says_so():
    cut = {each.train: each.cut for each in find_excursions(
        made_up(voltage_kv={"a": [11.5, 13, 13], "b": [13, 13, 11.5], "c": [13, 11.5, 13]}), LIMITS
    )}  # fmt: skip
    assert cut == {"a": True, "b": True, "c": False}


def test_absent_trains_are_beyond_no_limit():
    found = table(made_up(voltage_kv={"a": [nan, 13.0], "b": [nan, nan]}))
    assert found.verdict.to_dict() == {"a": "within the limits", "b": ""}
    assert np.isnan(found.loc["b"].lowest_kv)


def test_other_limits_give_another_verdict():
    limits = VoltageLimits(umin1_kv=11.0, longest_low_min=0.0)
    assert table(DATASET, limits).verdict["a"] == "within the limits"
    assert table(DATASET, limits).verdict["c"] == "below Umin2; below Umin1"


@pytest.mark.parametrize("limit", ["umin2", "umin1"])
def test_time_below_a_limit_is_that_of_a_slow_count(limit):
    voltages = np.random.default_rng(1).uniform(10.0, 14.0, (3, 50))
    dataset = made_up(step_min=0.5, voltage_kv=dict(zip("abc", voltages.tolist(), strict=True)))
    limit_kv = getattr(LIMITS, f"{limit}_kv")
    longest = [
        0.5 * max(len(run) for run in "".join("x" if v < limit_kv else " " for v in row).split())
        for row in voltages
    ]
    found = table(dataset)
    assert found[f"below_{limit}_min"].tolist() == pytest.approx(
        (0.5 * (voltages < limit_kv).sum(axis=1)).tolist()
    )
    assert found[f"longest_below_{limit}_min"].tolist() == pytest.approx(longest)
