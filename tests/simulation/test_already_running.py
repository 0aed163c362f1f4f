"""Trains that run already at the start: lone runs in stretches, and how many of them there are."""

import pytest

from tpss import TpssError, simulate
from tpss.model import build_model
from tpss.model.traffic import build_services
from tpss.run import already_running, lone
from tpss.run.already_running import find_already_running, trains_already_running
from tpss.run.lone import EmptyLine
from tpss.run.run import Run
from tpss.step.model import RunControl
from tpss.step.state import Status

from scenarios import gradients, short_line

CONTINUOUS = {"simulation.motion": "continuous", "simulation.braking": "within-step"}
STEPPED = {"simulation.motion": "stepped", "simulation.braking": "whole-steps"}
HILLY = {
    **gradients((0.0, 0.0), (4.0, 6.0), (9.0, -5.0)),
    "traffic.0.stops": [{"station": "Middle", "dwell_min": 0.7}],
}


def model_and_service(changes):
    scenario = short_line({**HILLY, **changes})
    model, _ = build_model(scenario)
    return model, build_services(scenario, model)[0]


@pytest.mark.parametrize("manner", [CONTINUOUS, STEPPED])
@pytest.mark.parametrize("step_min", [0.05, 1.0, 10.0])
def test_a_lone_train_in_stretches_is_to_the_bit_a_run_of_it(manner, step_min, monkeypatch):
    """Stretches of 7 steps against one run with a recording as long as the way."""
    monkeypatch.setattr(lone, "STRETCH", 7)
    model, service = model_and_service({**manner, "simulation.time_step_min": step_min})
    line = EmptyLine(model)
    alone = line.train_of(service, wait_s=0.0 if manner == STEPPED else 1.234)
    control = RunControl(model.network.system.nominal_voltage_v, studied_train=0)
    run = Run(model._replace(control=control), [alone.train], 1000)
    for step in (1, 6, 7, 8, 20, 100, 101, 900):
        line.advance(alone, step)
        if run.status == Status.RUNNING:
            run.advance_to(step)
        assert (alone.step, alone.status) == (run.step, run.status)
        for part in ("motion", "plan"):
            assert alone.records[part].tobytes() == run.state.trains[part].tobytes()
    assert line.arrival_s(alone) == run.instants_s[-1] - run.state.trains[0].timetable.stood_s


def waits_of_lone_trains(changes, monkeypatch):
    """Number of trains that run already, and the waits of the lone trains that were run for them."""
    model, service = model_and_service(changes)
    waits, train_of = [], EmptyLine.train_of

    def noted(line, service, wait_s=None):
        if wait_s is not None:  # not the one that shows how far they come
            waits.append(wait_s)
        return train_of(line, service, wait_s or 0.0)

    monkeypatch.setattr(EmptyLine, "train_of", noted)
    return len(find_already_running(model, service)), waits


@pytest.mark.parametrize(
    ("headway_min", "step_min", "expected"),
    [
        (2.0, 0.2, [0.0]),
        (2.5, 0.2, [6.0, 0.0]),  # 150 s = 12.5 steps of 12 s
        (1.25, 1.0, [45.0, 30.0, 15.0, 0.0]),  # 75 s = 1.25 steps of 60 s
    ],
)
def test_there_is_one_lone_train_for_each_remainder_of_headways_in_a_step(
    headway_min, step_min, expected, monkeypatch
):
    changes = {"traffic.0.headway_min": headway_min, "simulation.time_step_min": step_min}
    trains, waits = waits_of_lone_trains({**CONTINUOUS, **changes}, monkeypatch)
    assert trains > 2 * len(expected)
    assert waits == expected


def test_cases_on_the_same_line_have_their_trains_in_common_whatever_the_supply(monkeypatch):
    """The second supply asks for no lone train; another mass, limit or headway does."""
    given = {**CONTINUOUS, "simulation.time_step_min": 0.5, "traffic.0.headway_min": 3.3}
    first = trains_already_running(*model_and_service(given))
    asked, find = [], already_running.find_already_running
    monkeypatch.setattr(
        already_running, "find_already_running", lambda *known: asked.append(1) or find(*known)
    )
    model, service = model_and_service({**given, "supply.catenary": "AT"})
    assert trains_already_running(model, service) == first == find(model, service)
    assert not asked
    for change in ("trains.*.mass_t", "line.speed_limits.0.speed_kmh", "traffic.0.headway_min"):
        value = {"trains.*.mass_t": 700.0}.get(change, 4.1)
        model, service = model_and_service({**given, change: value})
        assert trains_already_running(model, service) == find(model, service) != first
    assert len(asked) == 3


def test_trains_that_move_in_steps_need_one_lone_train(monkeypatch):
    changes = {"traffic.0.headway_min": 2.33, "simulation.time_step_min": 1.0}
    _, waits = waits_of_lone_trains({**STEPPED, **changes}, monkeypatch)
    assert waits == [0.0]


def test_a_service_whose_trains_would_take_minutes_to_find_is_refused(monkeypatch):
    """20 km at 60 km/h, a stop of 0.7 min, starting twice: 23 min, ten headways of 2.3 min."""
    monkeypatch.setattr(already_running, "MOST_PHASES", 100)
    given = {**CONTINUOUS, "traffic.0.already_running": True, "simulation.duration_min": 1.0}
    crowded = {**HILLY, **given, "traffic.0.headway_min": 2.3, "simulation.time_step_min": 0.2}
    with pytest.raises(TpssError) as refused:
        simulate(short_line(crowded))
    said = str(refused.value)
    assert "traffic 'eastbound', already_running: about 10 trains" in said
    assert "headway_min = 2.3 is no multiple of time_step_min = 0.2" in said
    assert "take a headway_min that is a multiple" in said
    simulate(short_line({**crowded, "traffic.0.headway_min": 2.4}))


@pytest.mark.parametrize("headway_min", [60.0, 60.5])
def test_a_service_whose_trains_are_on_their_way_for_too_long_is_refused(headway_min, monkeypatch):
    """20 km at 1 km/h are 20 h of steps of a minute, with 20 phases of 3 s each: 12 000 within 10 h."""
    slow = {
        **CONTINUOUS,
        "simulation.time_step_min": 1.0,
        "simulation.duration_min": 1.0,
        "line.speed_limits.0.speed_kmh": 1.0,
        "traffic.0.already_running": True,
        "traffic.0.headway_min": headway_min,
    }
    monkeypatch.setattr(already_running, "MOST_PHASES_ALONE", 12_000)
    with pytest.raises(TpssError) as refused:
        simulate(short_line(slow))
    said = str(refused.value)
    assert "traffic 'eastbound', already_running: a train alone on the line" in said
    assert "has not arrived after 1" in said
    monkeypatch.setattr(already_running, "MOST_PHASES_ALONE", 30_000)
    simulate(short_line(slow))
