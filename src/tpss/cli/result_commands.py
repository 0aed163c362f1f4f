"""The commands that show a result, or a study, in another form: report, figures, tables, profiles."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from tpss.cli import complete
from tpss.cli.arguments import (
    Corridor,
    Force,
    From,
    OneResult,
    ResultFolder,
    To,
    argument,
    option,
    stations_of,
)
from tpss.results.contents import FIGURE_NAMES
from tpss.results.file_kinds import Kind


class Against(StrEnum):
    """What the horizontal axis of a journey shows."""

    TIME = "time"
    DISTANCE = "distance"


def report(
    results: Annotated[
        list[Path],
        argument(
            metavar="RESULT...",
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
    label: Annotated[
        list[str] | None,
        option(
            metavar="TEXT",
            help="What a compared result is called, in their order; once for each. By default they have "
            "the names of their scenarios or folders.",
        ),
    ] = None,
    corridor: Corridor = None,
    from_: From = None,
    to: To = None,
    force: Force = False,
) -> None:
    """Write a report of a result, a comparison of several, or a report of a study into one HTML file.

    It holds summary, plots, tables, audit and scenario, opens in any browser without a network, and
    can be printed.
    """
    from tpss.cli.report import report_results
    from tpss.cli.study import demand_unused, is_study, report_study

    if len(results) == 1 and is_study(results[0]):
        demand_unused("a study", label=label, corridor=stations_of(corridor, from_, to))
        report_study(results[0], out, force)
        return
    report_results(results, out, force, label or [], stations_of(corridor, from_, to))


def plot(
    result: ResultFolder,
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
    corridor: Corridor = None,
    from_: From = None,
    to: To = None,
    out: Annotated[
        Path | None,
        option(
            help="File to write, .png, .svg or .pdf, or a folder for all; by default "
            "RESULT/figures/NAME.png."
        ),
    ] = None,
    force: Force = False,
) -> None:
    """Draw figures of a result or a study, one file per figure, for print and presentations.

    Of a study they are parallel, for parallel coordinates of what varied and what came of it, and
    trade-offs, two key figures against each other.

    Exit codes: 0 done, 2 the folder holds no result, its audit failed, there is no such figure or
    train or nothing to draw, or the files cannot be written.
    """
    from tpss.cli.plot import plot_result
    from tpss.cli.study import demand_unused, is_study, plot_study

    stations = stations_of(corridor, from_, to)
    if is_study(result):
        demand_unused("a study", train=train, corridor=stations)
        plot_study(result, figure, out, force)
        return
    plot_result(result, figure, train, against.value, stations, out, force)


def export(
    result: ResultFolder,
    to: Annotated[Kind, typer.Option(metavar="KIND", help="csv, xlsx or parquet.")] = Kind.CSV,
    out: Annotated[
        Path | None, option(help="Folder for the files; by default RESULT/tables.")
    ] = None,
    force: Force = False,
) -> None:
    """Write the tables of a result or a study as files for other programs; all are written or none.

    They hold trains and stations, every step of every train, violations of voltage limits, and the
    evidence for standards; of a study, every column of every case. Headings carry units, such as
    `energy [MWh]`. xlsx is one workbook.

    Exit codes: 0 done, 2 the folder holds no result, or the files cannot be written.
    """
    from tpss.cli.export import export_result
    from tpss.cli.study import export_study, is_study

    if is_study(result):
        export_study(result, to, out, force)
        return
    export_result(result, to, out, force)


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
        typer.Option("--lowest", help="The lowest voltage of a stretch; by default the mean."),
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
