"""Arguments and options of ``tpss import``."""

from datetime import datetime
from pathlib import Path
from typing import Annotated

import typer

from tpss.cli.arguments import Force, argument, flag, option
from tpss.cli.commands import Commands

app = typer.Typer(
    help="Make scenario files from files of other formats.", cls=Commands, no_args_is_help=True
)


@app.callback()
def _imports() -> None:
    pass


@app.command(
    epilog="Example:  tpss import ttobench SE_Vasteras_Kolback.json CH_Stadler_FLIRT_TPF.json "
    "--out vasteras"
)
def ttobench(
    files: Annotated[list[Path], argument(metavar="FILE", help="Tracks and trains (JSON).")],
    out: Annotated[Path, option(help="Folder for the files.")],
    force: Force = False,
) -> None:
    """Turn tracks and trains of TTOBench into lines and trains, and each pair into a scenario.

    A track gives a line (TOML, with a CSV profile of its gradients), a train gives a model file.
    Comments in each state what was read, left out and assumed. Every pair of a track and a train
    gives a scenario that can be run; its supply and its traffic are assumed, and marked as such.
    """
    from tpss.cli.imports import import_ttobench

    import_ttobench(files, out, force)


@app.command(epilog="Example:  tpss import osrd infra.json trains.json --out small")
def osrd(
    infra: Annotated[Path, argument(metavar="INFRA", help="Infrastructure (railjson 3).")],
    out: Annotated[Path, option(help="Folder for the files.")],
    trains: Annotated[
        Path | None, argument(metavar="TRAINS", help="Train schedules (JSON).")
    ] = None,
    rolling_stock: Annotated[
        list[Path] | None,
        option(metavar="FILE", help="Rolling stock of a train (JSON); repeatable."),
    ] = None,
    force: Force = False,
) -> None:
    """Turn an infrastructure of OSRD, and its train schedules, into lines and a timetable.

    Tracks in a row become a line, operational points and switches its stations; lines meet at stations
    of one name. tracks.csv says which track lies where. Signalling is left out. In scenario.toml the
    supply is assumed, and marked as such, and so are types of train without a file of rolling stock; of
    one with a file the effort curve of the lines' voltage is taken.
    """
    from tpss.cli.imports import import_osrd

    import_osrd(infra, trains, rolling_stock or [], out, force)


@app.command(
    epilog="Example:  tpss import gtfs feed.zip --route 'Line 7' --date 2025-03-12 --out line7"
)
def gtfs(
    feed: Annotated[Path, argument(metavar="FEED", help="Zip file or folder of a GTFS feed.")],
    route: Annotated[
        list[str],
        option(metavar="NAME", help="Id, short or long name of a route; repeatable."),
    ],
    out: Annotated[Path, option(help="Folder for the files.")],
    date: Annotated[
        datetime | None,
        option(
            formats=["%Y-%m-%d"],
            metavar="YYYY-MM-DD",
            help="Day; by default the first one with the most trips.",
        ),
    ] = None,
    force: Force = False,
) -> None:
    """Turn routes of a GTFS feed into lines of stations and a timetable of one day.

    The trip with the most stations becomes a line, what others serve besides further ones. Kilometres
    are along the shapes of trips, or straight between coordinates. Gradients, speed limits, supply and
    types of train are assumed, and marked as such. Frequencies become services.
    """
    from tpss.cli.imports import import_gtfs

    import_gtfs(feed, route, date.date() if date else None, out, force)


@app.command(epilog="Example:  tpss import railml network.railml --out network")
def railml(
    file: Annotated[Path, argument(metavar="FILE", help="File of railML 2 or 3 (XML).")],
    out: Annotated[Path, option(help="Folder for the files.")],
    force: Force = False,
) -> None:
    """Turn the tracks of a railML file into lines, and the trains of railML 2 into a timetable.

    Tracks in a row become a line in its own kilometres, operational points and switches its stations;
    lines meet at stations of one name. tracks.csv says which track lies where. Signalling is left out.
    In scenario.toml the supply and the types of train are assumed, and marked as such. Of a railML 2
    file without tracks the trains alone are read, as timetable.csv: the lines have to have its stations.
    """
    from tpss.cli.imports import import_railml

    import_railml(file, out, force)


@app.command(
    name="csv",
    epilog="Examples:  tpss import csv heights.csv limits.xlsx stations.csv, then the same with "
    "--out ours; tpss import csv gradients=profile.xlsx#Sheet2 --smooth-over 0.5 --out ours",
)
def tables(
    files: Annotated[
        list[str] | None,
        argument(
            metavar="[KIND=]FILE",
            help="Tables, CSV or workbooks (.xlsx, #SHEET behind for another than the first). KIND is "
            "gradients, speed-limits, stations, effort, braking, losses or timetable; by default it "
            "follows from the headings.",
        ),
    ] = None,
    out: Annotated[
        Path | None, option(help="Folder for the files; without it nothing is written.")
    ] = None,
    decimal: Annotated[
        str,
        option(
            metavar="SIGN", help="point or comma, where numbers do not say what begins decimals."
        ),
    ] = "",
    smooth_over: Annotated[
        float | None,
        option(
            min=0.01,
            max=100.0,
            metavar="KM",
            help="Length over which altitudes are averaged before gradients follow from them.",
        ),
    ] = None,
    headings: Annotated[
        bool, flag("--headings", help="List the headings that are known, and units.")
    ] = False,
    force: Force = False,
) -> None:
    """Show how tables of numbers are understood, and write them as files of a scenario.

    Shown are separator, decimals and encoding, what each column means, in which unit, its ends and first
    values, and gradients that are derived from altitudes. With --out each table is written in CSV, with
    headings of TPSS; gradients, speed limits and stations also give a line, line.toml. Scenarios name
    tables as they are too; what is written here is what they would have read.
    """
    from tpss.cli.import_csv import import_tables, print_headings

    if headings and not files:
        print_headings()
        return
    if headings or not files:
        raise typer.BadParameter("give files, or --headings alone")
    import_tables(files, out, decimal, smooth_over, force)
