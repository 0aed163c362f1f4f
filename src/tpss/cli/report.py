"""The command ``tpss report``."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from tpss.results.contents import REPORT

if TYPE_CHECKING:
    from tpss.results.result import Result

COMPARISON = "comparison.html"


def report_results(folders: Sequence[Path], out: Path | None, force: bool) -> None:
    """Write a report of a result folder, or a comparison of several, and print where it is.

    Raises
    ------
    ResultError
        A folder holds no result or a damaged one, or the file cannot be written.
    """
    from tpss.report.html import check_target, write_report
    from tpss.results.result import load_result

    own = Path(COMPARISON) if len(folders) > 1 else folders[0] / REPORT
    # A damaged result is reported before an existing report.
    results = [load_result(folder) for folder in folders]
    check_target(out or own, force)
    named = dict(zip(labels(folders, results), results, strict=True))
    file = write_report(results[0] if len(results) == 1 else named, out or own, force=force)
    print(f"Wrote {file}")


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
