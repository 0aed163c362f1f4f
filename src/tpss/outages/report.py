"""A report of a table of outages: one HTML file, in the manner of that of a run."""

import datetime as dt
import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import tomli_w

from tpss import units
from tpss.files.refusals import explained
from tpss.files.whole import write_file
from tpss.outages.row import LOSSES, TRIPS, Row, Verdict
from tpss.report import tables
from tpss.report.drawings.outages import voltages_of_cases
from tpss.report.html import check_target
from tpss.report.page import fill
from tpss.report.render.interactive import render
from tpss.report.tables import Cell, Table
from tpss.report.validity import limits_of_validity
from tpss.results.standards.windows import WINDOWS_MIN
from tpss.units import on_line

if TYPE_CHECKING:
    from tpss.outages.run import Comparison

ROW_PX, AROUND_PX = 26, 130
"""Height of a row of a plot, and of what is around the rows. [px]"""

HEADINGS = (
    "outage", "verdict", "lowest voltage [kV]", "at", "time [min]", "mean useful voltage [kV]",
    "in zone", "peak loading [%]", "15 min [%]", "of", "arrived", "late or missing", "lost [min]",
    "stranded", "energy [MWh]", "out of service",
)  # fmt: skip

LOADINGS = {"peak_loading": "peak"} | {
    f"loading_{window:g}_min": f"{window:g} min" for window in WINDOWS_MIN
}
"""Loadings by their keys: the highest of a step, and means over windows."""

CAPTION = "Highest loadings of a station: in a step, and in the mean over windows"

TRAINS = (
    "outage", "arrived", "late", "missing", "lost_min", "most_lost_min", "most_lost_train",
    "stranded", "lowest_voltage_train", "train_useful_voltage_kv", "useful_voltage_train",
)  # fmt: skip
"""Columns of the table of trains, as far as they are there."""


class Counted(NamedTuple):
    """Outages of one verdict."""

    words: str
    is_good: bool
    names: Sequence[str] = ()


def write_outages_report(found: "Comparison", file: str | Path, *, force: bool = False) -> Path:
    """Write a report of a table of outages into one HTML file.

    Parameters
    ----------
    found : Comparison
        As `compare_outages` gives it.
    file : path
        File to write.
    force : bool
        Whether a report that is there may be replaced.

    Raises
    ------
    ResultError
        The file exists, or cannot be written.
    """
    place = Path(file)
    check_target(place, force)
    with explained(place):
        place.parent.mkdir(parents=True, exist_ok=True)
        write_file(place, outages_report(found).encode())
    return place


def outages_report(found: "Comparison") -> str:
    """Page about a table of outages; of a run whose audit failed the verdict alone is shown."""
    rows, frame, scenario = found.rows, found.table(), found.scenario
    trusted = [row for row in rows if row.figures and row.verdict != Verdict.AUDIT_FAILED]
    figures = {}
    if trusted:
        drawing = voltages_of_cases(
            [row.outage for row in trusted],
            np.array([row.figures["lowest_voltage_kv"] for row in trusted]),
            np.array([row.figures["useful_voltage_kv"] for row in trusted]),
            scenario.standards.voltage_limits,
        )
        figures["voltages"] = render(drawing, AROUND_PX + ROW_PX * len(trusted))
    shown = frame[frame.outage.isin([row.outage for row in trusted])]
    return fill(
        "outages.html",
        f"{scenario.name}: outages",
        figures,
        {},
        scenario=scenario,
        created=dt.datetime.now(dt.UTC).isoformat(timespec="seconds"),
        step_min=scenario.simulation.time_step_min,
        count=len(rows) - 1,
        cases=found.cases,
        mistrusted=[row.outage for row in rows if row.verdict == Verdict.AUDIT_FAILED],
        intact=Counted(rows[0].verdict_in_words, rows[0].verdict == Verdict.KEPT),
        verdicts=list(_counted(rows[1:])),
        ranked=Table(
            "outages", "Outages", _headings(rows[0]), [_cells(row, rows[0]) for row in rows]
        ),
        tables=[
            tables.of_frame("trains", "Trains", shown[[name for name in TRAINS if name in shown]]),
            _loadings(trusted),
        ],
        validity=limits_of_validity([scenario]),
        document=tomli_w.dumps(scenario.as_document()),
    )


