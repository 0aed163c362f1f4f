"""A table and a picture of it, which a command writes if it is asked to."""

from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from tpss.cli.plot import demand_format, figure_bytes
from tpss.cli.terminal import tell
from tpss.extras import demand
from tpss.files import whole
from tpss.files.refusals import explained, refuse_to_replace

if TYPE_CHECKING:
    from tpss.report.drawings.parts import Drawing


def demand_room(out: Path | None, plot: Path | None, force: bool) -> None:
    """Refuse to replace what is there, and pictures that cannot be drawn, before anything runs.

    Raises
    ------
    ResultError
    """
    for target in (out, plot):
        if target is not None:
            refuse_to_replace(target, force, "a file", Path.is_file)
    if plot is not None:
        demand_format(plot)
        demand("figures")


def write_table(file: Path, table: pd.DataFrame) -> None:
    """Write a table as CSV, and say where."""
    from tpss.results.csv_texts import csv_of

    _write(file, csv_of(table))


def write_picture(file: Path, drawing: "Drawing") -> None:
    """Write a drawing as a file of the kind that its name ends with, and say where."""
    from tpss.report.render.static import render

    _write(file, figure_bytes(render(drawing), file.suffix.removeprefix(".")))


def _write(file: Path, content: bytes) -> None:
    with explained(file):
        file.parent.mkdir(parents=True, exist_ok=True)
        whole.write_file(file, content)
    tell(f"Wrote {file}")
