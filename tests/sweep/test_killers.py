"""A case that kills the process that runs it is found, marked and left behind; all others are run."""

import io
import signal
from collections.abc import Iterator

import pyarrow.parquet as pq
import pytest

from sweep.killing import KILLERS, end, nothing, run
from sweep.studies import study
from tpss.errors import StudyError
from tpss.sweep.batch import KILLER, Plan, file_of_killer
from tpss.sweep.check import check
from tpss.sweep.design import design_of
from tpss.sweep.processes import Work, in_processes, trial

Batch = tuple[int, int]


def halves(batch: Batch) -> list[Batch]:
    first, end = batch
    middle = (first + end) // 2
    return [(first, middle), (middle, end)] if middle > first else []


def batches() -> Iterator[Batch]:
    return ((first, first + 2) for first in range(0, 8, 2))


def work(warm_up=nothing) -> Work[Batch, list[str]]:
    return Work(warm_up, run, str, halves, lambda batch: [f"killer {batch[0]}"])


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="no such signal there")
def test_all_cases_come_once_and_those_that_kill_are_marked():
    """Eight cases in four batches, of which 2 and 5 kill: each is alone once its batch is halved."""
    rows = [row for _, some in in_processes(work(), batches(), 2) for row in some]
    expected = {f"killer {case}" if case in KILLERS else f"case {case}" for case in range(8)}
    assert len(rows) == 8
    assert set(rows) == expected


def test_processes_that_never_get_ready_are_a_fault_of_their_surroundings():
    with pytest.raises(StudyError, match="end before they run any"):
        list(in_processes(work(end), batches(), 2))


def test_a_trial_that_meets_a_case_that_kills_says_so():
    with pytest.raises(StudyError, match="run the study, which marks a case that kills"):
        trial(nothing, run, KILLERS, 1)


def test_the_row_of_a_case_that_kills_says_so(tmp_path):
    small = study(tmp_path)
    names = check(design_of(small))
    content = file_of_killer(Plan(small.as_json(), names.stations, names.services), 2)
    (row,) = pq.read_table(io.BytesIO(content)).to_pylist()
    assert (row["case"], row["status"], row["problem"]) == (2, "failed", KILLER)
    assert row["set.supply.converter_stations.*.converters"] == 3
