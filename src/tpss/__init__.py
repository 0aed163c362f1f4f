"""TPSS, the Train Power System Simulator: trains and their power supply, simulated together.

>>> import tpss
>>> result = tpss.simulate(tpss.load_scenario("line.toml"))  # doctest: +SKIP
>>> result.trips  # doctest: +SKIP

Names are imported when they are first used, so that ``import tpss`` and the command line start fast.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # named as themselves, they are exported for type checkers too
    from tpss.api import Prepared as Prepared
    from tpss.api import prepare as prepare
    from tpss.api import simulate as simulate
    from tpss.approximator.approximator import Approximator as Approximator
    from tpss.approximator.approximator import load_approximator as load_approximator
    from tpss.approximator.train import train_approximator as train_approximator
    from tpss.conductors.constants import LineConstants as LineConstants
    from tpss.conductors.constants import line_constants as line_constants
    from tpss.conductors.geometry import Geometry as Geometry
    from tpss.conductors.load import load_geometry as load_geometry
    from tpss.errors import ApproximatorError as ApproximatorError
    from tpss.errors import AuditError as AuditError
    from tpss.errors import Finding as Finding
    from tpss.errors import LanesError as LanesError
    from tpss.errors import NoPlanError as NoPlanError
    from tpss.errors import PlanError as PlanError
    from tpss.errors import ResultError as ResultError
    from tpss.errors import ScenarioError as ScenarioError
    from tpss.errors import StudyError as StudyError
    from tpss.errors import TpssError as TpssError
    from tpss.many import simulate_many as simulate_many
    from tpss.measured.compare import compare_with_measurements as compare_with_measurements
    from tpss.outages.run import compare_outages as compare_outages
    from tpss.planning.load import Plan as Plan
    from tpss.planning.load import load_plan as load_plan
    from tpss.planning.report import write_plan_report as write_plan_report
    from tpss.planning.run import run_plan as run_plan
    from tpss.report.html import write_report as write_report
    from tpss.results.key_figures import KeyFigures as KeyFigures
    from tpss.results.result import Result as Result
    from tpss.results.result import load_result as load_result
    from tpss.results.standards.evidence import Evidence as Evidence
    from tpss.run.run import Progress as Progress
    from tpss.savings.table import spare_time_savings as spare_time_savings
    from tpss.scenario import Scenario as Scenario
    from tpss.scenario import load_scenario as load_scenario
    from tpss.sweep.campaign import run_study as run_study
    from tpss.sweep.folder import load_table as load_table
    from tpss.sweep.study import Study as Study
    from tpss.sweep.study import load_study as load_study

if TYPE_CHECKING:
    from tpss import examples as examples

_HOME = {
    "Approximator": "tpss.approximator.approximator",
    "ApproximatorError": "tpss.errors",
    "AuditError": "tpss.errors",
    "Evidence": "tpss.results.standards.evidence",
    "Finding": "tpss.errors",
    "Geometry": "tpss.conductors.geometry",
    "KeyFigures": "tpss.results.key_figures",
    "LanesError": "tpss.errors",
    "LineConstants": "tpss.conductors.constants",
    "NoPlanError": "tpss.errors",
    "Plan": "tpss.planning.load",
    "PlanError": "tpss.errors",
    "Prepared": "tpss.api",
    "Progress": "tpss.run.run",
    "Result": "tpss.results.result",
    "ResultError": "tpss.errors",
    "Scenario": "tpss.scenario",
    "ScenarioError": "tpss.errors",
    "Study": "tpss.sweep.study",
    "StudyError": "tpss.errors",
    "TpssError": "tpss.errors",
    "compare_outages": "tpss.outages.run",
    "compare_with_measurements": "tpss.measured.compare",
    "line_constants": "tpss.conductors.constants",
    "load_approximator": "tpss.approximator.approximator",
    "load_geometry": "tpss.conductors.load",
    "load_plan": "tpss.planning.load",
    "load_result": "tpss.results.result",
    "load_scenario": "tpss.scenario",
    "load_study": "tpss.sweep.study",
    "load_table": "tpss.sweep.folder",
    "prepare": "tpss.api",
    "run_plan": "tpss.planning.run",
    "run_study": "tpss.sweep.campaign",
    "simulate": "tpss.api",
    "simulate_many": "tpss.many",
    "spare_time_savings": "tpss.savings.table",
    "train_approximator": "tpss.approximator.train",
    "write_plan_report": "tpss.planning.report",
    "write_report": "tpss.report.html",
}

__version__: str
"""Version of the package."""

__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return import_module("importlib.metadata").version("tpss")
    if name == "examples":
        return import_module("tpss.examples")
    if name not in _HOME:
        raise AttributeError(f"module 'tpss' has no attribute {name!r}")
    with import_module("tpss.extras").imports_explained():
        return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    return __all__
