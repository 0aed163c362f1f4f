"""Arguments and options of ``tpss approximate``."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from tpss.cli.arguments import Force, Library, Quiet, argument, flag, option
from tpss.cli.commands import Commands

app = typer.Typer(
    cls=Commands,
    help="TPSA, the approximator: learn from the simulations of a study, and predict further ones.",
    no_args_is_help=True,
    rich_markup_mode="markdown",
)


class FormName(StrEnum):
    """Which inputs and outputs an approximator has."""

    AGGREGATED = "aggregated"
    VARIED = "varied"
    PROFILE = "profile"
    ORIGINAL = "original"


ModelFile = Annotated[
    Path, argument(metavar="MODEL", help="File written by tpss approximate train.")
]


@app.command(
    epilog="Example:  tpss approximate train converters --out converters.json, after "
    "tpss sweep study_converters.toml --out converters"
)
def train(
    folder: Annotated[
        Path, argument(metavar="DIR", help="Folder of a study, written by tpss sweep.")
    ],
    out: Annotated[Path, typer.Option(help="File to write (JSON).")] = Path("model.json"),
    form: Annotated[
        FormName | None,
        typer.Option(
            metavar="FORM",
            help="aggregated; varied: inputs are what the study varies, by its key paths; profile: "
            "aggregated, also with the location of the steep sections, beyond mean and standard "
            "deviation of the gradients; or original: the highest mean speed of a train added to a "
            "line, from the number and the speed of the trains that run there. By default aggregated "
            "if that describes all that varies, else varied.",
        ),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the random numbers.")] = 0,
    force: Force = False,
    quiet: Quiet = False,
) -> None:
    """Train an approximator on the table of a study.

    Four fifths of the cases are used for training, the others to score it; the file holds the scores.

    Exit codes: 0 done, 2 bad input, or the file cannot be written, 130 interrupted (nothing is
    written).
    """
    from tpss.cli.approximate import train_model

    name = None if form is None else form.value
    raise typer.Exit(train_model(folder, out, name, seed, force, quiet))


@app.command(
    epilog="Examples:  tpss approximate predict model.json --set length_km=120 --set headway_min=8, "
    "and so on for its other inputs; tpss approximate predict model.json --table lines.csv --out "
    "figures.csv"
)
def predict(
    model: ModelFile,
    set_: Annotated[
        list[str] | None,
        option(
            "--set",
            metavar="INPUT=VALUE",
            help="An input; tpss approximate check MODEL lists them; repeatable.",
        ),
    ] = None,
    table: Annotated[
        Path | None,
        option(
            help="Lines to predict, one row per line and one column per input (.csv or .parquet)."
        ),
    ] = None,
    scenario: Annotated[
        Path | None,
        option(help="Scenario file (TOML) to compute the inputs from; --set changes them."),
    ] = None,
    flag: Annotated[
        bool,
        flag(
            "--flag",
            help="Predict outside the trained region too, with a warning, instead of an error.",
        ),
    ] = False,
    out: Annotated[
        Path | None, option(help="Write inputs and figures into this file (.csv or .parquet).")
    ] = None,
    _library: Library = None,
    force: Force = False,
) -> None:
    """Predict figures of lines that were not simulated, each with an interval.

    In nine of ten cases like those of the study, a figure lies in its interval.

    Exit codes: 0 done, 2 bad input, an input outside the trained region, or the file cannot be
    written.
    """
    from tpss.cli.approximate import predict_lines

    if (table is not None) and (set_ or scenario is not None):
        raise typer.BadParameter("give either --table, or one line by --scenario and --set")
    if table is None and scenario is None and not set_:
        raise typer.BadParameter("give --set for each input, --scenario, or --table")
    raise typer.Exit(predict_lines(model, set_ or [], table, scenario, flag, out, force))


@app.command(
    epilog="Examples:  tpss approximate check model.json, then tpss approximate check model.json "
    "another-study"
)
def check(
    model: ModelFile,
    folder: Annotated[
        Path | None, argument(metavar="DIR", help="Folder of a study to predict and compare.")
    ] = None,
) -> None:
    """Print what an approximator was trained on, its inputs and outputs, and how accurate it is.

    With the folder of a study, its cases inside the trained region are predicted and compared; from
    the study that it was trained on, only the cases that were held out.

    Exit codes: 0 done, 2 bad input.
    """
    from tpss.cli.approximate import check_model

    raise typer.Exit(check_model(model, folder))