def _counted(rows: Sequence[Row]) -> Iterable[Counted]:
    """Names of the outages of each verdict, the gravest first."""
    for verdict in Verdict:
        names = [row.outage for row in rows if row.verdict == verdict]
        if names:
            yield Counted(verdict.words, verdict == Verdict.KEPT, names)


def _headings(intact: Row) -> list[str]:
    """Of the ranked table: what trips stands behind the verdict, losses before what is out."""
    trips, losses = (
        [words] if key in intact.figures else []
        for key, words in ((TRIPS, "tripped"), (LOSSES, "converter losses [MWh]"))
    )
    return [*HEADINGS[:2], *trips, *HEADINGS[2:-1], *losses, HEADINGS[-1]]


def _cells(row: Row, intact: Row) -> list[Cell]:
    """A row of the ranked table."""
    own = {} if row.verdict == Verdict.AUDIT_FAILED else row.figures
    base = {} if row is intact else intact.figures
    lost = row.lost if own else {}
    missing = lost["late"] + lost["missing"] if lost else None
    return [
        _text(row.outage),
        _text(row.verdict_in_words),
        *([_text(own.get(TRIPS, ""))] if TRIPS in intact.figures else []),
        _compared("lowest_voltage_kv", own, base),
        _text(on_line(own.get("lowest_voltage_line", ""), _at(own.get("lowest_voltage_km")))),
        tables.cell(own.get("lowest_voltage_min"), "min"),
        _compared("useful_voltage_kv", own, base),
        _text(own.get("useful_voltage_zone", "")),
        _percent(own.get("peak_loading")),
        _percent(own.get("loading_15_min")),
        _text(own.get("peak_loading_station", "")),
        tables.cell(lost.get("arrived"), ""),
        tables.cell(missing, ""),
        tables.cell(lost.get("lost_min"), "min"),
        tables.cell(own.get("stranded"), ""),
        _compared("energy_mwh", own, base),
        *([_compared(LOSSES, own, base)] if LOSSES in intact.figures else []),
        _text(row.out),
    ]


def _text(words: str) -> Cell:
    return Cell(words, words, is_number=False)


def _at(position_km: float | None) -> str:
    return "" if position_km is None or math.isnan(position_km) else f"km {position_km:.1f}"


def _percent(share: float | None) -> Cell:
    """A share in whole per cent."""
    if share is None or math.isnan(share):
        return tables.cell(None, "%")
    return Cell(f"{100.0 * share:.0f}", f"{100.0 * share:.7g}", is_number=True)


def _compared(key: str, own: Any, base: Any) -> Cell:
    """A figure, with its difference to that of the intact supply where it is seen in its decimals."""
    unit = units.label(key)
    value, before = own.get(key), base.get(key, math.nan)
    is_seen = value is not None and float(f"{value - before:.{tables.DIGITS[unit]}f}") != 0.0
    return tables.compared(value, before, key, unit) if is_seen else tables.cell(value, unit)


def _loadings(rows: Sequence[Row]) -> Table:
    """Highest loadings of a station, in a step and in the mean over windows: which, and from when."""
    headings = [
        f"{words}{more}" for words in LOADINGS.values() for more in (" [%]", ", of", ", from [min]")
    ]
    lines = []
    for row in rows:
        cells = [_text(row.outage)]
        for key in LOADINGS:
            cells.append(_percent(row.figures[key]))
            cells.append(_text(row.figures[f"{key}_station"]))
            cells.append(tables.cell(row.figures[f"{key}_from_min"], "min"))
        lines.append(cells)
    return Table("loadings", CAPTION, ["outage", *headings], lines)
