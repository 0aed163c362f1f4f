"""The command ``tpss run``."""

import os
import sys
import tempfile
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tpss.cli.terminal import Console, compilation, progress_bar, say, tell
from tpss.errors import ResultError
from tpss.extras import demand
from tpss.printable import printable
from tpss.results.contents import REPORT

if TYPE_CHECKING:
    from tpss.results.result import Result
    from tpss.run.run import Progress
    from tpss.scenario import Scenario

PROGRESS = "{task.percentage:3.0f} %  {task.fields[detail]}"

DONE, BAD_INPUT, NO_SOLUTION, AUDIT_FAILED, INTERRUPTED = 0, 2, 3, 4, 130
SEVERITY = (DONE, NO_SOLUTION, AUDIT_FAILED, BAD_INPUT, INTERRUPTED)
"""Exit codes, the mildest first."""


def run_scenario(
    file: Path,
    out: Path | None,
    assignments: list[str],
    force: bool,
    quiet: bool,
    show: str | None,
    report: bool,
    step_check: bool,
    variants: Sequence[str] = (),
    outage: str | None = None,
) -> int:
    """Run a scenario file, or variants of it; return the exit code, that of the worst end."""
    if report:
        demand("report")
    from tpss.cli.train_names import demand_train
    from tpss.cli.variants import chosen, folders, print_side_by_side, row_of
    from tpss.results import store
    from tpss.scenario import load_scenario
    from tpss.scenario.override import parse_assignment

    changes = dict(parse_assignment(text) for text in assignments)
    scenarios = chosen(load_scenario(file, changes), variants)
    if outage is not None:
        scenarios = {name: each.with_outage(outage) for name, each in scenarios.items()}
    if show is not None:
        demand_train(show, list(scenarios.values()))
    targets = folders(out, scenarios)
    for name, scenario in scenarios.items():
        store.check_target(scenario, targets[name], force)
    codes, rows = [], {}
    for name, scenario in scenarios.items():
        code, result = _run_one(scenario, targets[name], force, quiet, show, report, step_check)
        codes.append(code)
        if result is None or code == INTERRUPTED:
            return code
        rows[name] = row_of(result)
    if len(rows) > 1 and not quiet:
        print_side_by_side(rows, Console())
    return max(codes, key=SEVERITY.index)


def _run_one(
    scenario: "Scenario",
    out: Path | None,
    force: bool,
    quiet: bool,
    show: str | None,
    report: bool,
    step_check: bool,
) -> "tuple[int, Result | None]":
    """Run, save and print one scenario; return its exit code, and its result, if it came to one."""
    try:
        ended = _simulate_and_save(scenario, out, force, quiet, step_check)
    except KeyboardInterrupt:
        print("Interrupted; nothing was saved.", file=sys.stderr)
        return INTERRUPTED, None
    try:
        return _report(ended, quiet, show, report), ended.result
    except KeyboardInterrupt:
        if not ended.fault:
            print(printable(f"Interrupted.  The result is in {ended.folder}"), file=sys.stderr)
        return INTERRUPTED, ended.result
    finally:
        if ended.fault:
            print(ended.fault, file=sys.stderr)


@dataclass(frozen=True)
class _Ended:
    """A run that has ended, and was saved if possible."""

    result: "Result"
    folder: Path | None
    fault: str
    """Why the result could not be saved as requested; empty if it was."""
    interrupted: bool


def exit_code(result: "Result") -> int:
    """Exit code of a run that has ended."""
    if not result.audit["passed"]:
        return AUDIT_FAILED
    return {"finished": DONE, "interrupted": INTERRUPTED}.get(result.status, NO_SOLUTION)


def _simulate_and_save(
    scenario: "Scenario", out: Path | None, force: bool, quiet: bool, step_check: bool
) -> _Ended:
    """Simulate and save; from the first step on, a Ctrl-C ends the run and saves the result so far."""
    from tpss.api import prepare
    from tpss.run.interrupt import interruptible

    console = Console(stderr=True, quiet=quiet)
    for note in scenario.file_notes:
        say(console, f"Note: {note}")
    with compilation(console):
        prepared = prepare(scenario)
    with interruptible(None if quiet else _notice) as interrupted:
        with progress_bar(scenario.name, PROGRESS, _progress, console) as progress:
            result = prepared.run(progress, interrupted, step_check=step_check, lost_time=True)
        folder, fault = _save(result, out, force)
    return _Ended(result, folder, fault, bool(interrupted))


def _notice() -> None:
    """Written without the program's buffers, which the Ctrl-C may have interrupted in a write."""
    with suppress(OSError):
        os.write(
            2, b"\nInterrupted: the result so far will be saved; another Ctrl-C discards it.\n"
        )


def _progress(state: "Progress") -> dict[str, Any]:
    detail = f"{state.time_s / 60:.1f} min simulated, {state.trains} trains on the line"
    detail += ", check" if state.in_check else ""
    return {"completed": state.share, "total": 1.0, "detail": detail}


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
        return None, f"{fault}\n{error}\nOnly what is printed here is kept of the result."
    return rescue, f"{fault}\nThe result was saved into {rescue} instead."


def _save_elsewhere(result: "Result") -> Path:
    spare = Path(tempfile.mkdtemp(prefix=f"tpss-{result.scenario.name}-"))
    try:
        return result.save(spare, force=True)
    except ResultError:
        spare.rmdir()
        raise


def _report(ended: _Ended, quiet: bool, show: str | None, report: bool) -> int:
    """Print the key figures; return the exit code."""
    from tpss.cli import tables

    result = ended.result
    if not quiet or ended.folder is None:
        console = Console()
        tables.print_result(result, console)
        if show is not None:
            tables.print_train(result, show, console)
        if not ended.fault:
            say(console, f"Saved in {ended.folder}")
        if ended.interrupted and result.status != "interrupted":
            console.print("Interrupted after the run had ended: the result is complete.")
    if report and ended.folder is not None:
        from tpss.report.html import write_report

        file = write_report(result, ended.folder / REPORT)
        if not quiet:
            tell(f"Wrote {file}")
    if ended.fault:
        return BAD_INPUT
    code = exit_code(result)
    return INTERRUPTED if code == DONE and ended.interrupted else code
