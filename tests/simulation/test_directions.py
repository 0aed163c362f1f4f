"""Trains towards falling kilometres, alone and among others that come towards them."""

import copy
from typing import Any

import numpy as np
import pytest

import tpss
from faults import faults_of, finding_at
from tpss.many import key_figures
from tpss.results.notes import notes
from tpss.sweep.inputs import inputs_of

from properties.kilometres import mirrored
from properties.rules import keep_the_rules
from scenarios import BUSY, COLD, SHORT_LINE, run

SAME = 1e-8
"""A mirrored position is rounded otherwise: by 4 nm, of metres that a train travels in a step."""

LONG: dict[str, Any] = copy.deepcopy(BUSY)
"""The busy line, with trains of 400 m, curves, limits that differ by direction and continuous motion."""
LONG["simulation"] = {"time_step_min": 0.07}
LONG["trains"]["freight"]["length_m"] = 400.0
LONG["line"]["curves"] = [{"from_km": 2.0, "to_km": 3.0, "radius_m": 400.0}]
LONG["line"]["speed_limits_down"] = [
    {"from_km": 0.0, "speed_kmh": 40.0},
    {"from_km": 9.0, "speed_kmh": 70.0},
]


def scenario_of(document: dict[str, Any]) -> tpss.Scenario:
    return tpss.Scenario.from_document(copy.deepcopy(document), "line")


@pytest.mark.parametrize("document", [BUSY, LONG, COLD], ids=["busy", "long trains", "capacitive"])
def test_a_mirrored_line_with_mirrored_trains_gives_the_same(document):
    """km to 20 - km: what ran up runs down, and what climbed falls towards rising kilometres."""
    there, here = (
        tpss.simulate(scenario_of(mirrored(document))),
        tpss.simulate(scenario_of(document)),
    )
    keep_the_rules(there)
    assert there.status == here.status == "finished"
    length_m = 1e3 * document["line"]["length_km"]
    for name in ("speed", "pantograph_voltage", "active_power", "gradient_force", "braking_force"):
        most = float(np.abs(here.dataset[name]).max())
        np.testing.assert_allclose(
            there.dataset[name], here.dataset[name], atol=SAME * most, rtol=0
        )
    np.testing.assert_allclose(there.dataset.position, length_m - here.dataset.position, atol=1e-4)
    columns = ["energy_mwh", "distance_km", "lowest_voltage_kv", "departure_min", "arrival_min"]
    expected = here.trips[columns].to_numpy(dtype=float)
    np.testing.assert_allclose(there.trips[columns].to_numpy(dtype=float), expected, rtol=SAME)
    times = ["arrival_min", "departure_min", "dwell_min"]
    np.testing.assert_allclose(there.stops[times], here.stops[times], rtol=SAME)


def test_trains_of_both_directions_meet_in_the_middle_of_a_symmetrical_line():
    """Two trains that leave the ends at once: at each instant they stand alike, and draw alike."""
    back = {**SHORT_LINE["traffic"][0], "name": "back", "from": "East", "to": "West"}
    result = run({"traffic": [SHORT_LINE["traffic"][0], back]})
    data = result.dataset
    up, down = (data.sel(train=name) for name in ("eastbound 1", "back 1"))
    np.testing.assert_allclose(up.position, 20e3 - down.position, atol=1e-6)
    np.testing.assert_allclose(up.pantograph_voltage, down.pantograph_voltage, rtol=1e-9)
    (said,) = [note for note in notes(result) if "passed through each other" in note]
    assert "once, first eastbound 1 and back 1 near 10.0 km at " in said


def test_trains_of_one_direction_that_keep_their_order_pass_nobody():
    result = run({"traffic.0.headway_min": 5.0})
    assert not [note for note in notes(result) if "passed through each other" in note]


def test_limits_of_the_other_direction_are_its_own():
    """20 km at 40 km/h where trains up may run 60: never above, and half as long again."""
    back = {"traffic.0.from": "East", "traffic.0.to": "West"}
    slow = {"line.speed_limits_down": [{"from_km": 0.0, "speed_kmh": 40.0}]}
    up, alike, slower = run(slow), run(back), run({**back, **slow})
    assert float(up.dataset.speed.max()) * 3.6 == pytest.approx(60.0)
    assert alike.summary["trip_time_min"] == pytest.approx(up.summary["trip_time_min"], rel=1e-9)
    assert float(slower.dataset.speed.max()) * 3.6 == pytest.approx(40.0)
    assert slower.summary["trip_time_min"] > 1.4 * up.summary["trip_time_min"]


def test_the_key_figures_of_many_runs_are_those_of_single_ones_down_the_line_too():
    scenario = scenario_of(mirrored(BUSY))
    figures = key_figures(scenario)
    summary = tpss.simulate(scenario).summary
    assert figures.trip_time_min == pytest.approx(summary["trip_time_min"], rel=1e-12)
    assert figures.lowest_voltage.position_km == summary["lowest_voltage"]["position_km"]


def test_a_route_without_length_is_a_fault():
    finding = finding_at("traffic.0.to", faults_of({"traffic.0.to": "West"}))
    assert "begin and end at the same place" in finding.problem


def test_stops_and_trains_on_the_line_are_in_the_order_of_travel():
    back = {"traffic.0.from": "East", "traffic.0.to": "West"}
    stops = [{"station": "Middle", "dwell_min": 1.0}]
    placed = [{"position_km": 20.0, "speed_kmh": 0.0}, {"position_km": 0.0, "speed_kmh": 0.0}]
    assert run({**back, "traffic.0.stops": stops}).status == "finished"
    with pytest.raises(tpss.ScenarioError, match=r"not between East .* and West") as caught:
        run({**back, "traffic.0.initial_trains": placed})
    assert [each.key for each in caught.value.findings] == [
        "traffic.0.initial_trains.1.position_km"
    ]


def test_inputs_of_a_study_are_those_that_its_studied_train_meets():
    """The train that runs down the mirrored line meets the same gradients, limits and distances."""
    rising = copy.deepcopy(BUSY)
    rising["line"]["speed_limits_down"] = [{"from_km": 0.0, "speed_kmh": 45.0}]
    here, there = (inputs_of(scenario_of(each)) for each in (rising, mirrored(rising)))
    for name, value in here._asdict().items():
        expected = value if isinstance(value, str) else pytest.approx(value, rel=1e-9, nan_ok=True)
        assert getattr(there, name) == expected, name
