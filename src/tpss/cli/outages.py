"""The command ``tpss outages``: a scenario with each of its outages, in one ranked table."""

import math
import os
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.markup import escape
from rich.table import Table

from tpss.cli.run import AUDIT_FAILED, DONE, INTERRUPTED, NO_SOLUTION
from tpss.cli.terminal import (
    Console,
    announce_compilation,
    parts_that_fit,
    progress_bar,
    say,
    tell,
    widest_text,
)
from tpss.errors import ResultError
from tpss.extras import demand
from tpss.files import whole
from tpss.files.refusals import explained, refuse_to_replace
from tpss.results.contents import is_report
from tpss.results.store import PARENT
from tpss.units import on_line

if TYPE_CHECKING:
    from tpss.outages.row import Row
    from tpss.outages.run import Comparison

HTML = ".html"
"""End of the name of a report, which otherwise is that of its table."""

PROGRESS = "{task.completed}/{task.total} outages"

LEAST_CHANGE = 0.005
"""A difference below this is not printed."""


def run_outages(
    file: Path,
    every: bool,
    assignments: list[str],
    jobs: int | None,
    out: Path | None,
    force: bool,
    quiet: bool,
    report: bool = False,
) -> int:
    """Run a scenario with each of its outages; print and save the table; return the exit code."""
    if report:
        demand("report")
    from tpss.outages.run import compare_outages
    from tpss.run.interrupt import interruptible
    from tpss.scenario import load_scenario
    from tpss.scenario.override import parse_assignment

    scenario = load_scenario(file, dict(parse_assignment(text) for text in assignments))
    if out is not None:
        _demand_room(out, force, report)
    console = Console(stderr=True, quiet=quiet)
    announce_compilation(console)
    with interruptible() as interrupted:
        with progress_bar(scenario.name, PROGRESS, _progress, console) as progress:
            found = compare_outages(
                scenario, every=every, threads=jobs, report=progress, interrupted=interrupted
            )
        if not found.rows:
            print("Interrupted; nothing was saved.", file=sys.stderr)
            return INTERRUPTED
        place = _save(found, scenario.name, out, force)
    if not quiet:
        print_table(found, Console())
        say(Console(), f"Saved in {place}")
    if report:
        file = found.write_report(place.with_suffix(HTML), force=force)
        if not quiet:
            tell(f"Wrote {file}")
    if interrupted:
        done = f"{len(found.rows)} of {found.cases} runs"
        print(f"Interrupted after {done}; the table holds these.", file=sys.stderr)
        return INTERRUPTED
    return _exit_code(found)


def _demand_room(out: Path, force: bool, report: bool) -> None:
    """Refuse to replace what is there, before anything runs.

    Raises
    ------
    ResultError
    """
    refuse_to_replace(out, force, "a file", Path.is_file)
    if not report:
        return
    if out.suffix == HTML:
        remedy = f"give --out a name that ends in .csv; the report is {out.name} then"
        raise ResultError(f"{out} is to be the table and its report; {remedy}")
    refuse_to_replace(out.with_suffix(HTML), force, "a report", is_report)


def _progress(done: int, cases: int) -> dict[str, Any]:
    return {"completed": done, "total": cases}


def _exit_code(found: "Comparison") -> int:
    """That of the worst run."""
    from tpss.outages.row import Verdict

    verdicts = [row.verdict for row in found.rows]
    if Verdict.AUDIT_FAILED in verdicts:
        return AUDIT_FAILED
    return DONE if min(verdicts) >= Verdict.STRANDED else NO_SOLUTION


def _save(found: "Comparison", name: str, out: Path | None, force: bool) -> Path:
    """Write the table, whole or not at all; into the first free place if none is named."""
    from tpss.results.csv_texts import csv_of

    content = csv_of(found.table())
    try:
        return _write(content, name, out, force)
    except ResultError:
        print(content.decode())  # so that nothing is lost
        raise


