"""Protection: stations that pass an overload trip, and what they carried goes to the others."""

import copy

import numpy as np
import pytest

import tpss
from faults import faults_of, finding_at
from tpss import library
from tpss.results.notes import notes

from properties.rules import keep_the_rules

Q48 = library.values("converters", "Q48/Q49")

THREE = {
    "format": 1, "name": "three",
    "simulation": {"time_step_min": 0.1, "duration_min": 60.0},
    "line": {
        "length_km": 80.0, "gradients": [{"from_km": 0.0, "permille": 2.0}],
        "speed_limits": [{"from_km": 0.0, "speed_kmh": 100.0}],
        "stations": [{"name": "A", "position_km": 0.0}, {"name": "B", "position_km": 80.0}],
    },
    "supply": {"catenary": "AT", "converter_stations": []},
    "trains": {"freight": {"model": "Rc4-freight-1470t", "mass_t": 900.0}},
    "traffic": [
        {"name": "up", "train": "freight", "from": "A", "to": "B", "headway_min": 6.0,
         "already_running": True}
    ],
}  # fmt: skip


def station(name: str, position_km: float, percent: float, minutes: float = 5.0, mva: float = 5.0):
    """One converter that bears a load for some minutes."""
    rating = {
        "time_constant_min": 30.0, "overloads": [{"percent": percent, "minutes": minutes}],
    }  # fmt: skip
    kind = {**Q48, "rating_mva": mva, "rating": rating}
    return {"name": name, "position_km": position_km, "type": kind, "converters": 1}


WEAK_MIDDLE = (
    station("West", 0.0, 900.0),
    station("Middle", 40.0, 101.0, mva=4.0),
    station("East", 80.0, 900.0),
)


def simulated(*stations, trip: bool = True, **changes) -> tpss.Result:
    document = copy.deepcopy(THREE)
    document["supply"]["converter_stations"] = list(stations)
    document["protection"] = {"trip": trip}
    document |= changes
    result = tpss.simulate(tpss.Scenario.from_document(document, "three"))
    keep_the_rules(result)
    return result


def loads(result: tpss.Result) -> np.ndarray:
    return result.dataset.converter_loading.to_numpy()[:-1]


def slow_trip_min(load: np.ndarray, step_min: float, percent: float, minutes: float) -> float:
    """The first instant at which the mean square over the minutes before it is above what is allowed."""
    per_window = round(minutes / step_min)
    for k in range(len(load)):
        begun = load[max(0, k + 1 - per_window) : k + 1]
        if (begun**2).sum() / per_window > (percent / 100.0) ** 2:
            return (k + 1) * step_min
    return np.inf


def test_a_station_trips_when_its_overload_is_passed_and_the_others_carry_its_load():
    """Middle alone has a weak converter.  When it trips is found once more from the run without
    protection; up to then both runs are the same, and after it Middle feeds nothing."""
    free, tripped = simulated(*WEAK_MIDDLE, trip=False), simulated(*WEAK_MIDDLE)
    (trip,) = tripped.summary["trips"]
    assert trip["station"] == "Middle"
    assert trip["time_min"] == pytest.approx(slow_trip_min(loads(free)[:, 1], 0.1, 101.0, 5.0))
    step = round(trip["time_min"] / 0.1)
    assert np.array_equal(loads(tripped)[:step], loads(free)[:step], equal_nan=True)
    power_mw = tripped.dataset.station_active_power.to_numpy()[:-1] / 1e6
    assert np.abs(power_mw[step:, 1]).max() == 0.0
    before_mw = free.dataset.station_active_power.to_numpy()[:-1] / 1e6
    assert power_mw[step, [0, 2]].sum() > before_mw[step, [0, 2]].sum() + 1.0
    assert any("protection, 1: Middle tripped" in note for note in notes(tripped))


def test_a_cascade_darkens_the_line_one_station_after_the_other():
    """Each station bears what it carries of the whole line, and not what one that has tripped leaves."""
    stations = [
        station("West", 0.0, 160.0, 2.0), station("Middle", 40.0, 101.0, mva=4.0),
        station("East", 80.0, 160.0, 2.0),
    ]  # fmt: skip
    result = simulated(*stations)
    names = [trip["station"] for trip in result.summary["trips"]]
    times = [trip["time_min"] for trip in result.summary["trips"]]
    assert names[0] == "Middle"
    assert sorted(names) == ["East", "Middle", "West"]
    assert times == sorted(times)
    last = result.dataset.station_active_power.to_numpy()[-2]
    assert np.abs(last).max() == 0.0


def test_a_trip_does_not_depend_on_the_step():
    """Loads of a step hold all through it; half the step moves the trip by a step at most."""
    times = []
    for step_min in (0.1, 0.05):
        simulation = {"time_step_min": step_min, "duration_min": 60.0}
        (trip,) = simulated(*WEAK_MIDDLE, simulation=simulation).summary["trips"]
        times.append(trip["time_min"])
    assert times[1] == pytest.approx(times[0], abs=0.2)


def test_trips_follow_an_outage():
    """With West out from the second step on, Middle carries more, and trips earlier than without."""
    outage = {"name": "no West", "stations": ["West"], "from_min": 0.1}
    simulation = {"time_step_min": 0.1, "duration_min": 60.0, "outage": "no West"}
    (alone,) = simulated(*WEAK_MIDDLE).summary["trips"][:1]
    first = simulated(*WEAK_MIDDLE, outages=[outage], simulation=simulation).summary["trips"][0]
    assert first["station"] == "Middle"
    assert first["time_min"] < alone["time_min"]


def test_without_overloads_and_with_steps_protection_is_a_fault():
    with pytest.raises(tpss.ScenarioError, match="no feeding station has a rating with overloads"):
        simulated({"name": "West", "position_km": 0.0, "type": "Q48/Q49", "converters": 2})
    stepped = {"protection.trip": True, "simulation.motion": "stepped"}
    assert finding_at("protection.trip", faults_of(stepped))
