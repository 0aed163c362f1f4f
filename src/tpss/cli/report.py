"""The command ``tpss report``."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from tpss.cli.labels import demand_fitting, labels
from tpss.cli.terminal import tell
from tpss.extras import demand
from tpss.results.contents import REPORT

COMPARISON = "comparison.html"

COVER = ("title", "project", "author", "remarks")
"""What a first page may say."""


def report_results(
    folders: Sequence[Path],
    out: Path | None,
    force: bool,
    given: Sequence[str] = (),
    corridor: Sequence[str] = (),
    cover: Mapping[str, str] | None = None,
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
    cover : mapping of str to str, optional
        What the first page of a single result's report says: title, project, author, remarks.

    Raises
    ------
    ResultError
        A folder holds no result or a damaged one, labels do not fit the results, there is no such
        corridor, or the file cannot be written.
    """
    demand("report")
    from tpss.report.cover import Cover
    from tpss.report.html import check_target, write_report
    from tpss.results.result import load_result

    demand_fitting(given, folders)
    own = Path(COMPARISON) if len(folders) > 1 else folders[0] / REPORT
    # A damaged result is reported before an existing report.
    results = [load_result(folder) for folder in folders]
    check_target(out or own, force)
    named = dict(zip(given or labels(folders, results), results, strict=True))
    shown = results[0] if len(results) == 1 else named
    title, project, author, remarks = ((cover or {}).get(name, "") for name in COVER)
    page = Cover(title, project, author, remarks) if cover else None
    file = write_report(shown, out or own, force=force, corridor=corridor, cover=page)
    tell(f"Wrote {file}")
