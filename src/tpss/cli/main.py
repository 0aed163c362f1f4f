"""Entry point of the command line.

Exit codes: 0 done, 2 bad input, 3 no solution, a stalled train or a deadlock (results up to then are
saved), 4 the audit failed, 5 a better plan may exist, 130 interrupted (results are saved).
"""

import atexit
import gc
import logging
import os
import sys
from pathlib import Path
from typing import Annotated

import typer

from tpss.cli import (
    approximate_app,
    import_app,
    plan_app,
    repeated_commands,
    result_commands,
    start_commands,
)
from tpss.cli.arguments import (
    Assignments,
    Force,
    Library,
    NoStepCheck,
    Plain,
    Quiet,
    ScenarioFile,
    argument,
    flag,
    option,
)
from tpss.cli.commands import Commands

app = typer.Typer(
    cls=Commands,
    name="tpss",
    help="TPSS, the Train Power System Simulator: trains and their power supply, simulated together.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="markdown",
    epilog="Start with:  tpss new my-line, then tpss run my-line/scenario.toml",
)
app.add_typer(import_app.app, name="import")
app.add_typer(approximate_app.app, name="approximate")
app.add_typer(plan_app.app, name="plan")


def _print_version(value: bool) -> None:
    if value:
        from importlib.metadata import version

        typer.echo(f"tpss {version('tpss')}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool,
        flag("--version", callback=_print_version, is_eager=True, help="Show the version."),
    ] = False,
) -> None:
    pass


@app.command(
    epilog="Examples:  tpss run my-line/scenario.toml --set traffic.0.headway_min=12 (after tpss new "
    "my-line), or tpss run both_ways.toml --variant all (after tpss new . --from both-ways)"
)
def run(
    file: ScenarioFile,
    out: Annotated[
        Path | None, option(help="Folder for the result; by default results/NAME-NNN.")
    ] = None,
    set_: Assignments = None,
    _library: Library = None,
    force: Annotated[bool, flag("--force", help="Replace an existing result folder.")] = False,
    quiet: Quiet = False,
    show: Annotated[
        str | None,
        option(
            metavar="TRAIN",
            help="Print a train's motion, voltage, forces and current at every step, such as "
            "--show 'eastbound 1'.",
        ),
    ] = None,
    report: Annotated[
        bool, flag("--report", help="Also write report.html into the result folder.")
    ] = False,
    no_step_check: NoStepCheck = False,
    variant: Annotated[
        list[str] | None,
        option(
            metavar="NAME",
            help="Run a variant of the scenario in its place; repeatable; all: the scenario and all of "
            "its variants. Several are compared, each in a folder of its own, in that of --out.",
        ),
    ] = None,
    outage: Annotated[
        str | None,
        option(
            metavar="NAME",
            help="Run with an outage of the scenario's [[outages]], which otherwise do not apply.",
        ),
    ] = None,
    _plain: Plain = False,
) -> None:
    """Simulate a scenario, print the key figures, and save the result.

    The run is made again with half its time step, to print what moves; beyond 1 %, or 2 % of a voltage
    drop or a peak loading, a note names the step that would do. It is made once more at the stations'
    voltage without load, to print what trains lost to the voltage.

    Exit codes: 0 done, 2 bad input, 3 the line cannot carry its load or a train stalls (results up
    to then are saved), 4 the audit failed, 130 interrupted (results are saved).
    """
    from tpss.cli.run import run_scenario

    code = run_scenario(
        file,
        out,
        set_ or [],
        force,
        quiet,
        show,
        report,
        step_check=not no_step_check,
        variants=variant or [],
        outage=outage,
    )
    raise typer.Exit(code)


app.command(
    epilog="Examples:  tpss report results/thesis-160km-001, then tpss report results/a results/b "
    "--label before --label after"
)(result_commands.report)
app.command(
    epilog="Examples:  tpss compare results/thesis-160km-001 measured.csv --begins 06:00, then "
    "tpss compare results/thesis-160km-001 measured.csv --find-offset 5 --out compared --report"
)(result_commands.compare)
app.command(
    epilog="Examples:  tpss plot results/thesis-160km-001, then tpss plot results/thesis-160km-001 "
    "--figure journey --train 'eastbound 3' --against time --out journey.pdf"
)(result_commands.plot)


@app.command(epilog="Example:  tpss check my-line/scenario.toml --set supply.catenary=AT")
def check(file: ScenarioFile, set_: Assignments = None, _library: Library = None) -> None:
    """List every fault of a scenario, or print what it describes, without simulating it.

    Notes point out what is not a fault, but may not be intended. Exit codes: 0 the scenario has no
    fault, 2 it has some; each is listed with its place and its remedy.
    """
    from tpss.cli.check import check_scenario

    check_scenario(file, set_ or [])


app.command(epilog="Example:  tpss export results/thesis-160km-001 --to xlsx")(
    result_commands.export
)
app.command(
    epilog="Example:  tpss export-profiles results/small-001 --tracks small/tracks.csv "
    "--out profiles.json"
)(result_commands.export_profiles)


