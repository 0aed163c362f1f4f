"""Times of measured values: times of the clock, dates with or without a time zone, or a count."""

import re
from datetime import datetime
from typing import Literal, NamedTuple

import numpy as np
import pandas as pd

from tpss.errors import Finding, ScenarioError
from tpss.measured.quantities import Floats
from tpss.measured.table import MOST_FAULTS, Table, numbers
from tpss.scenario.clock import DAY_S, clock_at

Kind = Literal["clock", "date", "count"]

CLOCK = r"(\d{1,3}):([0-5]\d)(?::([0-5]\d(?:[.,]\d+)?))?"
DATE = r"(\d{4}-\d{2}-\d{2})[T ](\d{2}:\d{2}(?::\d{2}(?:[.,]\d+)?)?)\s*(Z|[+-]\d{2}:?\d{2})?"
NUMBER = r"[+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][+-]?\d+)?"

COUNTED_S = {"s": 1.0, "min": 60.0, "h": 3600.0}
"""Units of times that are counted from a start. [s]"""

FORMS = (
    "write HH:MM or HH:MM:SS, dates such as 2026-03-02T06:00:00+01:00, or numbers below a heading with "
    "their unit, time [s] or time [min]"
)


class Times(NamedTuple):
    """Times of all rows.

    Attributes
    ----------
    kind : str
        Times of the clock, dates, or counted from a start.
    seconds : Floats
        From the midnight before the first one, or from the start. [s]
    day : str
        Date of that midnight, if it is known.
    zone : str
        Time zone of the first one, as it stands in the file; empty if it has none.
    """

    kind: Kind
    seconds: Floats
    day: str = ""
    zone: str = ""

    def in_words(self, seconds: float) -> str:
        """A time as the file would give it."""
        if self.kind == "count":
            return f"minute {seconds / 60.0:.12g}"
        days, clock_s = divmod(seconds, DAY_S)
        if self.kind == "clock" and days >= 0:
            return clock_at(0.0, seconds)
        day = pd.Timestamp(self.day or "2000-01-01") + pd.Timedelta(days=days)
        date = f"{day:%Y-%m-%d} " if self.day else f"{days:+.0f} day, "
        return f"{date}{clock_at(0.0, clock_s)}"


def read_times(table: Table, column: str, unit: str | None) -> Times:
    """Times of a column.

    Parameters
    ----------
    table : Table
    column : str
    unit : str, optional
        Unit of counted times, from the heading or the file that explains the columns.

    Raises
    ------
    ScenarioError
        A cell is no time, or they do not increase.
    """
    texts = table.cells[column]
    first = texts.iloc[0]
    kinds: dict[Kind, str] = {"clock": CLOCK, "date": DATE, "count": NUMBER}
    kind = next((name for name, form in kinds.items() if re.fullmatch(form, first)), None)
    if kind is None:
        raise ScenarioError([table.fault(0, column, first, "not a time", FORMS)])
    findings: list[Finding] = []
    odd = ~texts.str.fullmatch(kinds[kind]).to_numpy(dtype=bool)
    for row in np.flatnonzero(odd)[:MOST_FAULTS]:
        problem = f"not a time of the kind of the first one, {first}"
        findings.append(table.fault(int(row), column, texts.iloc[row], problem, FORMS))
    if findings:
        raise ScenarioError(findings)
    if kind == "count":
        times = _counted(table, column, unit)
    else:
        times = _of_clock(texts) if kind == "clock" else _dated(table, column)
    back = np.flatnonzero(np.diff(times.seconds) <= 0.0) + 1
    if len(back):
        row = int(back[0])
        problem = f"the time does not increase: it follows {texts.iloc[row - 1]}"
        remedy = (
            "put the rows in order, each time once; where clocks go back in autumn, give dates with "
            "their time zone"
        )
        raise ScenarioError([table.fault(row, column, texts.iloc[row], problem, remedy)])
    return times


def _counted(table: Table, column: str, unit: str | None) -> Times:
    if unit not in COUNTED_S:
        problem = "numbers without a known unit of time" if unit is None else "not a unit of time"
        remedy = f"name the column time [s] or time [min]; units: {', '.join(COUNTED_S)}"
        raise ScenarioError([table.fault(None, column, unit or "", problem, remedy)])
    findings: list[Finding] = []
    seconds = numbers(table, column, findings) * COUNTED_S[unit]
    if findings:
        raise ScenarioError(findings)
    return Times("count", seconds)


def _of_clock(texts: "pd.Series[str]") -> Times:
    """Times of the clock, which begin anew at midnight."""
    parts = texts.str.extract(f"^{CLOCK}$")
    seconds = parts[2].fillna("0").str.replace(",", ".", regex=False)
    clock_s = (
        3600.0 * parts[0].astype(float) + 60.0 * parts[1].astype(float) + seconds.astype(float)
    ).to_numpy()
    midnights = np.concatenate([[0.0], np.cumsum(np.diff(clock_s) < -DAY_S / 2)])
    return Times("clock", np.asarray(clock_s + DAY_S * midnights, dtype=np.float64))


def _dated(table: Table, column: str) -> Times:
    """Dates: their distances in time, and what the clock of the first one shows."""
    texts = table.cells[column]
    parts = texts.str.extract(f"^{DATE}$")
    zoned = parts[2].notna().to_numpy()
    if zoned.any() != zoned.all():
        row = int(np.flatnonzero(zoned != zoned[0])[0])
        problem = "some times have a time zone, and some have none"
        remedy = "give all of them one, or none"
        raise ScenarioError([table.fault(row, column, texts.iloc[row], problem, remedy)])
    written = parts[0] + "T" + parts[1].str.replace(",", ".", regex=False) + parts[2].fillna("")
    instants = pd.to_datetime(written, format="ISO8601", utc=True, errors="coerce")
    lost = np.flatnonzero(instants.isna())
    if len(lost):
        row = int(lost[0])
        raise ScenarioError([table.fault(row, column, texts.iloc[row], "no such date", FORMS)])
    shown = datetime.fromisoformat(f"{parts[0].iloc[0]}T{parts[1].iloc[0].replace(',', '.')}")
    midnight = shown.replace(hour=0, minute=0, second=0, microsecond=0)
    since_s = (instants - instants.iloc[0]).dt.total_seconds().to_numpy(dtype=np.float64)
    zone = parts[2].iloc[0] if zoned.all() else ""
    seconds = np.asarray(since_s + (shown - midnight).total_seconds(), dtype=np.float64)
    return Times("date", seconds, f"{midnight:%Y-%m-%d}", zone)