def _write(content: bytes, name: str, out: Path | None, force: bool) -> Path:
    if out is not None:
        with explained(out):
            refuse_to_replace(out, force, "a file", Path.is_file)
            out.parent.mkdir(parents=True, exist_ok=True)
            whole.write_file(out, content)
        return out
    number = 1
    while True:
        place = PARENT / f"{name}-outages-{number:03d}.csv"
        with explained(place):
            PARENT.mkdir(exist_ok=True)
            if not any(map(os.path.lexists, (place, place.with_suffix(HTML)))):
                whole.write_file(place, content)
                return place
        number += 1


COLUMNS = (
    ("verdict", ""), ("lowest\nvoltage", "kV"), ("at", "km"), ("at", "min"),
    ("useful\nvoltage", "kV"), ("in zone", ""), ("peak load", "%"), ("15 min", "%"), ("of", ""),
    ("arrived", ""), ("late", ""), ("lost", "min"), ("losses", "MWh"), ("tripped", ""),
)  # fmt: skip
"""Headings and units of the columns, but for the first one; the last two where there are any."""

TEXTS = ("verdict", "in zone", "of", "tripped")
"""Columns that are not numbers."""


def print_table(found: "Comparison", console: Console) -> None:
    """Print a row per case, with what differs from the intact supply in brackets; in parts that fit."""
    from tpss.outages.row import LOSSES, TRIPS

    rows = [(row.outage, [row.verdict_in_words, *_cells(row, found.intact)]) for row in found.rows]

    def table_of(chosen: Sequence[int]) -> Table:
        table = Table(box=None, pad_edge=False, padding=(0, 1))
        widest = widest_text(console)
        table.add_column("outage\n", overflow="fold", max_width=widest)
        for k in chosen:
            heading, unit = COLUMNS[k]
            with_unit = f"{heading}\n[dim]{unit}[/dim]"
            if heading in TEXTS:
                table.add_column(with_unit, overflow="fold", max_width=widest)
            else:
                table.add_column(with_unit, justify="right", no_wrap=True)
        for name, cells in rows:
            table.add_row(escape(name), *(cells[k] for k in chosen))
        return table

    told = [key in found.intact.figures for key in (LOSSES, TRIPS)]
    shown = [*range(len(COLUMNS) - 2), *(len(COLUMNS) - 2 + k for k in range(2) if told[k])]
    for k, part in enumerate(parts_that_fit(shown, table_of, console)):
        say(console, "" if k else "Outages")
        console.print(table_of(part))


def _cells(row: "Row", intact: "Row") -> list[str]:
    own, base = row.figures, {} if row is intact else intact.figures
    return [
        _compared("lowest_voltage_kv", own, base),
        escape(on_line(own.get("lowest_voltage_line", ""), _number(own, "lowest_voltage_km", 1))),
        _number(own, "lowest_voltage_min", 1),
        _compared("useful_voltage_kv", own, base),
        escape(str(own.get("useful_voltage_zone", ""))),
        _number(own, "peak_loading", 0, 100.0),
        _number(own, "loading_15_min", 0, 100.0),
        escape(str(own.get("peak_loading_station", ""))),
        str(row.lost["arrived"]),
        str(row.lost["late"] + row.lost["missing"]),
        "" if row is intact else f"{round(row.lost['lost_min'], 2) + 0.0:.2f}",
        _compared("converter_losses_mwh", own, base),
        escape(own.get("trips", "")),
    ]


def _number(figures: Mapping[str, Any], key: str, digits: int, scale: float = 1.0) -> str:
    value = figures.get(key, math.nan)
    return "-" if math.isnan(value) else f"{scale * value:.{digits}f}"


def _compared(key: str, own: Mapping[str, Any], base: Mapping[str, Any]) -> str:
    """A figure, and by how much it differs from that of the intact supply."""
    text, change = _number(own, key, 2), own.get(key, math.nan) - base.get(key, math.nan)
    return text if math.isnan(change) or abs(change) < LEAST_CHANGE else f"{text} ({change:+.2f})"