@app.command(
    epilog="Examples:  tpss sweep study_converters.toml --out converters (after tpss new . --from "
    "study-converters), then tpss sweep --summary converters"
)
def sweep(
    study: Annotated[
        Path | None,
        argument(metavar="STUDY", help="Study file (TOML); with --case also its folder."),
    ] = None,
    out: Annotated[
        Path | None,
        option(help="Folder for the table; a study that it holds in part is continued."),
    ] = None,
    scheduler: Annotated[
        str | None,
        option(
            metavar="ADDRESS",
            help="Dask scheduler, such as tcp://10.0.0.1:8786; by default processes here.",
        ),
    ] = None,
    workers: Annotated[
        int | None, option(min=1, help="Processes on this computer; by default one per core.")
    ] = None,
    dry_run: Annotated[
        bool,
        flag(
            "--dry-run",
            help="Check the study, and print the number of cases and the expected time.",
        ),
    ] = False,
    summary: Annotated[
        Path | None, option(metavar="DIR", help="Print key figures of a study's folder.")
    ] = None,
    no_step_check: NoStepCheck = False,
    case: Annotated[
        int | None,
        option(
            min=0,
            metavar="NUMBER",
            help="Write a case as a scenario into --out, by default NAME-NUMBER.toml here; the study is "
            "then given by its file or its folder, and nothing is simulated.",
        ),
    ] = None,
    _library: Library = None,
    force: Force = False,
    quiet: Quiet = False,
) -> None:
    """Run the cases of a study, and write one row per case into a table (Parquet).

    A line that collapses or a train that stalls is a result. After an interruption of any kind, the
    same command continues the study, and runs no case twice.

    A few of the cases are made again with half their time step, once, to print what moves.

    Exit codes: 0 done, 2 bad input, or some cases could not be run (the table says why), 4 the audit
    of a case failed, 130 interrupted (finished cases are kept).
    """
    from tpss.cli.study import write_case
    from tpss.cli.sweep import run_study_file, summarise_folder

    if summary is not None and study is None:
        raise typer.Exit(summarise_folder(summary))
    if study is None or summary is not None:
        raise typer.BadParameter("give either a study, or --summary with its folder")
    if case is not None:
        write_case(study, case, out, force)
        return
    if out is None and not dry_run:
        raise typer.BadParameter("give --out with a folder for the table, or --dry-run")
    code = run_study_file(
        study, out, scheduler, workers, dry_run, quiet, step_check=not no_step_check
    )
    raise typer.Exit(code)


app.command(
    epilog="Examples:  tpss outages network.toml --n-1 (after tpss new . --from network), then tpss run "
    "network.toml --outage NAME for one of the scenario's own in full"
)(repeated_commands.outages)
app.command(
    epilog="Example:  tpss converters line.toml --set 'supply.converter_stations.*.type=Q48/Q49 with "
    "losses (estimate)'"
)(repeated_commands.converters)
app.command(
    name="spare-time",
    epilog="Examples:  tpss spare-time emu_25kv.toml (after tpss new . --from emu-25kv), then tpss run "
    "emu_25kv.toml --set traffic.0.supplement_percent=5 --set traffic.0.spare_time=least-energy",
)(repeated_commands.spare_time)
app.command(
    name="line-constants",
    epilog="Example:  tpss line-constants geometry_double_track.toml --out catenary.toml (after tpss "
    "new . --from geometry-double-track)",
)(start_commands.line_constants)
app.command(
    epilog="Examples:  tpss new my-line, then tpss new --from list, then "
    "tpss new thesis --from thesis-160km"
)(start_commands.new)
app.command(epilog="Examples:  tpss studio line.toml, tpss studio my-line --new")(
    start_commands.studio
)
app.command(epilog="Example:  tpss warm")(start_commands.warm)
app.command(epilog="Examples:  tpss library catenaries, tpss library catenaries AT")(
    start_commands.library
)
app.command(epilog="Example:  tpss laws")(start_commands.laws)
app.command(epilog="Example:  tpss schema --out scenario.schema.json")(start_commands.schema)


def main() -> None:
    """Run the command line; faults of the input are printed, never raised."""
    from tpss.cli.streams import say_everything
    from tpss.errors import TpssError
    from tpss.extras import imports_explained
    from tpss.printable import printable

    say_everything()
    # What the command line does not print itself: that compiled kernels cannot be kept.
    if logging.lastResort is not None:
        logging.getLogger("tpss.kernels").addHandler(logging.lastResort)
    # Most objects of a short-lived process are modules: collecting garbage among them, repeatedly
    # while they load and again at the end, takes a quarter of the time of a run.
    gc.disable()
    atexit.register(gc.freeze)
    try:
        with imports_explained():
            app()
    except TpssError as error:
        typer.echo(printable(str(error), "\n"), err=True)
        sys.exit(2)
    except Exception as error:
        if os.environ.get("TPSS_DEBUG"):
            raise
        typer.echo(
            f"Internal error: {type(error).__name__}: {printable(str(error))}\n"
            "This is a fault of TPSS, please report it; TPSS_DEBUG=1 shows where it occurred.",
            err=True,
        )
        sys.exit(1)
