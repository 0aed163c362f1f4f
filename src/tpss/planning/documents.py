"""Cases as documents, which can be sent to other processes and computers, and rows that come back."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from tpss.planning.cases import Case
from tpss.planning.plan import Evaluation
from tpss.planning.rows import row_of
from tpss.scenario.own_library import folder_in_use, using
from tpss.scenario.scenario import Scenario
from tpss.sweep.collector import spare_the_collector

Sent = tuple[Case, dict[str, Any]]
"""A case, and the document of its scenario."""

Row = dict[str, Any]
"""What came of a case."""


def warm_up(sent: list[Sent], evaluation: str) -> None:
    """Prepare a process: a case compiles the kernels, or loads them."""
    run_documents(sent, evaluation)
    spare_the_collector()


def run_documents(sent: list[Sent], evaluation: str) -> list[Row]:
    """Rows of cases that are given as documents: the task of a worker.

    Parameters
    ----------
    sent : list of Case and document
    evaluation : str
        How they are evaluated, in JSON.
    """
    how = Evaluation.model_validate_json(evaluation)
    with using(folder_in_use()):  # found out once, not once a case
        return [row_of(case, _maker(document), how) for case, document in sent]


def _maker(document: dict[str, Any]) -> Callable[[], Scenario]:
    return lambda: Scenario.from_own_document(document, Path("case"))
