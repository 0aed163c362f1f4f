"""Cases as documents, which can be sent to other processes and computers, and rows that come back."""

import gc
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tpss.planning.cases import Case
from tpss.planning.plan import Evaluation
from tpss.planning.rows import row_of
from tpss.scenario.scenario import Scenario

Sent = tuple[Case, dict[str, Any]]
"""A case, and the document of its scenario."""

Row = dict[str, Any]
"""What came of a case."""


def warm_up(sent: list[Sent], evaluation: str) -> None:
    """Prepare a process: a case compiles the kernels, or loads them.

    The objects that exist then are permanent, and excluded from garbage collection, which the many
    objects of cases trigger and which would take a tenth of a second each time.
    """
    run_documents(sent, evaluation)
    gc.collect()
    gc.freeze()


def run_documents(sent: list[Sent], evaluation: str) -> list[Row]:
    """Rows of cases that are given as documents: the task of a worker.

    Parameters
    ----------
    sent : list of Case and document
    evaluation : str
        How they are evaluated, in JSON.
    """
    how = Evaluation.model_validate_json(evaluation)
    return [row_of(case, _maker(document), how) for case, document in sent]


def _maker(document: dict[str, Any]) -> Callable[[], Scenario]:
    return lambda: Scenario.from_document(document, Path("case"))
