"""Who departs when, who is on the line from the start, who stands where another train stands.

Rules: a train departs at the first t_k ≥ its time - 1e-6 s; entries act in file order; trains that run
already take the state of a lone train at nominal voltage at its step round(n headway/h); trains closer
than a metre count as a metre apart; trains at the same place pass each other.
"""

import math
from typing import Any

import numpy as np
import pytest

from tpss.model import build_model
from tpss.model.traffic import build_services
from tpss.results.notes import notes
from tpss.run.run import Run
from tpss.run.services import ScheduledTrain, departing_trains
from tpss.step.model import RunControl
from tpss.vehicle.train import Motion, Phase, Plan

from scenarios import journey, limits, phases, run, short_line, stops

LIGHT = {"trains.freight.mass_t": 100.0}
TWO_KINDS = {
    "trains.slow": {"model": "Rc4-freight-1470t", "max_speed_kmh": 40.0},
    "trains.fast": {"model": "Rc4-freight-1470t", "mass_t": 300.0, "max_speed_kmh": 60.0},
}


def step(minutes: float) -> dict[str, float]:
    return {"simulation.time_step_min": minutes}


def entry(name: str, train: str, begin: str, end: str, *departures_min: float) -> dict[str, Any]:
    times = list(departures_min)
    return {"name": name, "train": train, "from": begin, "to": end, "departures_min": times}


def test_the_last_fields_of_a_train_are_those_of_its_motion_and_its_plan():
    """So a train that already runs takes them over one after the other."""
    fields = [*Motion.dtype.names, *(f"plan_{name}" for name in Plan.dtype.names)]
    assert list(ScheduledTrain._fields[-len(fields) :]) == fields


@pytest.mark.parametrize("step_min", [0.01, 0.3, 0.4, 1.0, 5.0])
def test_departures_of_a_list_and_of_a_headway(step_min):
    """Times that are no multiples of the step wait for the next instant, others do not."""
    listed = [0.0, 1.03, 7.5, 12.0]
    listing = {**entry("listed", "freight", "Middle", "East", *listed)}
    repeated = {**listing, "name": "repeated", "headway_min": 3.7, "first_departure_min": 0.9}
    del repeated["departures_min"]
    result = run(
        {**step(step_min), "traffic": [listing, repeated], "simulation.duration_min": 15.0}
    )
    for service, times in (("listed", listed), ("repeated", [0.9, 4.6, 8.3, 12.0])):
        found = result.trips.departure_min[result.trips.service == service]
        due = [step_min * math.ceil(time / step_min - 1e-9) for time in times]
        assert found.to_list() == pytest.approx([time for time in due if time < 15.0])


def test_a_headway_shorter_than_a_step_lets_two_trains_depart_at_an_instant():
    """0.4 min at steps of a minute: 0, 0.4, 0.8 -> 0, 1, 1; 1.2, 1.6, 2.0 -> 2, 2, 2."""
    result = run({**step(1.0), "simulation.duration_min": 3.0, "traffic.0.headway_min": 0.4})
    assert result.trips.departure_min.to_list() == [0.0, 1.0, 1.0, 2.0, 2.0, 2.0]


def test_trains_that_depart_together_run_side_by_side():
    """Three trains of one kind, two from one entry, at the same place at every instant.  A metre of
    line between neighbours is all that tells their voltages from each other: 0.29 mΩ · 100 A."""
    changes = {
        **step(0.1),
        "simulation.duration_min": 10.0,
        "traffic": [
            entry("a", "freight", "West", "East", 0.0),
            entry("b", "freight", "West", "East", 0.0, 1e-9),
        ],
    }
    result = run(changes)
    first, *others = (journey(result, name) for name in ("a 1", "b 1", "b 2"))
    for other in others:
        assert other.x == pytest.approx(first.x, abs=1e-3)
    volts = result.dataset.pantograph_voltage.to_numpy()[:-1]
    assert np.ptp(volts, axis=1).max() < 0.5
    assert result.summary["limited"]["short_piece"] == 2 * 100 + 1  # and the station at the start
    (note,) = [each for each in notes(result) if "closer" in each]
    assert note.startswith("trains stood closer than 1 m to each other and counted as 1 m apart")
    assert "in 200 train-steps, first a 1 and b 1 at 0.00 min" in note


