"""Rows of the table of cases: what came of each, and when."""

import datetime as dt
import threading
import time
from collections.abc import Callable
from typing import Any

from tpss.errors import TpssError
from tpss.many import Scratch
from tpss.planning.case_folder import DIGEST
from tpss.planning.cases import Case
from tpss.planning.outcome import outcome_of
from tpss.planning.plan import Evaluation
from tpss.scenario.scenario import Scenario
from tpss.sweep.columns import FAILED, INVALID


def row_of(case: Case, scenario: Callable[[], Scenario], evaluation: Evaluation) -> dict[str, Any]:
    """Row of a case; of one that cannot be simulated, the reason.

    Parameters
    ----------
    case : Case
    scenario : callable
        Makes its scenario.
    evaluation : Evaluation
    """
    started = time.perf_counter()
    row: dict[str, Any] = {DIGEST: case.digest}
    scratch = _of_this_thread.__dict__.setdefault("scratch", Scratch())
    scratch.reset()
    try:
        made = scenario()
        row |= {"scenario_hash": made.digest(), "scenario": made.name, "outage": case.outage}
        row |= outcome_of(made, evaluation, scratch.allocate)
    except TpssError as error:
        row |= {"status": INVALID, "problem": str(error)}
    except Exception as error:  # one case that fails must not stop the others
        row |= {"status": FAILED, "problem": f"{type(error).__name__}: {error}"}
    row["timing.case_s"] = time.perf_counter() - started
    row["timing.ended"] = dt.datetime.now(dt.UTC)
    return row


def row_of_killer(case: Case) -> dict[str, Any]:
    """Row of a case that ends the process that runs it."""
    from tpss.sweep.batch import KILLER  # Parquet takes long to import

    return {
        DIGEST: case.digest,
        "status": FAILED,
        "problem": KILLER,
        "timing.ended": dt.datetime.now(dt.UTC),
    }


_of_this_thread = threading.local()
