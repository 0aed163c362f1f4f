"""Arguments and options that several commands take."""

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from tpss.cli import complete

option = partial(typer.Option, show_default=False)
argument = partial(typer.Argument, show_default=False)

Force = Annotated[bool, typer.Option("--force", help="Replace existing files.")]

ScenarioFile = Annotated[
    Path, argument(help="Scenario file (TOML).", autocompletion=complete.scenario_files)
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

ResultFolder = Annotated[Path, argument(metavar="RESULT", help="Folder written by tpss run.")]

NoStepCheck = Annotated[
    bool,
    typer.Option("--no-step-check", help="Leave out what moves at half the time step."),
]

Quiet = Annotated[bool, typer.Option("--quiet", help="Print only errors.")]
