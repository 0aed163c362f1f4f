"""The command ``tpss spare-time``: energy that trains save against the minutes that they use."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.markup import escape
from rich.table import Table

from tpss.cli.table_and_picture import demand_room, write_picture, write_table
from tpss.cli.terminal import Console, announce_compilation, print_in_parts, progress_bar, say
from tpss.errors import ResultError

if TYPE_CHECKING:
    import pandas as pd

PROGRESS = "{task.completed}/{task.total} services"


def print_savings(
    file: Path,
    percents: Sequence[float],
    assignments: Sequence[str],
    out: Path | None,
    plot: Path | None,
    force: bool,
) -> None:
    """Print, and write if asked, what the trains of a scenario save with time to spare.

    Raises
    ------
    ScenarioError
        The scenario has faults.
    ResultError
        No train reaches its destination, or a file cannot be written.
    """
    from tpss.savings.drawing import savings_drawing
    from tpss.savings.table import PERCENTS, spare_time_savings
    from tpss.scenario import load_scenario
    from tpss.scenario.override import parse_assignment

    scenario = load_scenario(file, dict(parse_assignment(text) for text in assignments))
    demand_room(out, plot, force)
    console = Console(stderr=True)
    announce_compilation(console)
    with progress_bar(scenario.name, PROGRESS, _progress, console) as progress:
        table = spare_time_savings(scenario, percents or PERCENTS, progress)
    if table.empty:
        raise ResultError(
            f"{file}: no train reaches its destination at nominal voltage; see the notes of tpss check"
        )
    _print(table, Console())
    if out is not None:
        write_table(out, table)
    if plot is not None:
        write_picture(plot, savings_drawing(table))


def _progress(done: int, services: int) -> dict[str, Any]:
    return {"completed": done, "total": services}


def _savings(rows: "pd.DataFrame", title: str, manners: Sequence[str], more: str) -> Table:
    """What a service saves by some manners of using its time, a row for each share of time."""
    table = Table(title=title + more, title_justify="left", box=None, pad_edge=False)
    for heading in ("to spare\n%", "used\nmin", *(f"{manner}\n%" for manner in manners)):
        table.add_column(heading, justify="right", no_wrap=True)
    for percent, own in rows.groupby("spare_percent", sort=False):
        saved = own.set_index("manner").saved_percent
        texts = [f"{-saved[manner]:+.1f}" for manner in manners]
        table.add_row(f"{percent:g}", f"{own.spare_min.max():.1f}", *texts)
    return table


def _print(table: "pd.DataFrame", console: Console) -> None:
    for service, rows in table.groupby("service", sort=False):
        alike = int(rows.alike.iloc[0])
        more = f" and {alike - 1} more" if alike > 1 else ""
        title = escape(f"{service}{more} ({rows.train.iloc[0]})")
        manners = list(dict.fromkeys(rows.manner))
        print_in_parts(manners, partial(_savings, rows, title), console)
    say(console, "Energy of a lone train at nominal voltage, against one as fast as it can be.")
