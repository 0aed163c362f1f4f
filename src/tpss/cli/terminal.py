"""What several commands print: progress bars, plain lines, tables, and that the kernels are compiled."""

import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, TypeVar

from rich import console as rich_console
from rich.markup import escape
from rich.measure import Measurement
from rich.segment import Segment
from rich.table import Table

from tpss.printable import printable

Column = TypeVar("Column")

KERNELS = "{task.fields[detail]}"


class _Escaped:
    """What is printed, its texts without what would steer the terminal."""

    def __init__(self, printed: Any) -> None:
        self.printed = printed

    def __rich_console__(
        self, console: rich_console.Console, options: rich_console.ConsoleOptions
    ) -> Iterator[Segment]:
        for segment in console.render(self.printed, options):
            is_ours = segment.control is not None
            yield segment if is_ours else Segment(printable(segment.text, "\n"), segment.style)

    def __rich_measure__(
        self, console: rich_console.Console, options: rich_console.ConsoleOptions
    ) -> Measurement:
        return Measurement.get(console, options, self.printed)


class _Escape(rich_console.RenderHook):
    def process_renderables(
        self, renderables: list[rich_console.ConsoleRenderable]
    ) -> list[rich_console.ConsoleRenderable]:
        return [_Escaped(each) for each in renderables]


class Console(rich_console.Console):
    """A console that shows what would steer the terminal, in a text of others, as its code."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.push_render_hook(_Escape())


def say(console: Console, text: str) -> None:
    """Print a text as it is, on one line."""
    console.print(text, highlight=False, markup=False, soft_wrap=True)


def tell(text: str) -> None:
    """Print a line that may hold names of files, which others may have chosen."""
    print(printable(text, "\n"))


def announce_compilation(console: Console) -> bool:
    """Print that the kernels have to be compiled, if they have; tell whether."""
    from tpss.run.kernels import are_ready

    ready = are_ready()
    if not ready:
        console.print(
            "Compiling the numerical kernels; this takes up to a minute, once (tpss warm does it ahead)."
        )
    return not ready


@contextmanager
def compilation(console: Console) -> Iterator[None]:
    """Announce a compilation that has to be, and show a bar of the kernels that are done."""
    if not announce_compilation(console):
        yield
        return
    with counted_kernels("Compiling", console):
        yield


COUNTED_S = 0.2
"""Time between two counts of compiled kernels. [s]"""


@contextmanager
def counted_kernels(name: str, console: Console) -> Iterator[Callable[[str], None]]:
    """A bar of the kernels that are compiled, also by other processes; gives what renames it."""
    from tpss.kernel import compiled_kernels

    ended, named = threading.Event(), [name]

    def count(report: Callable[..., None]) -> None:
        while not ended.wait(COUNTED_S):
            report(named[0], *compiled_kernels())

    with progress_bar(name, KERNELS, _kernels_done, console) as report:
        counter = threading.Thread(target=count, args=(report,), daemon=True)
        if report is not None:
            counter.start()
        try:
            yield lambda text: named.__setitem__(0, text)
        finally:
            ended.set()
            if report is not None:
                counter.join()


def _kernels_done(name: str, done: int, kernels: int) -> dict[str, Any]:
    detail = f"{done}/{kernels} kernels"
    return {"description": escape(name), "completed": done, "total": kernels, "detail": detail}


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


def print_in_parts(
    columns: Sequence[Column],
    table_of: Callable[[Sequence[Column], str], Table],
    console: Console,
) -> None:
    """Print a table, in a narrow terminal in parts: `table_of` is handed what its title says more."""
    for k, part in enumerate(parts_that_fit(columns, lambda some: table_of(some, ""), console)):
        console.print(table_of(part, ", continued" if k else ""))


def widest_text(console: Console) -> int:
    """Characters of a name or another text of a table in a line, so that numbers have room beside it."""
    return console.width // 2 - 4


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
