"""Arguments and options that several commands take."""

from pathlib import Path
from typing import Annotated

import typer

from tpss.cli import complete

ScenarioFile = Annotated[
    Path,
    typer.Argument(
        help="Scenario file (TOML).", show_default=False, autocompletion=complete.scenario_files
    ),
]

Assignments = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Set one value of the scenario, such as traffic.0.headway_min=12; repeatable.",
        show_default=False,
    ),
]

ResultFolder = Annotated[
    Path,
    typer.Argument(metavar="RESULT", help="Folder written by tpss run.", show_default=False),
]

Quiet = Annotated[bool, typer.Option("--quiet", help="Print only errors.")]
