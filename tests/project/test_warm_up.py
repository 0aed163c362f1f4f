"""What is compiled before tests need it is what its scenarios are named after."""

import pytest

import tpss
from tpss.model import build_model
from tpss.powerflow.groups import NO_GROUPS

from warm_up import OCCASIONS


@pytest.mark.parametrize("name", OCCASIONS)
def test_an_occasion_needs_what_its_name_says(name: str) -> None:
    scenario = OCCASIONS[name]()
    model, _ = build_model(scenario)
    assert (model.network.groups != NO_GROUPS) == ("coupled tracks" in name)
    assert (model.types["spared"]["continuous_a"] < float("inf")).any() == ("spared" in name)
    assert (scenario.simulation.load_flow == "least-squares") == ("least squares" in name)
    assert (tpss.simulate(scenario).status == "collapsed") == ("searches" in name)
