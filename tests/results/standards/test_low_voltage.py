"""Where the voltage is low: stretches below Umin1 (12 kV) and Umin2 (11 kV).

Steps of 1 min; trains go 1 km in each.

    train a    13   11.5  11.2  11.8  13    1 to 4 km below 12 kV, from 1 to 4 min
    train b    13   13    11.5  10.9  13    2 to 4 km below 12 kV from 2 to 4 min, 3 to 4 km below 11 kV
    train c    13   13    13    13    11.9  on another place, 20 to 21 km
"""

import numpy as np
import pytest

from tpss.results.standards.low_voltage import MOST_NAMES, find_low_voltage_places
from tpss.results.standards.voltage_limits import find_excursions
from tpss.scenario.standards import VoltageLimits

from made_up import made_up

LIMITS = VoltageLimits()
VOLTAGES = {
    "a": [13.0, 11.5, 11.2, 11.8, 13.0],
    "b": [13.0, 13.0, 11.5, 10.9, 13.0],
    "c": [13.0, 13.0, 13.0, 13.0, 11.9],
}
PLACES = {"a": np.arange(6.0), "b": np.arange(6.0), "c": np.arange(16.0, 22.0)}


def places_of(voltages=VOLTAGES, places=PLACES):
    dataset = made_up(voltage_kv=voltages, position_km={k: list(v) for k, v in places.items()})
    return find_low_voltage_places(find_excursions(dataset, LIMITS), LIMITS)


def test_a_row_a_stretch_of_line_the_graver_limit_first():
    found = [(each.limit, each.from_km, each.to_km, each.trains) for each in places_of()]
    assert found == [
        ("Umin2", 3.0, 4.0, "b"),
        ("Umin1", 1.0, 4.0, "a, b"),
        ("Umin1", 20.0, 21.0, "c"),
    ]


def test_it_says_how_low_when_and_how_long():
    """From 1 to 4 min at least one train was below 12 kV: 3 min, not 5."""
    _, low, _ = places_of()
    assert (low.limit_kv, low.lowest_kv, low.lowest_km, low.lowest_min) == (12.0, 10.9, 3.0, 3.0)
    assert (low.from_min, low.to_min, low.duration_min, low.train_count) == (1.0, 4.0, 3.0, 2)


def test_times_in_which_no_train_was_low_do_not_count():
    """One train at 1 to 2 min, the next at 4 to 5 min, in the same place: 2 min of 4."""
    voltages = {"a": [13.0, 11.5, 13.0, 13.0, 13.0], "b": [13.0, 13.0, 13.0, 13.0, 11.5]}
    places = {"a": [0.0, 1.0, 2.0, 3.0, 4.0, 5.0], "b": [0.0, 0.0, 0.0, 0.0, 1.0, 2.0]}
    (low,) = places_of(voltages, places)
    assert (low.from_min, low.to_min) == (1.0, 5.0)
    assert low.duration_min == pytest.approx(2.0)


def test_a_train_that_runs_towards_smaller_kilometres_covers_the_same_stretch():
    (low,) = places_of({"a": [13.0, 11.5, 11.5]}, {"a": [9.0, 8.0, 7.0, 6.0]})
    assert (low.from_km, low.to_km) == (6.0, 8.0)


def test_of_many_trains_some_are_named():
    many = {f"t{i}": [11.5, 11.5] for i in range(MOST_NAMES + 3)}
    (low,) = places_of(many, {name: [1.0, 2.0, 3.0] for name in many})
    assert low.train_count == MOST_NAMES + 3
    assert low.trains.startswith("t0, t1, ")
    assert low.trains.endswith(" and 3 more")


def test_a_line_without_low_voltage_has_no_such_place():
    assert places_of({"a": [15.0, 15.0]}, {"a": [0.0, 1.0, 2.0]}) == []
