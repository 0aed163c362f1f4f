"""Successive cases, simulated in one process: the task of a worker."""

import datetime as dt
import io
import time
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from tpss.api import build
from tpss.errors import TpssError
from tpss.many import key_figures
from tpss.sweep.collector import spare_the_collector
from tpss.sweep.columns import (
    FAILED,
    INVALID,
    Names,
    output_columns,
    parameter_columns,
    schema_of,
    table_of,
)
from tpss.sweep.derive import scenario_of
from tpss.sweep.design import Design, design_of
from tpss.sweep.inputs import inputs_of
from tpss.sweep.study import study_of_json
from tpss.sweep.versions import versions

BATCH_S = 1.0
"""Approximate time of a batch: a hundred times the overhead of processes and the file system. [s]"""

MOST_IN_BATCH = 5_000

KILLER = "the process that ran it ended, also with nothing beside it: it may need too much memory"
"""What is said of a case that ends the process that runs it."""


@dataclass(frozen=True)
class Plan:
    """All that a worker needs of a study, as text that can be sent to any computer."""

    study: str
    stations: tuple[str, ...]
    services: tuple[str, ...]


@dataclass(frozen=True)
class _Opened:
    design: Design
    schema: pa.Schema
    made_by: dict[str, str]


@lru_cache(maxsize=4)
def _open(plan: Plan) -> _Opened:
    """A plan opened once in a process; its design is drawn once too."""
    study = study_of_json(plan.study)
    design = design_of(study)
    return _Opened(
        design=design,
        schema=schema_of(design.parameters, Names(plan.stations, plan.services)),
        made_by={"study_hash": study.digest, **versions()},
    )


def run_batch(plan: Plan, first: int, end: int) -> bytes:
    """Simulate the cases from `first` to `end` - 1; return their rows as a file of Parquet."""
    opened = _open(plan)
    return _file_of([run_case(opened.design, case) for case in range(first, end)], opened)


def file_of_killer(plan: Plan, case: int) -> bytes:
    """The row of a case that ends the process that runs it, as a file of Parquet."""
    opened = _open(plan)
    values = opened.design.values(case)
    row = {"case": case, **parameter_columns(opened.design.parameters, values)}
    row |= {"status": FAILED, "problem": KILLER, "timing.ended": dt.datetime.now(dt.UTC)}
    return _file_of([row], opened)


def _file_of(rows: list[dict[str, Any]], opened: _Opened) -> bytes:
    file = io.BytesIO()
    made = [row | opened.made_by for row in rows]
    pq.write_table(table_of(made, opened.schema), file, compression="zstd")
    return file.getvalue()


def run_cases(plan: Plan, cases: Sequence[int]) -> None:
    """Simulate some cases to see how long that takes."""
    for case in cases:
        run_case(_open(plan).design, case)


def batch_size(left: int, case_s: float, workers: int) -> int:
    """Cases of a batch: it takes about a second, and each worker has several."""
    return max(1, min(MOST_IN_BATCH, round(BATCH_S / case_s), -(-left // (4 * workers))))


def warm_up(plan: Plan) -> None:
    """Prepare a process: the first case compiles the kernels, or loads them."""
    run_batch(plan, 0, 1)
    spare_the_collector()


def run_case(design: Design, case: int) -> dict[str, Any]:
    """Columns of one case; for a case that cannot be simulated, the reason."""
    values = design.values(case)
    row: dict[str, Any] = {"case": case, **parameter_columns(design.parameters, values)}
    started = time.perf_counter()
    try:
        prepared = build(scenario_of(design, case))
        scenario = prepared.scenario
        row |= {**inputs_of(scenario)._asdict(), "scenario_hash": scenario.digest()}
        built = time.perf_counter()
        row |= output_columns(key_figures(prepared))
        row["timing.run_s"] = time.perf_counter() - built
        row["timing.build_s"] = built - started
    except TpssError as error:
        row |= {"status": INVALID, "problem": str(error)}
    except Exception as error:  # one case that fails must not stop the others
        row |= {"status": FAILED, "problem": f"{type(error).__name__}: {error}"}
    row["timing.ended"] = dt.datetime.now(dt.UTC)
    return row
