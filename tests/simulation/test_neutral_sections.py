"""Neutral sections: trains pass them with their power off, and the contact line is parted there."""

import copy
from typing import Any

import numpy as np
import pytest

import tpss
from lines import line, network, run, scenario_of, service
from tpss import ScenarioError
from tpss.cli.notes import stuck
from tpss.model.build import build_model
from tpss.model.traffic import build_services
from tpss.results.stranded import stranded_trains

A_N, MASS_KG = 30e3, 600e3
"""Running resistance, the same at all speeds, and mass of the train."""

ENTRY_M_S = 90.0 / 3.6
NEUTRAL = {"line": "main", "from_km": 20.0, "to_km": 20.2, "raise_s": 5.0}
TRAIN = {
    "model": "Rc4-freight-1470t", "mass_t": 600.0, "resistance_a_n": A_N,
    "resistance_b_n_s_per_m": 0.0, "resistance_c_n_s2_per_m2": 0.0,
}  # fmt: skip


def document(
    step_min: float = 0.1, neutral: Any = NEUTRAL, origin: str = "A", **more: Any
) -> dict[str, Any]:
    """40 km of level track, fed at both ends; a train that holds 90 km/h from end to end."""
    destination = "B" if origin == "A" else "A"
    stations = {"A": 0.0, "M": 20.6, "B": 40.0}
    limits = [{"from_km": 0.0, "speed_kmh": 90.0}]
    made = line(40.0, stations, **{"speed_limits": limits, **more})
    found = network({"main": made}, [service("up", origin, destination)])
    found["trains"]["freight"] = dict(TRAIN)
    found["supply"]["converter_stations"].append(
        {"name": "end", "line": "main", "position_km": 40.0, "type": "Q48/Q49", "converters": 3}
    )
    found["supply"]["neutral_sections"] = [neutral] if neutral else []
    found["simulation"] = {"time_step_min": step_min, "until": "first-departure-arrives"}
    return copy.deepcopy(found)


def off_s(result: tpss.Result) -> np.ndarray:
    return result.dataset.time_without_power.to_numpy()[:-1, 0]


@pytest.mark.parametrize("origin", ["A", "B"])
@pytest.mark.parametrize("step_min", [0.01, 0.1, 0.5])
def test_a_train_coasts_through_and_for_the_time_of_switching_on(
    step_min: float, origin: str
) -> None:
    """Against R = 30 kN 600 t slow down by 0.05 m/s².

    It enters at 25 m/s and leaves after 200 m at √(625 - 2 · 0.05 · 200) = 24.597 m/s, that is after
    8.065 s; 5 s later it has power again: 13.065 s without, however long the steps and whichever way
    it runs.  Its trip takes longer than without the neutral section.
    """
    a = A_N / MASS_KG
    leaves = np.sqrt(ENTRY_M_S**2 - 2.0 * a * 200.0)
    result = run(document(step_min, origin=origin))
    assert off_s(result).sum() == pytest.approx((ENTRY_M_S - leaves) / a + 5.0, rel=1e-9)
    assert result.status == "finished"
    intact = run(document(step_min, neutral=None, origin=origin))
    assert "time_without_power" not in intact.dataset
    assert result.summary["trip_time_min"] > intact.summary["trip_time_min"]


def test_the_trip_is_the_same_whichever_way_it_runs() -> None:
    """The line and its neutral section are their own mirror images: 20 to 20.2 km against 19.8 to 20."""
    there = run(document())
    back = run(document(neutral={**NEUTRAL, "from_km": 19.8, "to_km": 20.0}, origin="B"))
    assert back.summary["trip_time_min"] == pytest.approx(there.summary["trip_time_min"], rel=1e-9)


def test_it_draws_nothing_there_and_its_voltage_counts_nowhere() -> None:
    """In steps of 0.6 s it has its power off all through most of 22 steps."""
    result = run(document(0.01))
    data = result.dataset.isel(train=0, time=slice(0, -1))
    whole = np.isclose(off_s(result), 0.6)
    assert whole.sum() in (20, 21)
    for name in ("active_power", "reactive_power", "tractive_force", "pantograph_voltage"):
        assert (data[name].to_numpy()[whole] == 0.0).all(), name
    volts = data.pantograph_voltage.to_numpy()
    lowest_kv = volts[volts > 0.0].min() / 1e3
    assert result.summary["lowest_voltage"]["voltage_kv"] == pytest.approx(lowest_kv)
    assert lowest_kv > 10.0


def test_auxiliaries_are_off_while_it_stands_before_power_is_back() -> None:
    """It stops for 1 min at 20.6 km; with 60 s to switch on its power is off for a part of the stop.

    From 400 m behind the section's end at 20.2 km it brakes and stands well before the 60 s are over.
    """
    scenario = document(0.01, neutral={**NEUTRAL, "raise_s": 60.0})
    scenario["traffic"][0]["stops"] = [{"station": "M", "dwell_min": 1.0}]
    result = run(scenario)
    data = result.dataset.isel(train=0, time=slice(0, -1))
    standing = (data.speed.to_numpy() == 0.0) & (data.position.to_numpy() == 20.6e3)
    power_w = data.active_power.to_numpy()[standing]
    whole = np.isclose(off_s(result)[standing], 0.6)
    assert 0 < whole.sum() < standing.sum()
    assert (power_w[whole] == 0.0).all()
    assert (power_w[off_s(result)[standing] == 0.0] > 0.0).all()
    assert off_s(result).sum() > 60.0


