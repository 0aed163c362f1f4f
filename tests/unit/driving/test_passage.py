"""The ways of a train through a step at the voltages that are tried."""

import math

import pytest

from tpss.driving import passage
from tpss.kernel import plain
from tpss.model.build import build_model
from tpss.model.start import start_of
from tpss.run.run import run_of
from tpss.scenario.load import load_scenario
from tpss.step.model import driving_data
from tpss.vehicle.train import Course, Phase

from conftest import EXAMPLES


@pytest.fixture
def ask(monkeypatch):
    """Asks trains at 72 km/h, whose machines give what the voltage lets them, for their demand in a step
    of a minute; and the voltages of the ways that are found."""
    scenario = load_scenario(EXAMPLES / "line_320km.toml", {"simulation.duration_min": 10.0})
    model, _ = build_model(scenario)
    run = run_of(start_of(scenario, model))
    data, tried = plain(driving_data)(model), []
    way = plain(passage.pass_through)

    def noted(voltage_v, *others):
        tried.append(voltage_v)
        way(voltage_v, *others)

    monkeypatch.setattr(passage, "pass_through", noted)

    def ask(train, voltage_v, with_slopes):
        return plain(passage.demand_of_passage)(
            voltage_v, with_slopes, train, model.types[train.train_type], data, model.points,
            run.state.scratch,
        )  # fmt: skip

    def a_train():
        train = run.state.trains[:1].copy()[0]
        train.decision.course, train.motion.phase = Course.PASSAGE, Phase.DRIVING
        train.motion.speed_m_s, train.decision.wanted_m_s = 20.0, math.inf
        return train

    return ask, a_train, tried


def test_slopes_at_a_voltage_that_was_checked_take_the_second_way_only(ask):
    """Newton's method looks at a voltage V without slopes, and asks for these next: the way at V is
    known, that at V (1 + 1e-5) is not.  Then the train's demand is that of the second way, so at V all
    is found anew."""
    asked, a_train, tried = ask
    train, other = a_train(), a_train()
    asked(train, 14e3, False)
    slopes = asked(train, 14e3, True)
    assert tried == [14e3, 14e3 + 0.14]
    assert slopes == asked(other, 14e3, True)
    assert repr(train.tolist()) == repr(other.tolist())  # in which NaN is NaN
    del tried[:]
    asked(train, 14e3, False)
    assert tried == [14e3]


def test_another_voltage_or_another_step_is_another_way(ask):
    """A check at V says nothing about V + 1, nor about V in the next step, for which the driver prepares
    the train."""
    asked, a_train, tried = ask
    train = a_train()
    asked(train, 14e3, False)
    asked(train, 14001.0, False)
    asked(train, 14001.0, False)
    assert tried == [14e3, 14001.0, 14001.0]
