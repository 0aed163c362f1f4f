"""A report of a plan: one HTML file that needs nothing else, made of the folder of its answer."""

import datetime as dt
from dataclasses import dataclass
from pathlib import Path

import tomli_w

from tpss.files.refusals import explained
from tpss.files.whole import write_file
from tpss.planning.figures.catalogue import FIGURES
from tpss.planning.report_prices import tables_of_prices, without_source
from tpss.planning.report_tables import tables_of, values
from tpss.planning.sentence import TIE
from tpss.planning.tables import KNOWN, SIMULATED
from tpss.planning.wording import mean_in_words
from tpss.planning.written import Written, read_written
from tpss.report.html import check_target
from tpss.report.page import fill
from tpss.report.render.inline import inline
from tpss.results.contents import REPORT

MOST_LETTERS = 800_000
"""Letters of all pictures of a page; areas whose pictures would be beyond it are in the tables only."""


@dataclass(frozen=True)
class Picture:
    """A figure within a page."""

    key: str
    title: str
    text: str
    svg: str
    """Empty: nothing is drawn, and the text says why."""


@dataclass(frozen=True)
class Pictures:
    """Figures of an area; those of the whole plan have no name."""

    area: str
    title: str
    figures: list[Picture]


def write_plan_report(
    folder: str | Path, file: str | Path | None = None, *, force: bool = False
) -> Path:
    """Write a report of a plan that was solved into one HTML file.

    Parameters
    ----------
    folder : path
        As ``tpss plan run`` has written it.  The plan's files and its scenarios are not needed.
    file : path, optional
        File to write; by default ``report.html`` in the folder.
    force : bool
        Whether a report that is there may be replaced.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    PlanError
        It is no folder of a plan that was solved, something in it is missing or damaged, or a package is
        missing.
    ResultError
        The file exists, or cannot be written.
    """
    written = read_written(Path(folder))
    place = Path(file or Path(folder) / REPORT)
    check_target(place, force)
    page = plan_report(written).encode()
    with explained(place):
        write_file(place, page)
    return place


def plan_report(written: Written) -> str:
    """Page about a plan."""
    document = written.document
    drawn, left_out = pictures_of(written)
    return fill(
        "plan.html",
        written.file.name,
        {},
        {},
        document=document,
        plan=written.file,
        created=dt.datetime.now(dt.UTC).isoformat(timespec="seconds"),
        money=written.money,
        ties=_ties(written),
        nothing=not written.tables["decisions"].builds.any(),
        silent=without_source(written.file),
        futures=len(written.futures),
        configurations=sum(
            written.of("configurations", area).configuration.nunique() for area in written.areas
        ),
        values=values(written),
        mean=mean_in_words(document.get("mean_future", []), written.traffic),
        drawn=drawn,
        left_out=left_out,
        tables=tables_of(written),
        prices=tables_of_prices(written),
        source=tomli_w.dumps(document["plan"]),
    )


def _ties(written: Written) -> list[str]:
    """First decisions that cost the same as the best one, as exactly as costs are known."""
    frame = written.tables["first_decisions"]
    found, several = [], frame["if"].nunique() > 1
    if KNOWN in frame:
        frame = frame[frame[KNOWN] == SIMULATED]
    for (area, futures), group in frame.groupby(["area", "if"], sort=False):
        close = group[(group.surplus <= TIE * group.cost.abs())].configuration.tolist()
        if len(close) > 1:
            where = f"{area}: " if len(written.areas) > 1 else ""
            when = f" if {written.futures_in_words(str(futures))}" if several else ""
            found.append(f"{where}{', '.join(close)}{when}")
    return found


def pictures_of(written: Written) -> tuple[list[Pictures], list[str]]:
    """Pictures of a plan, area by area, and the areas for which there is no room."""
    found: list[Pictures] = []
    left_out: list[str] = []
    letters = 0
    several = len(written.areas) > 1
    for k, area in enumerate(written.areas):
        own = [
            _picture(written, area, name, f"{name}-{k}")
            for name, figure in FIGURES.items()
            if figure.of_area or not several
        ]
        letters += sum(len(each.svg) for each in own)
        if letters > MOST_LETTERS:
            left_out.append(area)
            continue
        title = written.file.areas[area].title if written.file.areas else ""
        found.append(Pictures(area if several else "", title, own))
    whole = [
        _picture(written, written.areas[0], name, name)
        for name, figure in FIGURES.items()
        if not figure.of_area and several
    ]
    if whole:
        found.append(Pictures("All areas", "", whole))
    return found, left_out


def _picture(written: Written, area: str, name: str, key: str) -> Picture:
    figure = FIGURES[name]
    drawing = figure.describe(written, area)
    if drawing is None:
        return Picture(key, figure.title, figure.otherwise, "")
    words = f"{figure.title} of {area}; the tables below hold its figures"
    return Picture(key, figure.title, figure.text, inline(drawing, key, words))
