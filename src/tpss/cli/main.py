"""Entry point of the command line.

Exit codes: 0 done, 2 bad input, 3 no solution or a stalled train (results up to then are saved),
4 the audit failed, 130 interrupted (results are saved).
"""

import atexit
import gc
import os
import sys
from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer(
    name="tpss",
    help="TPSS, the Train Power System Simulator: trains and their power supply, simulated together.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
)


def _print_version(value: bool) -> None:
    if value:
        from importlib.metadata import version

        typer.echo(f"tpss {version('tpss')}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_print_version, is_eager=True, help="Show the version."),
    ] = False,
) -> None:
    pass


@app.command(
    epilog="Example:  tpss run examples/thesis_160km.toml --set simulation.time_step_min=0.1"
)
def run(
    file: Annotated[Path, typer.Argument(help="Scenario file (TOML).", show_default=False)],
    out: Annotated[
        Path | None,
        typer.Option(
            help="Folder for the result; by default results/<name>-NNN.", show_default=False
        ),
    ] = None,
    set_: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="KEY=VALUE",
            help="Set one value of the scenario, such as traffic.0.headway_min=12; repeatable.",
            show_default=False,
        ),
    ] = None,
    force: Annotated[
        bool, typer.Option("--force", help="Replace an existing result folder.")
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Print nothing but faults.")] = False,
    show: Annotated[
        str | None,
        typer.Option(
            metavar="TRAIN",
            help="Print a train's motion, voltage, forces and current at every step, such as "
            "--show 'eastbound 1'.",
            show_default=False,
        ),
    ] = None,
) -> None:
    """Simulate a scenario, print what matters, and save the result.

    Exit codes: 0 done, 2 bad input, 3 the line cannot carry its load or a train stalls (results up
    to then are saved), 4 the audit failed, 130 interrupted (results are saved).
    """
    from tpss.cli.run import run_scenario

    try:
        code = run_scenario(file, out, set_ or [], force, quiet, show)
    except KeyboardInterrupt:
        typer.echo("Interrupted before there was a result; nothing was written.", err=True)
        code = 130
    raise typer.Exit(code)


def main() -> None:
    """Run the command line; faults of the input are printed, never raised."""
    from tpss.errors import TpssError

    # Most objects of a short-lived process are modules: to collect garbage among them, again and
    # again while they load and once more at the end, takes a quarter of the time of a run.
    gc.disable()
    atexit.register(gc.freeze)
    try:
        app()
    except TpssError as error:
        typer.echo(str(error), err=True)
        sys.exit(2)
    except Exception as error:
        if os.environ.get("TPSS_DEBUG"):
            raise
        typer.echo(
            f"Internal error: {type(error).__name__}: {error}\n"
            "This is a fault of TPSS, please report it; TPSS_DEBUG=1 shows where it arose.",
            err=True,
        )
        sys.exit(1)
