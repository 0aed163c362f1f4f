"""The command ``tpss run``."""

import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, TextColumn, TimeRemainingColumn
from rich.progress import Progress as ProgressBar

from tpss.errors import ResultError

if TYPE_CHECKING:
    from tpss.results.result import Result
    from tpss.scenario import Scenario
    from tpss.simulation.run import Progress

DONE, BAD_INPUT, NO_SOLUTION, AUDIT_FAILED, INTERRUPTED = 0, 2, 3, 4, 130


def run_scenario(
    file: Path, out: Path | None, assignments: list[str], force: bool, quiet: bool, show: str | None
) -> int:
    """Run a scenario file; return the exit code."""
    from tpss.results import store
    from tpss.scenario import load_scenario
    from tpss.scenario.override import parse_assignment

    changes = dict(parse_assignment(text) for text in assignments)
    scenario = load_scenario(file, changes)
    folder = out if out is not None else store.next_folder(scenario.name)
    store.check_target(folder, force)
    result = _simulate(scenario, quiet)
    folder, as_asked = _save(result, folder, force)
    known = result.dataset.train.to_numpy().tolist()
    if not quiet:
        _report(result, folder, show if show in known else None)
    if show is not None and show not in known:
        print(f"There is no train {show!r}; trains: {', '.join(known)}", file=sys.stderr)
        return BAD_INPUT
    return exit_code(result) if as_asked else BAD_INPUT


def exit_code(result: "Result") -> int:
    """Exit code that tells how a run ended."""
    if not result.audit["passed"]:
        return AUDIT_FAILED
    return {"finished": DONE, "interrupted": INTERRUPTED}.get(result.status, NO_SOLUTION)


def _simulate(scenario: "Scenario", quiet: bool) -> "Result":
    from tpss.api import simulate
    from tpss.kernel import kernels_are_compiled

    if quiet:
        return simulate(scenario)
    console = Console(stderr=True)
    if not kernels_are_compiled():
        console.print("Compiling the numerical kernels; this takes up to half a minute, once.")
    with _progress_bar(scenario.name, console) as progress:
        return simulate(scenario, progress)


@contextmanager
def _progress_bar(name: str, console: Console) -> Iterator[Callable[["Progress"], None]]:
    """A progress bar with simulated time and trains on the line; gives the callable to report to."""
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:3.0f} %  {task.fields[clock]}"),
        TimeRemainingColumn(),
    )
    with ProgressBar(*columns, console=console, transient=True) as bar:
        task = bar.add_task(escape(name), total=1.0, clock="")

        def report(state: "Progress") -> None:
            clock = f"{state.time_s / 60:.1f} min simulated, {state.trains} trains on the line"
            bar.update(task, completed=state.share, clock=clock)

        yield report


def _save(result: "Result", folder: Path, force: bool) -> tuple[Path, bool]:
    """Save a result; if its folder fails, save into a temporary one, and say so.

    Returns the folder, and whether it is the one that was asked for.
    """
    try:
        return result.save(folder, force=force), True
    except ResultError as error:
        rescue = result.save(Path(tempfile.mkdtemp(prefix="tpss-")) / folder.name)
        print(f"{error}\nThe result was saved into {rescue} instead.", file=sys.stderr)
        return rescue, False


def _report(result: "Result", folder: Path, show: str | None) -> None:
    from tpss.cli import tables

    console = Console()
    tables.print_result(result, console)
    if show is not None:
        tables.print_train(result, show, console)
    console.print(f"Saved in {folder}", highlight=False, soft_wrap=True, markup=False)