def test_the_contact_line_is_parted_there() -> None:
    """A train before it draws all of its power from the station before it, one behind from that behind.

    The other station feeds no more than the charging of its own stretch: nothing, of a contact line
    without capacitance.
    """
    result = run(document())
    km = result.dataset.position.to_numpy()[:-1, 0] / 1e3
    west, east = np.abs(result.dataset.station_active_power.to_numpy()[:-1]).T
    assert (east[km < 20.1] < 1.0).all()
    assert (west[km >= 20.1] < 1.0).all()
    assert west[km < 19.9].max() > 1e5
    nodes = result.dataset.node.to_numpy()
    assert any("20.1 km, before neutral section" in name for name in nodes)


def test_a_train_that_comes_to_stand_there_is_stranded() -> None:
    """Uphill by 20 ‰, 118 kN more, it slows by 0.25 m/s²: from 10 km/h, 2.8 m/s, it gets 16 m far.

    `tpss check` notes that beforehand, as it may have no more than 10 km/h there.
    """
    scenario = document(
        speed_limits=[{"from_km": 0.0, "speed_kmh": 90.0}, {"from_km": 19.0, "speed_kmh": 10.0}],
        gradients=[{"from_km": 0.0, "permille": 0.0}, {"from_km": 20.0, "permille": 20.0}],
    )
    made = scenario_of(scenario)
    (note,) = stuck(made, build_model(made)[0])
    assert "cannot coast through the neutral section at 20 km" in note
    assert "even at 10 km/h" in note
    scenario["simulation"] = {"time_step_min": 0.1, "duration_min": 60.0}
    result = run(scenario)
    (stood,) = stranded_trains(result.dataset)
    way_m = (10.0 / 3.6) ** 2 / 2.0 / ((A_N + MASS_KG * 9.81 * 0.02) / MASS_KG)
    assert stood.position_km == pytest.approx(20.0 + way_m / 1e3, abs=0.005)
    assert stood.to_the_end


def test_a_train_that_starts_before_it_has_no_more_speed_than_it_may_gain() -> None:
    """From a stop 10 m before it gains at most √(2 · 0.3 · 10) = 2.4 m/s, which 200 m need 4.5 m/s."""
    scenario = document(neutral={**NEUTRAL, "from_km": 20.61, "to_km": 20.81})
    scenario["trains"]["freight"]["max_acceleration_m_s2"] = 0.3
    scenario["traffic"][0]["stops"] = [{"station": "M", "dwell_min": 1.0}]
    made = scenario_of(scenario)
    (note,) = stuck(made, build_model(made)[0])
    assert "even at 9 km/h" in note
    scenario["traffic"][0]["stops"] = []
    made = scenario_of(scenario)
    assert list(stuck(made, build_model(made)[0])) == []


def test_supplements_are_found_with_it() -> None:
    """5 % more than a train needs that coasts through: by the run at stiff voltage it arrives so."""
    scenario = document()
    scenario["traffic"][0]["supplement_percent"] = 5.0
    slow, fast = run(scenario), run(document())
    ratio = slow.summary["trip_time_min"] / fast.summary["trip_time_min"]
    assert 1.0 < ratio < 1.06


def build(scenario: dict[str, Any]) -> None:
    made = scenario_of(scenario)
    build_services(made, build_model(made)[0])


def faults(scenario: dict[str, Any]) -> str:
    with pytest.raises(ScenarioError) as caught:
        build(scenario)
    return str(caught.value)


def test_a_stop_in_a_neutral_section_is_a_fault() -> None:
    scenario = document(neutral={**NEUTRAL, "from_km": 20.5, "to_km": 20.7})
    run(scenario)  # to pass the station is none
    scenario["traffic"][0]["stops"] = [{"station": "M", "dwell_min": 1.0}]
    words = faults(scenario)
    assert "traffic.0.stops.0.station" in words
    assert "in a neutral section, where no train can start" in words


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"to_km": 19.0}, "the neutral section ends at 19 km, and begins at 20 km"),
        ({"to_km": 41.0}, "outside the line"),
        ({"from_km": 39.9, "to_km": 40.0}, "the contact line is fed, tied, broken or ends in it"),
        ({"raise_s": -1.0}, "raise_s"),
        ({"line": "mian"}, "did you mean main"),
    ],
)
def test_bad_neutral_sections_are_named(change: dict[str, Any], words: str) -> None:
    assert words in faults(document(neutral={**NEUTRAL, **change}))


def test_two_that_overlap_are_a_fault() -> None:
    scenario = document()
    scenario["supply"]["neutral_sections"].append({**NEUTRAL, "from_km": 20.1, "to_km": 20.3})
    assert "overlaps supply.neutral_sections.0" in faults(scenario)


def test_stepped_motion_does_not_know_them() -> None:
    scenario = document()
    scenario["simulation"]["motion"] = "stepped"
    words = faults(scenario)
    assert "trains pass them for a part of a step" in words
    assert 'leave motion = "stepped" out' in words
