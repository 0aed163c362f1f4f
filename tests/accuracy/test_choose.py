"""The step that is taken where a scenario gives none."""

import pytest

import tpss
from accuracy.rough import ROUGH, WHOLE_STEPS
from tpss.accuracy import choose
from tpss.accuracy.check import agree
from tpss.accuracy.choose import STRICTNESS
from tpss.accuracy.trial import Trial
from tpss.api import prepare
from tpss.many import key_figures
from tpss.scenario.open_step import LADDER_MIN

from scenarios import SHORT_LINE, short_line

OPEN = {"simulation.time_step_min": None}


@pytest.mark.parametrize("changes", [{}, WHOLE_STEPS], ids=["as it is", "whole steps"])
def test_it_is_the_longest_whose_figures_are_close_to_those_at_half_of_it(changes):
    """Each figure here is of a plain run."""
    prepared = prepare(short_line({**changes, **OPEN}))
    choice = prepared.choice
    assert choice.within
    assert choice.tried_min == LADDER_MIN[: len(choice.tried_min)]
    trial = Trial(prepared.scenario, prepared.start.model, prepared.clock, prepared.frame)
    for step_min in choice.tried_min:
        pair = [
            key_figures(short_line({**changes, "simulation.time_step_min": each}))
            for each in (step_min, step_min / 2)
        ]
        assert agree(*pair, trial, STRICTNESS) == (step_min == choice.step_min)


def test_the_run_is_that_with_the_step_given():
    chosen = tpss.simulate(short_line(OPEN))
    step_min = chosen.summary["time_step_min"]
    given = tpss.simulate(short_line({"simulation.time_step_min": step_min}))
    assert chosen.dataset.drop_attrs().identical(given.dataset.drop_attrs())
    assert chosen.scenario == given.scenario
    assert given.summary["step_choice"] is None
    assert chosen.summary["step_choice"]["tried_min"][-1] == step_min


def test_its_check_is_that_of_a_run_with_the_step_given():
    chosen = tpss.simulate(short_line(OPEN), step_check=True)
    given = tpss.simulate(
        short_line({"simulation.time_step_min": chosen.summary["time_step_min"]}), step_check=True
    )
    assert chosen.summary["step_check"] == given.summary["step_check"]


def test_if_none_is_short_enough_the_shortest_is_taken(monkeypatch):
    monkeypatch.setattr(choose, "LADDER_MIN", (1.0, 0.5))
    choice = prepare(short_line({**ROUGH, **OPEN})).choice
    assert (choice.step_min, choice.within, choice.tried_min) == (0.5, False, (1.0, 0.5))


ONE_TRAIN = {**ROUGH, **OPEN, "traffic.0.headway_min": 1000.0, "simulation.duration_min": 120.0}


@pytest.mark.parametrize(
    ("most", "tried_min"), [(480, (1.0, 0.5)), (240, (1.0,)), (239, ())], ids=str
)
def test_steps_whose_runs_would_take_too_long_are_not_tried(most, tried_min, monkeypatch):
    """One train for 120 min is 120, 240 and 480 steps of 1 min, 0.5 min and 0.25 min.

    If not even the longest step can be compared with half of it, it is taken as it is.
    """
    monkeypatch.setattr(choose, "MOST_TRAIN_STEPS", most)
    choice = prepare(short_line(ONE_TRAIN)).choice
    assert not choice.within
    assert choice.tried_min == tried_min
    assert choice.step_min == min(tried_min, default=1.0)


def test_a_step_in_which_a_train_cannot_stop_in_time_is_passed_over():
    """400 m before its stop: from 60 km/h a train stops in 163 m, at 0.85 m/s², but in a step of a
    whole minute it goes 500 m.
    """
    placed = [{"position_km": 9.6, "speed_kmh": 60.0}]
    changes = {**WHOLE_STEPS, "traffic.0.initial_trains": placed,
               "traffic.0.stops": [{"station": "Middle", "dwell_min": 1.0}]}  # fmt: skip
    with pytest.raises(tpss.ScenarioError, match="too fast to stop"):
        tpss.simulate(short_line({**changes, "simulation.time_step_min": 1.0}))
    assert tpss.simulate(short_line({**changes, **OPEN})).summary["time_step_min"] < 1.0


def test_a_faulty_scenario_is_refused_as_with_a_step():
    placed = [{"position_km": 9.99, "speed_kmh": 60.0}]
    changes = {"traffic.0.initial_trains": placed,
               "traffic.0.stops": [{"station": "Middle", "dwell_min": 1.0}]}  # fmt: skip
    with pytest.raises(tpss.ScenarioError, match="too fast to stop"):
        tpss.simulate(short_line({**changes, **OPEN}))


def test_the_whole_table_may_be_left_out():
    document = {key: value for key, value in SHORT_LINE.items() if key != "simulation"}
    assert tpss.simulate(tpss.Scenario.from_document(document)).status == "finished"


def test_many_scenarios_choose_each_for_itself():
    (figures,) = tpss.simulate_many([short_line(OPEN)])
    result = tpss.simulate(short_line(OPEN))
    assert figures.steps == result.dataset.sizes["time"] - 1
