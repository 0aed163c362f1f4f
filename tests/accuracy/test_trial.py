"""A run at another step is that of a scenario with that step."""

import pickle

import pytest

from tpss.accuracy.trial import Trial
from tpss.api import prepare
from tpss.many import key_figures
from tpss.model.build import at_step, build_model

from scenarios import short_line, stops

STOPS = stops((5.0, 0.7), (12.0, 1.5))


@pytest.mark.parametrize("step_min", [1.0, 0.3, 0.025])
def test_a_model_at_another_step_is_that_of_a_scenario_with_it(step_min):
    """Dwells of 0.7 min and 1.5 min take other numbers of steps; all else stays."""
    scenario = short_line({**STOPS, "simulation.time_step_min": 0.2})
    changed = at_step(build_model(scenario)[0], scenario, 60.0 * step_min)
    built, _ = build_model(short_line({**STOPS, "simulation.time_step_min": step_min}))
    assert pickle.dumps(changed) == pickle.dumps(built)


def test_its_figures_are_those_of_that_scenario():
    """With trains that run already, whose places depend on the step."""
    changes = {**STOPS, "traffic.0.already_running": True, "traffic.0.headway_min": 6.0}
    scenario = short_line({**changes, "simulation.time_step_min": 0.2})
    prepared = prepare(scenario)
    trial = Trial(scenario, prepared.start.model, prepared.clock, prepared.frame)
    expected = key_figures(short_line({**changes, "simulation.time_step_min": 0.05}))
    assert trial.run(0.05) == expected
