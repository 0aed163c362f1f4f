"""The command ``tpss report``."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from tpss.errors import ResultError
from tpss.extras import demand
from tpss.results.contents import REPORT

if TYPE_CHECKING:
    from tpss.results.result import Result

COMPARISON = "comparison.html"


def report_results(
    folders: Sequence[Path],
    out: Path | None,
    force: bool,
    given: Sequence[str] = (),
    corridor: Sequence[str] = (),
) -> None:
    """Write a report of a result folder, or a comparison of several, and print where it is.

    Parameters
    ----------
    folders : sequence of path
    out : path, optional
    force : bool
    given : sequence of str
        Labels of compared results, if they are given.
    corridor : sequence of str
        Stations over which plots along a line are drawn, if they are given.

    Raises
    ------
    ResultError
        A folder holds no result or a damaged one, labels do not fit the results, there is no such
        corridor, or the file cannot be written.
    """
    demand("report")
    from tpss.report.html import check_target, write_report
    from tpss.results.result import load_result

    _demand_fitting(given, folders)
    own = Path(COMPARISON) if len(folders) > 1 else folders[0] / REPORT
    # A damaged result is reported before an existing report.
    results = [load_result(folder) for folder in folders]
    check_target(out or own, force)
    named = dict(zip(given or labels(folders, results), results, strict=True))
    shown = results[0] if len(results) == 1 else named
    file = write_report(shown, out or own, force=force, corridor=corridor)
    print(f"Wrote {file}")


def _demand_fitting(given: Sequence[str], folders: Sequence[Path]) -> None:
    """Raise a `ResultError` unless there is a label for each of several results, or none."""
    if not given:
        return
    if len(folders) == 1:
        raise ResultError("labels tell compared results apart; leave --label out for a single one")
    if len(given) != len(folders):
        counts = f"{len(given)} labels for {len(folders)} results"
        raise ResultError(f"{counts}; give --label once for each, in their order")
    twice = next((label for k, label in enumerate(given) if label in given[:k]), None)
    if twice is not None:
        raise ResultError(f"two results have the label {twice!r}; give each its own")


def labels(folders: Sequence[Path], results: Sequence["Result"]) -> list[str]:
    """Names of the scenarios, or of the folders where those are the same; each only once."""
    for names in (
        [result.scenario.name for result in results],
        [folder.resolve().name for folder in folders],
        [str(folder) for folder in folders],
    ):
        if len(set(names)) == len(names):
            return names
    return [f"{number}: {folder}" for number, folder in enumerate(folders, 1)]