def test_a_fast_train_overtakes_a_slow_one():
    """40 and 60 km/h, two minutes apart: the slow one leads by 1.3 km until the fast one has passed."""
    changes = {
        **step(0.1),
        **TWO_KINDS,
        "traffic": [
            entry("slow", "slow", "West", "East", 0.0),
            entry("fast", "fast", "West", "East", 2.0),
        ],
    }
    result = run({**changes, "simulation.duration_min": 40.0})
    lead = result.dataset.position.sel(train="slow 1") - result.dataset.position.sel(train="fast 1")
    lead = lead.dropna("time").to_numpy()
    assert lead[0] > 0.0
    assert lead[-1] < 0.0
    assert (np.diff(np.sign(lead)) != 0).sum() == 1
    assert result.trips.arrival_min.notna().all()
    assert (
        phases(result, "slow 1") == phases(result, "fast 1") == ["motoring", "braking", "arrived"]
    )


def test_an_overtaken_train_stands_at_its_stop_meanwhile():
    """The slow train dwells at the middle while the fast one passes it there, at the same place."""
    slow = entry("slow", "slow", "West", "East", 0.0)
    slow["stops"] = [{"station": "Middle", "dwell_min": 10.0}]
    changes = {**step(0.05), **TWO_KINDS, "simulation.duration_min": 40.0}
    result = run({**changes, "traffic": [slow, entry("fast", "fast", "West", "East", 9.0)]})
    standing = journey(result, "slow 1")
    dwelling = np.flatnonzero(result.dataset.train_state.sel(train="slow 1") == 4)
    passed = result.dataset.position.sel(train="fast 1").to_numpy()[dwelling]
    assert passed[0] < 10_000.0 < passed[-1]
    assert set(standing.x[standing.state == 4]) == {10_000.0}


def test_entries_differ_in_train_way_stops_and_timetable():
    here = entry("here", "fast", "Middle", "East", 0.0, 4.0)
    there = entry("there", "slow", "West", "Middle", 1.0)
    through = {**entry("through", "freight", "West", "East", 0.5)}
    through["stops"] = [{"station": "Middle", "dwell_min": 1.0}]
    changes = {**step(0.1), **TWO_KINDS, "traffic": [here, there, through]}
    result = run({**changes, "simulation.duration_min": 45.0})
    assert result.trips.train.to_list() == ["here 1", "through 1", "there 1", "here 2"]
    assert result.trips.arrival_min.notna().all()
    assert result.trips.distance_km.to_list() == pytest.approx([10.0, 20.0, 10.0, 10.0])
    assert "dwelling" in phases(result, "through 1")
    assert "dwelling" not in phases(result, "there 1")
    assert journey(result, "there 1").v.max() == pytest.approx(40 / 3.6)


def test_the_studied_train_is_the_first_of_the_first_entry():
    """It ends the run, though trains of other entries arrive before it and later."""
    changes = {
        **step(0.1),
        **TWO_KINDS,
        "traffic": [
            entry("slow", "slow", "Middle", "East", 3.0, 4.0),
            entry("fast", "fast", "Middle", "East", 0.0, 10.0),
        ],
    }
    result = run(changes)
    assert result.summary["studied_train"] == "slow 1"
    end_min = float(result.dataset.time[-1]) / 60.0
    assert result.trips.arrival_min[result.trips.train == "slow 1"].item() == pytest.approx(end_min)
    assert result.summary["trip_time_min"] == pytest.approx(end_min - 3.0)


def lone_train(changes: dict[str, Any]) -> Run:
    """A train alone at 15 kV, which trains that run already are copied from."""
    model, _ = build_model(short_line(changes))
    service = build_services(short_line(changes), model)[0]
    control = RunControl(fixed_voltage_v=15_000.0, studied_train=0)
    trains = departing_trains([service], model.options, 0, 1)
    return Run(model._replace(control=control), trains, 10_000)


RUNNING = {
    "simulation.duration_min": 6.0,
    "traffic.0.already_running": True,
    "traffic.0.headway_min": 2.9,
    **stops((5.0, 4.0), (12.0, 0.0)),
}


@pytest.mark.parametrize("step_min", [0.05, 0.4, 1.0])
def test_trains_run_already_where_a_lone_train_would_be(step_min):
    """The n-th at its step round(n · 174 s / h): its place and its speed."""
    changes = {**step(step_min), **RUNNING}
    alone, result = lone_train(changes), run(changes)
    named = [name for name in result.trips.train if " initial " in name]
    x, v = (result.dataset[name].isel(time=0) for name in ("position", "speed"))
    expected = []
    for n in range(1, 20):
        alone.advance_to(round(n * 174.0 / (60.0 * step_min)))
        train = alone.state.trains[0]
        if train.timetable.arrival_step < 0:
            expected.append((train.motion.position_m, train.motion.speed_m_s))
    assert len(expected) > 5
    assert [(float(x.sel(train=t)), float(v.sel(train=t))) for t in named] == expected


