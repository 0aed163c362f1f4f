"""Cases in a row, simulated in one process: what a worker does."""

import datetime as dt
import io
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from tpss.api import Prepared, build
from tpss.errors import TpssError
from tpss.many import key_figures
from tpss.scenario.scenario import Scenario
from tpss.sweep.columns import (
    FAILED,
    INVALID,
    Names,
    output_columns,
    parameter_columns,
    schema_of,
    table_of,
)
from tpss.sweep.derive import scenario_of, scenario_with
from tpss.sweep.design import Design, design_of
from tpss.sweep.inputs import inputs_of
from tpss.sweep.study import study_of_json
from tpss.sweep.versions import versions


@dataclass(frozen=True)
class Plan:
    """All that a worker has to know of a study, as text that goes to any machine."""

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


TOGETHER = 64
"""Cases that go through each stage together, before any goes into the next.

The processor's caches then hold the code of that stage.
"""


def run_batch(plan: Plan, first: int, end: int) -> bytes:
    """Simulate the cases from `first` to `end` - 1; return their rows as a file of Parquet."""
    opened = _open(plan)
    rows = [
        row | opened.made_by
        for begin in range(first, end, TOGETHER)
        for row in run_cases(opened.design, range(begin, min(begin + TOGETHER, end)))
    ]
    file = io.BytesIO()
    pq.write_table(table_of(rows, opened.schema), file, compression="zstd")
    return file.getvalue()


def warm_up(plan: Plan) -> None:
    """Compile the kernels, or load them, by the first case."""
    key_figures(build(scenario_of(_open(plan).design, 0)))


def run_cases(design: Design, numbers: Iterable[int]) -> list[dict[str, Any]]:
    """Columns of cases, by the numbers of these; a case that cannot be simulated says why."""
    cases = [_Case(design, number) for number in numbers]
    for stage, timing in _STAGES:
        for case in cases:
            case.attempt(stage, timing)
    return [case.row for case in cases]


class _Case:
    """A case on its way to its row."""

    scenario: Scenario
    prepared: Prepared

    def __init__(self, design: Design, number: int) -> None:
        self.design, self.number, self.values = design, number, design.values(number)
        columns = parameter_columns(design.parameters, self.values)
        self.row: dict[str, Any] = {"case": number, **columns}

    def attempt(self, stage: "_Stage", timing: str) -> None:
        """Take the case through a stage, unless it has failed in one before."""
        if "status" in self.row:
            return
        started = time.perf_counter()
        try:
            stage(self)
        except TpssError as error:
            self.row |= {"status": INVALID, "problem": str(error)}
        except Exception as error:  # one case that fails must not take the others with it
            self.row |= {"status": FAILED, "problem": f"{type(error).__name__}: {error}"}
        self.row[timing] = self.row.get(timing, 0.0) + time.perf_counter() - started
        self.row["timing.ended"] = dt.datetime.now(dt.UTC)

    def derive(self) -> None:
        """Make its scenario."""
        self.scenario = scenario_with(self.design, self.values, self.number)

    def build(self) -> None:
        """Build its model."""
        self.prepared = build(self.scenario)

    def describe(self) -> None:
        """Say what it is, in numbers, and the digest of its scenario."""
        self.row |= inputs_of(self.scenario)._asdict()
        self.row["scenario_hash"] = self.scenario.digest()

    def run(self) -> None:
        """Simulate it."""
        self.row |= output_columns(key_figures(self.prepared))


_Stage = Callable[[_Case], None]

_STAGES: tuple[tuple[_Stage, str], ...] = (
    (_Case.derive, "timing.build_s"),
    (_Case.build, "timing.build_s"),
    (_Case.describe, "timing.build_s"),
    (_Case.run, "timing.run_s"),
)
"""What a case goes through, and the column that the time of it counts in."""
