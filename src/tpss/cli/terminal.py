"""What several commands print: progress bars, plain lines, tables, and that the kernels are compiled."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, TypeVar

from rich.console import Console
from rich.markup import escape
from rich.measure import Measurement
from rich.table import Table

from tpss.printable import printable

Column = TypeVar("Column")


def say(console: Console, text: str) -> None:
    """Print a text as it is, on one line; what would steer the terminal is shown as its code."""
    console.print(printable(text, "\n"), highlight=False, markup=False, soft_wrap=True)


def announce_compilation(console: Console) -> None:
    """Print that the kernels have to be compiled, if they have."""
    from tpss.run.kernels import are_ready

    if not are_ready():
        console.print("Compiling the numerical kernels; this takes up to a minute, once.")


def parts_that_fit(
    columns: Sequence[Column], table_of: Callable[[Sequence[Column]], Table], console: Console
) -> list[list[Column]]:
    """Columns of a table in as many parts as a narrow terminal needs to show their cells whole."""
    parts: list[list[Column]] = [[]]
    for column in columns:
        if parts[-1] and width_of(table_of([*parts[-1], column])) > console.width:
            parts.append([])
        parts[-1].append(column)
    return parts


def width_of(table: Table) -> int:
    """Width of a table that nothing limits."""
    endless = Console(width=10_000)
    return Measurement.get(endless, endless.options, table).maximum


@contextmanager
def progress_bar(
    name: str, detail: str, state_of: Callable[..., dict[str, Any]], console: Console
) -> Iterator[Callable[..., None] | None]:
    """A progress bar; gives the callable to report to, or None if the console is quiet.

    Parameters
    ----------
    name, detail : str
        Texts before and after the bar.
    state_of : callable
        Turns what is reported into fields of a task.
    console : Console
    """
    if console.quiet:
        yield None
        return
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn(detail),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task(escape(name), total=None, detail="")
        yield lambda *state: bar.update(task, **state_of(*state))
