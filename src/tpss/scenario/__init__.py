"""What the user writes: one file per noun, validated and frozen."""

from tpss.scenario.load import load_scenario
from tpss.scenario.scenario import Scenario

__all__ = ["Scenario", "load_scenario"]
