"""Arguments and options that several commands take."""

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from tpss.cli import complete
from tpss.cli.commands import NO_VALUE
from tpss.errors import ResultError

option = partial(typer.Option, show_default=False)
argument = partial(typer.Argument, show_default=False)
flag = partial(typer.Option, show_default=False, metavar=NO_VALUE)
"""An option that takes no value."""

LIBRARY_VARIABLE = "TPSS_LIBRARY"

Force = Annotated[bool, flag("--force", help="Replace existing files.")]

ScenarioFile = Annotated[
    Path,
    argument(metavar="FILE", help="Scenario file (TOML).", autocompletion=complete.scenario_files),
]

GeometryFile = Annotated[
    Path,
    argument(
        metavar="FILE",
        help="File with the conductors (TOML).",
        autocompletion=complete.scenario_files,
    ),
]

Assignments = Annotated[
    list[str] | None,
    option(
        "--set",
        metavar="KEY=VALUE",
        help="Set one value of the scenario, such as traffic.0.headway_min=12; list items also by their "
        "names (traffic.up.headway_min=12), * is all of them, + one more; without a value the key is "
        "taken out; repeatable.",
    ),
]


@contextmanager
def _named_in_the_environment(folder: Path) -> Iterator[None]:
    """Name a library to this process and to those that it starts."""
    before = os.environ.get(LIBRARY_VARIABLE)
    os.environ[LIBRARY_VARIABLE] = str(folder.absolute())
    try:
        yield
    finally:
        if before is None:
            del os.environ[LIBRARY_VARIABLE]
        else:
            os.environ[LIBRARY_VARIABLE] = before


def _use_library(context: typer.Context, folder: Path | None) -> Path | None:
    if folder is not None:
        context.with_resource(_named_in_the_environment(folder))
    return folder


JIT_VARIABLE = "NUMBA_DISABLE_JIT"


def _use_plain_python(context: typer.Context, value: bool) -> bool:
    """Let numba compile nothing, which it has to know when it is imported.

    Where that is done already, as in a program that calls the command line, the command is called again
    in a process of its own.
    """
    if not value or context.resilient_parsing:
        return value
    if "numba" in sys.modules and not os.environ.get(JIT_VARIABLE):
        environment = {**os.environ, JIT_VARIABLE: "1"}
        call = [sys.executable, "-m", "tpss", *sys.argv[1:]]
        raise typer.Exit(subprocess.call(call, env=environment))
    os.environ[JIT_VARIABLE] = "1"
    return value


Plain = Annotated[
    bool,
    flag(
        "--plain",
        callback=_use_plain_python,
        is_eager=True,
        help="Run the equations as plain Python, without compiling them: an edited one takes effect at "
        "once, and a debugger stops in it. Short runs only: a step takes some hundred times as long.",
    ),
]

Library = Annotated[
    Path | None,
    option(
        "--library",
        metavar="FOLDER",
        callback=_use_library,
        help="Folder with a library of your own, whose entries scenarios may name too; by default that "
        f"of {LIBRARY_VARIABLE}, or else tpss/library in the user's folder for data.",
    ),
]
"""Does its work before the command, which need not look at it."""

ResultFolder = Annotated[
    Path, argument(metavar="RESULT", help="Folder written by tpss run, or by tpss sweep.")
]

OneResult = Annotated[Path, argument(metavar="RESULT", help="Folder written by tpss run.")]

NoStepCheck = Annotated[
    bool,
    flag("--no-step-check", help="Leave out what moves at half the time step."),
]

Quiet = Annotated[bool, flag("--quiet", help="Print only errors.")]

Labels = Annotated[
    list[str] | None,
    option(
        metavar="TEXT",
        help="What a compared result is called, in their order; once for each. By default they have "
        "the names of their scenarios or folders.",
    ),
]

Corridor = Annotated[
    str | None,
    option(
        metavar="STATIONS",
        help="Stations of a network over which lines are drawn as one, such as West,Fork,Mine; by "
        "default those of the first service's way.",
    ),
]

From = Annotated[
    str | None,
    option(
        "--from",
        metavar="STATION",
        help="With --to: draw what lies between two stations, of a network on the shortest way.",
    ),
]

To = Annotated[str | None, option("--to", metavar="STATION", help="See --from.")]


def stations_of(corridor: str | None, origin: str | None, destination: str | None) -> list[str]:
    """Stations over which figures along a line are drawn, as they were asked for.

    Raises
    ------
    ResultError
        Both a corridor and its ends are given, or one end only, or one station only.
    """
    if corridor is not None and (origin or destination):
        raise ResultError("--corridor says all that --from and --to do; leave one of them out")
    if (origin is None) != (destination is None):
        raise ResultError("--from and --to belong together; give both, or neither")
    named = [origin, destination] if corridor is None else corridor.split(",")
    stations = [name.strip() for name in named if name]
    if len(stations) == 1:
        raise ResultError(f"{stations[0]} is one station; give those at both ends at least")
    return stations
