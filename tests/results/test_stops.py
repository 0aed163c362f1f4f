"""Times at the stops of every train."""

import numpy as np
import pytest

import tpss

from scenarios import run, short_line

BRAKING = ["whole-steps", "within-step"]


def stopping(dwell_min: float = 1.0, **changes) -> tpss.Result:
    """A train from West to East that stops at Middle."""
    stop = {"station": "Middle", "dwell_min": dwell_min}
    return run({"simulation.time_step_min": 0.1, "traffic.0.stops": [stop], **changes})


@pytest.mark.parametrize("braking", BRAKING)
@pytest.mark.parametrize("step_min", [0.05, 0.3])
def test_a_train_arrives_at_a_stop_when_it_would_arrive_if_its_journey_ended_there(
    braking, step_min
):
    options = {"simulation.braking": braking, "simulation.time_step_min": step_min}
    table = stopping(**options).stops.set_index("station")
    ends_there = run({**options, "traffic.0.to": "Middle"}).trips.arrival_min[0]
    assert table.arrival_min["Middle"] == pytest.approx(ends_there, abs=1e-9)


@pytest.mark.parametrize("braking", BRAKING)
def test_a_row_a_train_and_stop_from_departure_to_arrival(braking):
    """Dwells of 1 min are ten steps; the train stands from its arrival within a step on."""
    result = stopping(**{"simulation.braking": braking, "traffic.0.first_departure_min": 2.0})
    table = result.stops
    assert table.station.to_list() == ["West", "Middle", "East"]
    assert table.position_km.to_list() == [0.0, 10.0, 20.0]
    assert np.isnan(table.arrival_min[0])
    assert np.isnan(table.departure_min[2])
    assert table.departure_min[0] == 2.0
    assert table.arrival_min[2] == pytest.approx(result.trips.arrival_min[0])
    stood_min = np.ceil(table.arrival_min[1] * 10 - 1e-6) / 10 - table.arrival_min[1]
    assert table.dwell_min[1] == pytest.approx(1.0 + stood_min)
    assert table.departure_min[1] == pytest.approx(table.arrival_min[1] + table.dwell_min[1])
    if braking == "whole-steps":
        assert table.dwell_min[1] == pytest.approx(1.0)


def test_equal_distances_between_stops_take_equal_times():
    """Every 4 km at 0.02 min: each leg takes as long as the first."""
    places = [4.0, 8.0, 12.0, 16.0]
    result = run(
        {
            "simulation.time_step_min": 0.02,
            "simulation.braking": "within-step",
            "line.stations": [
                {"name": f"H{i}", "position_km": km} for i, km in enumerate([0.0, *places, 20.0])
            ],
            "traffic.0.from": "H0",
            "traffic.0.to": "H5",
            "traffic.0.stops": [{"station": f"H{i}", "dwell_min": 0.5} for i in range(1, 5)],
        }
    )
    table = result.stops
    legs = table.arrival_min.to_numpy()[1:] - table.departure_min.to_numpy()[:-1]
    assert legs == pytest.approx(np.full(5, legs[0]), abs=0.02)


def test_what_has_not_happened_within_the_run_is_not_a_number():
    reached, left = stopping().stops.loc[1, ["arrival_min", "departure_min"]]
    before = stopping(**{"simulation.duration_min": float(np.floor(reached))}).stops
    assert before.arrival_min.isna().all()
    assert before.departure_min[1:].isna().all()
    dwelling = stopping(**{"simulation.duration_min": round(left - 0.5, 1)}).stops
    assert dwelling.arrival_min[1] == reached
    assert np.isnan(dwelling.departure_min[1])
    assert np.isnan(dwelling.arrival_min[2])


def test_a_train_on_the_line_at_the_start_has_no_departure_nor_stops_behind_it():
    placed = {"traffic.0.initial_trains": [{"position_km": 12.0, "speed_kmh": 50.0}]}
    late = {"traffic.0.first_departure_min": 15.0, "simulation.duration_min": 12.0}
    table = tpss.simulate(
        short_line({**placed, **late, "traffic.0.stops": [{"station": "Middle", "dwell_min": 1.0}]})
    ).stops
    assert table.train.unique().tolist() == ["eastbound initial 1"]
    assert table[["arrival_min", "departure_min"]].iloc[:2].isna().all(axis=None)
    assert 8.0 < table.arrival_min[2] < 12.0
