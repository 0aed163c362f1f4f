"""The commands that show a result, or a study, in another form, or beside measurements."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from tpss.cli import complete
from tpss.cli.arguments import (
    Corridor,
    Force,
    From,
    Labels,
    OneResult,
    ResultFolder,
    To,
    argument,
    flag,
    option,
    stations_of,
)
from tpss.results.contents import FIGURE_NAMES
from tpss.results.file_kinds import Kind, Spreadsheet


class Stamps(StrEnum):
    """What the time of a measured value says."""

    BEGIN = "begin"
    END = "end"


class Against(StrEnum):
    """What the horizontal axis of a journey shows."""

    TIME = "time"
    DISTANCE = "distance"


def report(
    results: Annotated[
        list[Path],
        argument(
            metavar="RESULT",
            help="Folder written by tpss run, of which several are compared side by side, or by tpss "
            "sweep.",
        ),
    ],
    out: Annotated[
        Path | None,
        option(
            help="HTML file to write; by default report.html in the result folder, or for several "
            "results comparison.html here."
        ),
    ] = None,
    label: Labels = None,
    corridor: Corridor = None,
    from_: From = None,
    to: To = None,
    title: Annotated[
        str | None,
        option(
            metavar="TEXT", help="Title of the report of a result, which gets a first page then."
        ),
    ] = None,
    project: Annotated[
        str | None, option(metavar="TEXT", help="Project, for the first page.")
    ] = None,
    author: Annotated[
        str | None, option(metavar="TEXT", help="Author, for the first page.")
    ] = None,
    remarks: Annotated[
        str | None,
        option(metavar="TEXT", help="Remarks, for the first page; empty lines part paragraphs."),
    ] = None,
    force: Force = False,
) -> None:
    """Write a report of a result, a comparison of several, or a report of a study into one HTML file.

    It holds summary, plots, tables, audit and scenario, opens in any browser without a network, and
    can be printed. With a title, project, author or remarks it begins with a page that has them, a
    drawing of the lines and the worst places.
    """
    from tpss.cli.report import report_results
    from tpss.cli.study import demand_unused, is_study, report_study

    stations = stations_of(corridor, from_, to)
    said = {"title": title, "project": project, "author": author, "remarks": remarks}
    cover = {name: text for name, text in said.items() if text is not None}
    if len(results) == 1 and is_study(results[0]):
        demand_unused("a study", label=label, corridor=stations, **cover)
        report_study(results[0], out, force)
        return
    if len(results) > 1:
        demand_unused("a comparison", **cover)
    report_results(results, out, force, label or [], stations, cover)


def compare(
    result: OneResult,
    measured: Annotated[
        Path,
        argument(
            metavar="MEASURED.csv",
            help="Measured series: a column of times, and columns QUANTITY:ELEMENT [UNIT], such as "
            "'station_active_power:West [MW]'.",
        ),
    ],
    map_: Annotated[
        Path | None,
        option(
            "--map",
            metavar="COLUMNS.toml",
            help="What columns with other headings are: quantity, element, unit.",
        ),
    ] = None,
    begins: Annotated[
        str | None,
        option(
            metavar="TIME",
            help="What the clock of the measurement shows at the run's minute 0, such as 05:30 or "
            "2026-03-02T05:30; of times that are counted, their minute then. By default starts_at of "
            "the scenario, or 0.",
        ),
    ] = None,
    find_offset: Annotated[
        float | None,
        option(
            metavar="MIN",
            help="Look for the offset of the measurement's clock, up to so many minutes on both sides, "
            "by least squares.",
        ),
    ] = None,
    stamps: Annotated[
        Stamps,
        typer.Option(
            metavar="WHICH",
            help="begin or end: what the time of a value is of the interval over which it holds.",
        ),
    ] = Stamps.BEGIN,
    step: Annotated[
        float | None,
        option(
            metavar="MIN",
            help="Length of the intervals over which means are compared; by default the longer step of "
            "the two.",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        option(help="Folder for tables (CSV) and figures (PNG); by default they are only printed."),
    ] = None,
    report: Annotated[
        bool,
        flag(
            "--report",
            help="Also write the result's report with the comparison, report.html in --out or else in "
            "the result folder.",
        ),
    ] = False,
    force: Force = False,
) -> None:
    """Compare a result with measurements; tpss report compares results with each other.

    Quantities are station_active_power, station_reactive_power and station_voltage of a station,
    active_power, reactive_power and pantograph_voltage of a train, and node_voltage of a node. Means
    over common intervals are compared; those that a gap touches are left out. Printed are means, the
    error with the confidence of its mean, energies, and the worst means over 1, 5, 15 and 60 min.

    Exit codes: 0 done, 2 the folder holds no result, its audit failed, the measurements have faults, or
    files cannot be written.
    """
    from tpss.cli.compare import compare_result

    compare_result(
        result, measured, map_, begins, find_offset, stamps.value, step, out, report, force
    )


def plot(
    results: Annotated[
        list[Path],
        argument(
            metavar="RESULT",
            help="Folder written by tpss run, of which several are drawn into one figure, or by tpss "
            "sweep.",
        ),
    ],
    figure: Annotated[
        str,
        typer.Option(
            metavar="NAME",
            help=f"{', '.join(FIGURE_NAMES)}, or all.",
            autocompletion=complete.figures,
        ),
    ] = "all",
    train: Annotated[
        str | None,
        option(help="Train of journey, train-voltage and effort; by default the studied one."),
    ] = None,
    against: Annotated[
        Against, typer.Option(metavar="AXIS", help="time or distance, of the journey.")
    ] = Against.DISTANCE,
    label: Labels = None,
    corridor: Corridor = None,
    from_: From = None,
    to: To = None,
    from_min: Annotated[
        float | None, option(metavar="MIN", help="First minute that time-distance shows.")
    ] = None,
    to_min: Annotated[
        float | None, option(metavar="MIN", help="Last minute that time-distance shows.")
    ] = None,
    out: Annotated[
        Path | None,
        option(
            help="File to write, .png, .svg or .pdf, or a folder for all; by default "
            "RESULT/figures/NAME.png. Of several results it has to be given."
        ),
    ] = None,
    force: Force = False,
) -> None:
    """Draw figures of a result or a study, one file per figure, for print and presentations.

    Of a study they are parallel, for parallel coordinates of what varied and what came of it, and
    trade-offs, two key figures against each other.

    Several results are overlaid: the first solid, the next dashed. That can be journey, train-voltage,
    stations, converters, converter-losses, unbalance, braking, storage and thermal.

    Exit codes: 0 done, 2 the folder holds no result, its audit failed, there is no such figure or
    train or nothing to draw, or the files cannot be written.
    """
    from tpss.cli.plot import plot_results
    from tpss.cli.study import demand_unused, is_study, plot_study

    stations = stations_of(corridor, from_, to)
    if len(results) == 1 and is_study(results[0]):
        minutes = {"from-min": from_min is not None, "to-min": to_min is not None}
        demand_unused("a study", train=train, corridor=stations, label=label, **minutes)
        plot_study(results[0], figure, out, force)
        return
    minutes_shown = from_min, to_min
    plot_results(
        results, figure, train, against.value, stations, minutes_shown, out, force, label or []
    )


def export(
    result: ResultFolder,
    to: Annotated[Kind, typer.Option(metavar="KIND", help="csv, xlsx or parquet.")] = Kind.CSV,
    out: Annotated[
        Path | None, option(help="Folder for the files; by default RESULT/tables.")
    ] = None,
    spreadsheet: Annotated[
        Spreadsheet | None,
        option(
            metavar="DECIMALS",
            help="CSV for a spreadsheet whose decimals begin with a point or a comma: columns are then "
            "separated by commas or semicolons, and texts like formulas are marked with an apostrophe.",
        ),
    ] = None,
    force: Force = False,
) -> None:
    """Write the tables of a result or a study as files for other programs; all are written or none.

    They hold trains and stations, every step of every train, violations of voltage limits, and the
    evidence for standards; of a study, every column of every case. Headings carry units, such as
    `energy [MWh]`. xlsx is one workbook; that of a result opens with its key figures and the scenario,
    and ends with the rows of all steps.

    Exit codes: 0 done, 2 the folder holds no result, or the files cannot be written.
    """
    from tpss.cli.export import export_result
    from tpss.cli.study import export_study, is_study

    if is_study(result):
        export_study(result, to, out, force, spreadsheet)
        return
    export_result(result, to, out, force, spreadsheet)


def export_profiles(
    result: OneResult,
    out: Annotated[Path, option(help="File to write (JSON).")],
    tracks: Annotated[
        Path | None,
        option(
            help="Table of where tracks lie on the lines, the tracks.csv of tpss import osrd; by "
            "default each line is a track of its name."
        ),
    ] = None,
    lowest: Annotated[
        bool,
        flag("--lowest", help="The lowest voltage of a stretch; by default the mean."),
    ] = False,
    stretch_km: Annotated[
        float, typer.Option(min=0.01, max=1000.0, help="Length of a stretch.", metavar="KM")
    ] = 1.0,
    band_kv: Annotated[
        float | None,
        option(
            min=0.01,
            max=10.0,
            metavar="KV",
            help="Width of a band of voltages; by default a tenth of the nominal one.",
        ),
    ] = None,
    power_class: Annotated[
        list[str] | None,
        option(metavar="CLASS", help="Power class of rolling stock; repeatable; by default 1."),
    ] = None,
    force: Force = False,
) -> None:
    """Write the voltages of a run as an electrical profile set of OSRD.

    Each stretch of track where trains ran has the band that its voltage does not fall below, at most the
    nominal voltage.

    Exit codes: 0 done, 2 the folder holds no result, its audit failed, or a file cannot be read or
    written.
    """
    from tpss.cli.export import export_profiles_of

    band_v = None if band_kv is None else 1e3 * band_kv
    export_profiles_of(result, tracks, out, lowest, stretch_km, band_v, power_class or ["1"], force)
