"""Which traffic a configuration carries: a run that comes through, within what is required."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from tpss.errors import AuditError, Finding, ScenarioError
from tpss.planning.cases import AreaCases, Case
from tpss.planning.plan import Requirements
from tpss.planning.steady import FINISHED
from tpss.sweep.columns import FAILED, INVALID

Flags = npt.NDArray[np.bool_]

LIMITS = (
    ("lowest_voltage_kv", "lowest_voltage_kv", -1.0, "lowest voltage {:.2f} kV"),
    ("mean_useful_voltage_kv", "mean_useful_voltage_kv", -1.0, "mean useful voltage {:.2f} kV"),
    ("peak_loading", "peak_loading", 1.0, "peak loading {:.3f}"),
    ("unbalance_percent", "unbalance_percent", 1.0, "unbalance {:.2f} %"),
    ("rail_permanent_v", "rail_permanent_v", 1.0, "rails permanently {:.1f} V"),
    ("rail_short_v", "rail_short_v", 1.0, "rails shortly {:.1f} V"),
    ("stray_ma_per_m", "stray_ma_per_m", 1.0, "stray current {:.2f} mA/m"),
)
"""Keys of the requirements, columns of the outcomes that they limit, the sign of what is too much, and
how a value is told."""


def records_of(table: pd.DataFrame) -> dict[str, dict[str, Any]]:
    """Rows of outcomes by the digests of their cases."""
    records: list[dict[str, Any]] = [
        {str(name): value for name, value in row.items()} for row in table.to_dict("records")
    ]
    return dict(zip(table.index.tolist(), records, strict=True))


def failures(row: Mapping[str, Any], require: Requirements) -> Iterator[str]:
    """What a case does not keep, in words; nothing if it carries its traffic."""
    if row["status"] != FINISHED:
        yield str(row["status"])
        return
    for key, column, sign, words in LIMITS:
        limit, value = getattr(require, key), row.get(column, math.nan)
        if limit is None or sign * value <= sign * limit:
            continue
        yield f"{words.partition(' {')[0]} not known" if math.isnan(value) else words.format(value)


def verdicts(
    cases: AreaCases, own: list[Case], table: pd.DataFrame, require: Requirements
) -> dict[tuple[int, int], list[str]]:
    """Why configurations do not carry traffic, by state and configuration; an empty list if they do.

    Parameters
    ----------
    cases : AreaCases
    own : list of Case
        Those of the area.
    table : DataFrame
        Rows by digest.
    require : Requirements

    Raises
    ------
    ScenarioError
        A case could not be simulated.
    AuditError
        The audit of a case failed.
    """
    found: dict[tuple[int, int], list[str]] = {}
    rows = records_of(table)
    faults: list[Finding] = []
    for case in own:
        row = rows[case.digest]
        named = f"{cases.configurations[case.configuration].name} with "
        named += cases.states.states[case.state].name
        if row["status"] in (INVALID, FAILED):
            problem = f"{named}: {row['problem']}"
            remedy = "leave out or change what leads to it; the folder's table has all of them"
            faults.append(Finding(str(cases.area.source), "", "", problem, remedy))
            continue
        if not row["audit_passed"]:
            raise AuditError(f"the audit of {named} failed: {row['problem']}")
        behind = f" with {case.outage}" if case.outage else ""
        words = [f"{each}{behind}" for each in failures(row, require)]
        found.setdefault((case.state, case.configuration), []).extend(words)
    if faults:
        raise ScenarioError(faults)
    return found
