"""The command ``tpss run``."""

import os
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, TextColumn, TimeRemainingColumn
from rich.progress import Progress as ProgressBar

from tpss.errors import ResultError

if TYPE_CHECKING:
    from tpss.results.result import Result
    from tpss.run.run import Progress
    from tpss.scenario import Scenario

DONE, BAD_INPUT, NO_SOLUTION, AUDIT_FAILED, INTERRUPTED = 0, 2, 3, 4, 130


def run_scenario(
    file: Path,
    out: Path | None,
    assignments: list[str],
    force: bool,
    quiet: bool,
    show: str | None,
    report: bool,
) -> int:
    """Run a scenario file; return the exit code."""
    from tpss.results import store
    from tpss.scenario import load_scenario
    from tpss.scenario.override import parse_assignment

    changes = dict(parse_assignment(text) for text in assignments)
    scenario = load_scenario(file, changes)
    store.check_target(scenario, out, force)
    try:
        ended = _simulate_and_save(scenario, out, force, quiet)
    except KeyboardInterrupt:
        print("Interrupted; nothing was saved.", file=sys.stderr)
        return INTERRUPTED
    try:
        return _report(ended, quiet, show, report)
    except KeyboardInterrupt:
        if not ended.fault:
            print(f"Interrupted.  The result lies in {ended.folder}", file=sys.stderr)
        return INTERRUPTED
    finally:
        if ended.fault:
            print(ended.fault, file=sys.stderr)


@dataclass(frozen=True)
class _Ended:
    """A run that has ended and was saved, if it could be."""

    result: "Result"
    folder: Path | None
    fault: str
    """Why the result could not be saved as asked; empty if it was."""
    interrupted: bool


def exit_code(result: "Result") -> int:
    """Exit code that tells how a run ended."""
    if not result.audit["passed"]:
        return AUDIT_FAILED
    return {"finished": DONE, "interrupted": INTERRUPTED}.get(result.status, NO_SOLUTION)


def _simulate_and_save(scenario: "Scenario", out: Path | None, force: bool, quiet: bool) -> _Ended:
    """Simulate and save; from the first step on, a Ctrl-C ends the run and saves what there is."""
    from tpss.api import prepare
    from tpss.run.interrupt import interruptible
    from tpss.run.kernels import are_ready

    console = Console(stderr=True, quiet=quiet)
    if not are_ready():
        console.print("Compiling the numerical kernels; this takes up to half a minute, once.")
    prepared = prepare(scenario)
    with interruptible(None if quiet else _notice) as interrupted:
        with nullcontext() if quiet else _progress_bar(scenario.name, console) as progress:
            result = prepared.run(progress, interrupted)
        folder, fault = _save(result, out, force)
    return _Ended(result, folder, fault, bool(interrupted))


def _notice() -> None:
    """Written past the buffers of the program, which the Ctrl-C may have met at work on them."""
    with suppress(OSError):
        os.write(2, b"\nInterrupted: what there is will be saved; another Ctrl-C gives it up.\n")


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


def _save(result: "Result", out: Path | None, force: bool) -> tuple[Path | None, str]:
    """Save a result; if its folder fails, save into a temporary one.

    Returns the folder, if there is one, and what went wrong, if anything did.
    """
    try:
        return result.save(out, force=force), ""
    except ResultError as error:
        fault = str(error)
    try:
        rescue = _save_elsewhere(result)
    except (ResultError, OSError) as error:
        return None, f"{fault}\n{error}\nNothing of the result is kept but what is printed here."
    return rescue, f"{fault}\nThe result was saved into {rescue} instead."


def _save_elsewhere(result: "Result") -> Path:
    spare = Path(tempfile.mkdtemp(prefix=f"tpss-{result.scenario.name}-"))
    try:
        return result.save(spare, force=True)
    except ResultError:
        spare.rmdir()
        raise


def _report(ended: _Ended, quiet: bool, show: str | None, report: bool) -> int:
    """Print what matters; return the exit code."""
    from tpss.cli import tables
    from tpss.cli.report import write_report_of

    result, known = ended.result, ended.result.dataset.train.to_numpy().tolist()
    if not quiet or ended.folder is None:
        console = Console()
        tables.print_result(result, console)
        if show is not None and show in known:
            tables.print_train(result, show, console)
        if not ended.fault:
            saved = f"Saved in {ended.folder}"
            console.print(saved, highlight=False, soft_wrap=True, markup=False)
        if ended.interrupted and result.status != "interrupted":
            console.print("Interrupted when the run had ended: the result is whole.")
    if report and ended.folder is not None:
        file = write_report_of(result, ended.folder, force=False)
        if not quiet:
            print(f"Wrote {file}")
    if ended.fault:
        return BAD_INPUT
    if show is not None and show not in known:
        print(f"There is no train {show!r}; trains: {', '.join(known)}", file=sys.stderr)
        return BAD_INPUT
    code = exit_code(result)
    return INTERRUPTED if code == DONE and ended.interrupted else code
