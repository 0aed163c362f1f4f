"""The command ``tpss sweep``: run a study, or tell what its folder holds."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from tpss.cli.run import AUDIT_FAILED, BAD_INPUT, DONE, INTERRUPTED
from tpss.errors import StudyError

if TYPE_CHECKING:
    from tpss.sweep.campaign import Advance
    from tpss.sweep.study import Study
    from tpss.sweep.summary import Summary

MOST_PROBLEMS = 5
"""Different problems of cases that are told in words."""


def demand_packages() -> None:
    """Refuse to go on without what studies need.

    Raises
    ------
    StudyError
    """
    absent = [name for name in ("distributed", "pyarrow", "scipy") if find_spec(name) is None]
    if absent:
        raise StudyError(f'studies need {", ".join(absent)}: pip install "tpss[study]"')


def run_study_file(
    file: Path,
    out: Path | None,
    scheduler: str | None,
    workers: int | None,
    dry_run: bool,
    quiet: bool,
) -> int:
    """Run a study, or only check it; return the exit code."""
    demand_packages()
    from tpss.sweep.campaign import run_study
    from tpss.sweep.study import load_study

    study = load_study(file)
    if dry_run or out is None:
        _print_estimate(study, workers)
        return DONE
    console = Console(stderr=True, quiet=quiet)
    _tell_of_compilation(console)
    try:
        with nullcontext() if quiet else _progress_bar(study.file.name, console) as report:
            ended = run_study(study, out, scheduler=scheduler, workers=workers, report=report)
    except KeyboardInterrupt:
        print("Interrupted; what is done is kept, and the same command goes on.", file=sys.stderr)
        return INTERRUPTED
    if not quiet:
        _print_rate(ended, console)
    return summarise_folder(out, quiet)


def summarise_folder(folder: Path, quiet: bool = False) -> int:
    """Print the key figures of a study's folder; return the exit code."""
    demand_packages()
    from tpss.sweep.design import design_of
    from tpss.sweep.folder import load_table, read_manifest
    from tpss.sweep.study import study_of_json
    from tpss.sweep.summary import summarise

    table = load_table(folder)
    cases = design_of(study_of_json(read_manifest(folder)["study"])).cases
    summary = summarise(table, cases)
    if not quiet:
        _print_summary(summary, folder)
    for problem, count in list(summary.problems.items())[:MOST_PROBLEMS]:
        print(f"{count} case(s) could not be run: {problem}", file=sys.stderr)
    if summary.audits_failed:
        print(f"The audit of {summary.audits_failed} case(s) failed.", file=sys.stderr)
        return AUDIT_FAILED
    return BAD_INPUT if summary.problems else DONE


def _tell_of_compilation(console: Console) -> None:
    from tpss.run.kernels import are_ready

    if not are_ready():
        console.print("Compiling the numerical kernels; this takes up to a minute, once.")


def _print_estimate(study: "Study", workers: int | None) -> None:
    from tpss.sweep.campaign import estimate

    found = estimate(study, workers)
    print(
        f"{study.file.name}: {found.cases:,} cases, {found.case_s * 1e3:.1f} ms each in one process, "
        f"about {_duration(found.whole_s)} with {found.workers} worker(s).  Nothing was written."
    )


def _duration(seconds: float) -> str:
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"


@contextmanager
def _progress_bar(name: str, console: Console) -> Iterator[Callable[["Advance"], None]]:
    """A progress bar with rate and time left; gives the callable to report to."""
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("cases  {task.fields[rate]}"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task(escape(name), total=None, rate="")

        def report(state: "Advance") -> None:
            rate = f"{_rate(state):,.0f} a second"
            bar.update(task, total=state.cases, completed=state.done, rate=rate)

        yield report


def _rate(state: "Advance") -> float:
    return (state.done - state.before) / max(state.elapsed_s, 1e-9)


def _print_rate(ended: "Advance", console: Console) -> None:
    run = ended.done - ended.before
    if run:
        console.print(
            f"{run:,} cases in {_duration(ended.elapsed_s)}, {_rate(ended):,.0f} a second",
            highlight=False,
        )
    if ended.before:
        console.print(f"{ended.before:,} cases were there already.", highlight=False)


def _print_summary(summary: "Summary", folder: Path) -> None:
    console = Console()
    states = ", ".join(f"{count:,} {status}" for status, count in summary.status.items())
    console.print(f"{summary.done:,} of {summary.cases:,} cases: {states}", highlight=False)
    table = Table(title="Cases that finished", title_justify="left", box=None, pad_edge=False)
    table.add_column("")
    for column in summary.spread.columns:
        table.add_column(column, justify="right")
    for label, row in summary.spread.iterrows():
        table.add_row(escape(str(label)), *(f"{value:.4g}" for value in row))
    if summary.status.get("finished"):
        console.print(table)
    console.print(f"Time of all cases together: {_duration(summary.work_s)}", highlight=False)
    console.print(f"The table lies in {folder / 'cases'}", highlight=False, soft_wrap=True)
