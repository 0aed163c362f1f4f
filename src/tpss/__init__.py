"""TPSS, the Train Power System Simulator: trains and their power supply, simulated together.

>>> import tpss
>>> result = tpss.simulate(tpss.load_scenario("line.toml"))  # doctest: +SKIP
>>> result.trips  # doctest: +SKIP

Names are imported when they are first used, so that ``import tpss`` and the command line start fast.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tpss.api import Prepared, prepare, simulate
    from tpss.approximator.approximator import Approximator, load_approximator
    from tpss.approximator.train import train_approximator
    from tpss.errors import (
        ApproximatorError,
        Finding,
        ResultError,
        ScenarioError,
        StudyError,
        TpssError,
    )
    from tpss.many import simulate_many
    from tpss.report.html import write_report
    from tpss.results.key_figures import KeyFigures
    from tpss.results.result import Result, load_result
    from tpss.results.standards.evidence import Evidence
    from tpss.run.run import Progress
    from tpss.scenario import Scenario, load_scenario
    from tpss.sweep.campaign import run_study
    from tpss.sweep.folder import load_table
    from tpss.sweep.study import Study, load_study

_HOME = {
    "Approximator": "tpss.approximator.approximator",
    "ApproximatorError": "tpss.errors",
    "Evidence": "tpss.results.standards.evidence",
    "Finding": "tpss.errors",
    "KeyFigures": "tpss.results.key_figures",
    "Prepared": "tpss.api",
    "Progress": "tpss.run.run",
    "Result": "tpss.results.result",
    "ResultError": "tpss.errors",
    "Scenario": "tpss.scenario",
    "ScenarioError": "tpss.errors",
    "Study": "tpss.sweep.study",
    "StudyError": "tpss.errors",
    "TpssError": "tpss.errors",
    "load_approximator": "tpss.approximator.approximator",
    "load_result": "tpss.results.result",
    "load_scenario": "tpss.scenario",
    "load_study": "tpss.sweep.study",
    "load_table": "tpss.sweep.folder",
    "prepare": "tpss.api",
    "run_study": "tpss.sweep.campaign",
    "simulate": "tpss.api",
    "simulate_many": "tpss.many",
    "train_approximator": "tpss.approximator.train",
    "write_report": "tpss.report.html",
}

__all__ = [
    "Approximator",
    "ApproximatorError",
    "Evidence",
    "Finding",
    "KeyFigures",
    "Prepared",
    "Progress",
    "Result",
    "ResultError",
    "Scenario",
    "ScenarioError",
    "Study",
    "StudyError",
    "TpssError",
    "load_approximator",
    "load_result",
    "load_scenario",
    "load_study",
    "load_table",
    "prepare",
    "run_study",
    "simulate",
    "simulate_many",
    "train_approximator",
    "write_report",
]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'tpss' has no attribute {name!r}")
    return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)