def test_a_train_that_runs_already_dwells_for_the_rest_of_its_time():
    """A dwell of 4 min, and a train a headway behind another all along it: one has already dwelled
    for a time that its next neighbours tell; together with what it dwells now that is 4 min."""
    step_min = 0.05
    changes = {**step(step_min), **RUNNING}
    alone, result = lone_train(changes), run(changes)
    begun = 0
    while alone.state.trains[0].motion.phase != Phase.DWELLING:
        begun += 1
        alone.advance_to(begun)
    n = math.ceil(begun * step_min / 2.9)
    gone = round(n * 2.9 / step_min) - begun
    assert 0 < gone < 80
    way = journey(result, f"eastbound initial {n}")
    dwelling = way.state == 4
    assert dwelling[0]
    assert dwelling.sum() == 80 - gone
    assert set(way.x[dwelling]) == {5_000.0}


def test_a_train_that_runs_already_goes_on_with_its_braking_plan():
    """Which does not depend on the voltage: it moves as the lone train did, and stops exactly."""
    step_min = 0.05
    changes = {**step(step_min), **RUNNING}
    alone, way_of_lone = lone_train(changes), []
    while alone.state.trains[0].motion.phase != Phase.DWELLING:
        way_of_lone.append(
            (
                float(alone.state.trains[0].motion.position_m),
                int(alone.state.trains[0].motion.phase),
            )
        )
        alone.advance_to(len(way_of_lone))
    planned = [k for k, (_, phase) in enumerate(way_of_lone) if phase == Phase.PLANNED]
    middle = planned[len(planned) // 2]
    result = run({**changes, "traffic.0.headway_min": middle * step_min})
    way = journey(result, "eastbound initial 1")
    rest = [place for place, _ in way_of_lone[middle:]]
    assert way.x[: len(rest)] == pytest.approx(rest, abs=1e-9)
    assert way.x[len(rest)] == 5_000.0


def test_trains_run_already_between_departures_that_begin_later():
    """First departure at 1 min, headway 2.9 min: the trains before it left 1.9, 4.8, ... min ago."""
    changes = {**step(0.1), **RUNNING, "traffic.0.first_departure_min": 1.0}
    alone, result = lone_train({**changes, "traffic.0.first_departure_min": 0.0}), run(changes)
    alone.advance_to(19)
    first = float(result.dataset.position.isel(time=0).sel(train="eastbound initial 1"))
    assert first == alone.state.trains[0].motion.position_m


def test_placed_trains_stand_or_run_anywhere_on_their_way():
    """Standing at the start, at a stop (heading for the next), between stops, moving, and twice at
    the same place."""
    places = [(0.0, 0.0), (5.0, 0.0), (7.0, 60.0), (7.0, 60.0), (11.9, 30.0), (19.9, 0.0)]
    changes = {
        **step(0.1),
        **stops((5.0, 1.0), (12.0, 1.0)),
        "simulation.duration_min": 40.0,
        "traffic.0.first_departure_min": 39.0,
        "traffic.0.initial_trains": [
            {"position_km": km, "speed_kmh": speed} for km, speed in places
        ],
    }
    result = run(changes)
    stood = [
        sorted(set(journey(result, f"eastbound initial {i}").x[
            journey(result, f"eastbound initial {i}").state == 4
        ]))
        for i in range(1, 7)
    ]  # fmt: skip
    assert stood == [[5e3, 12e3], [12e3], [12e3], [12e3], [12e3], []]
    assert result.trips.arrival_min[:6].notna().all()
    assert result.trips.departure_min[:6].isna().all()


def test_a_train_may_be_placed_at_the_highest_speed_from_which_it_can_stop():
    """100 m before its stop, steps of 3 s: n steps of full braking, then a rest r of one, take
    b h² (n²/2 + r (n + ½)).  With b h² = 7.65 m and 100 m, n = 5 and r = (13.07 - 12.5)/5.5 = 0.104:
    v = b h (n + r) = 2.55 · 5.104 = 13.0 m/s."""
    b, h, n = 0.85, 3.0, 5
    speed = b * h * (n + (100.0 / (b * h * h) - n * n / 2) / (n + 0.5))
    placed = [{"position_km": 9.9, "speed_kmh": speed * 3.6 * (1 - 1e-12)}]
    changes = {
        **step(0.05),
        "simulation.duration_min": 2.0,
        **stops((10.0, 1.0)),
        **limits((0, 80)),
    }
    result = run({**changes, "traffic.0.initial_trains": placed})
    assert phases(result, "eastbound initial 1")[:2] == ["braking", "dwelling"]
    way = journey(result, "eastbound initial 1")
    assert way.a[0] == pytest.approx(-b)
