"""The command ``tpss sweep``: run a study, or print a summary of its folder."""

import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.markup import escape
from rich.table import Table

from tpss.cli.run import AUDIT_FAILED, BAD_INPUT, DONE, INTERRUPTED
from tpss.cli.terminal import Console, announce_compilation, print_in_parts, progress_bar, say
from tpss.extras import demand

if TYPE_CHECKING:
    from tpss.sweep.progress import Advance
    from tpss.sweep.study import Study
    from tpss.sweep.summary import Summary

PROGRESS = "{task.completed}/{task.total} cases  {task.fields[detail]}"

MOST_PROBLEMS = 5
"""Different problems of cases that are printed."""


def run_study_file(
    file: Path,
    out: Path | None,
    scheduler: str | None,
    workers: int | None,
    dry_run: bool,
    quiet: bool,
    step_check: bool,
) -> int:
    """Run a study, or only check it; return the exit code."""
    demand("study", *(["scheduler"] if scheduler else []))
    from tpss.sweep.campaign import run_study
    from tpss.sweep.study import load_study

    study = load_study(file)
    if dry_run or out is None:
        _print_estimate(study, workers, step_check)
        return DONE
    console = Console(stderr=True, quiet=quiet)
    announce_compilation(console)
    try:
        with progress_bar(study.file.name, PROGRESS, _progress, console) as report:
            ended = run_study(
                study, out, scheduler=scheduler, workers=workers, report=report,
                step_check=step_check,
            )  # fmt: skip
    except KeyboardInterrupt:
        print(
            "Interrupted; finished cases are kept, and the same command continues.", file=sys.stderr
        )
        return INTERRUPTED
    if not quiet:
        _print_rate(ended, console)
    return summarise_folder(out, quiet)


def summarise_folder(folder: Path, quiet: bool = False) -> int:
    """Print the key figures of a study's folder; return the exit code."""
    demand("study")
    from tpss.sweep.design import design_of
    from tpss.sweep.folder import STEP_CHECK, load_table, read_manifest
    from tpss.sweep.step_sample import sample_in_words
    from tpss.sweep.study import study_of_json
    from tpss.sweep.summary import summarise

    table = load_table(folder)
    manifest = read_manifest(folder)
    cases = design_of(study_of_json(manifest["study"])).cases
    summary = summarise(table, cases)
    if not quiet:
        sample = manifest.get(STEP_CHECK)
        _print_summary(summary, folder, "" if sample is None else sample_in_words(sample))
    for problem, count in list(summary.problems.items())[:MOST_PROBLEMS]:
        print(f"{count} case(s) could not be run: {problem}", file=sys.stderr)
    if summary.audits_failed:
        print(f"The audit of {summary.audits_failed} case(s) failed.", file=sys.stderr)
        return AUDIT_FAILED
    return BAD_INPUT if summary.problems else DONE


def _print_estimate(study: "Study", workers: int | None, step_check: bool) -> None:
    from tpss.sweep.campaign import estimate

    expected = estimate(study, workers, step_check=step_check)
    each_ms = expected.case_s * 1e3
    print(
        f"{study.file.name}: {expected.cases:,} cases, {each_ms:.1f} ms each in one process, after "
        f"{_duration(expected.before_s)} of checks and start, about {_duration(expected.whole_s)} "
        f"with {expected.workers} worker(s).  Nothing was written."
    )


def _duration(seconds: float) -> str:
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"


def _progress(state: "Advance") -> dict[str, Any]:
    detail = f"{_rate(state):,.0f} per second"
    return {"completed": state.done, "total": state.cases, "detail": detail}


def _rate(state: "Advance") -> float:
    return (state.done - state.before) / max(state.elapsed_s, 1e-9)


def _print_rate(ended: "Advance", console: Console) -> None:
    run = ended.done - ended.before
    if run:
        rate = f"{_rate(ended):,.0f} per second"
        say(console, f"{run:,} cases in {_duration(ended.elapsed_s)}, {rate}")
    if ended.before:
        say(console, f"{ended.before:,} cases were finished before.")


def _spread(summary: "Summary", columns: Sequence[str], more: str) -> Table:
    """Spread of key figures over the cases, some columns of it."""
    title = f"Cases that finished{more}"
    table = Table(title=title, title_justify="left", box=None, pad_edge=False)
    table.add_column("", overflow="fold")
    for column in columns:
        table.add_column(column, justify="right", no_wrap=True)
    for label, row in summary.spread[list(columns)].iterrows():
        table.add_row(escape(str(label)), *(f"{value:.4g}" for value in row))
    return table


def _print_summary(summary: "Summary", folder: Path, step_check: str) -> None:
    console = Console()
    states = ", ".join(f"{count:,} {status}" for status, count in summary.status.items())
    say(console, f"{summary.done:,} of {summary.cases:,} cases: {states}")
    if summary.status.get("finished"):
        print_in_parts(list(summary.spread.columns), partial(_spread, summary), console)
    if step_check:
        say(console, step_check)
    say(console, f"Computing time of all cases: {_duration(summary.work_s)}")
    say(console, f"The table is in {folder / 'cases'}")
