"""The command ``tpss plot``."""

import io
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from tpss.cli.labels import demand_fitting, labels
from tpss.cli.terminal import tell
from tpss.errors import ResultError
from tpss.extras import demand
from tpss.results.contents import FIGURE_NAMES, FIGURES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ALL = "all"
JOURNEY = "journey"
FORMATS = ("png", "svg", "pdf")

DOTS_PER_INCH = 200
"""Resolution of png files."""


def plot_results(
    folders: Sequence[Path],
    figure: str,
    train: str | None,
    against: Literal["time", "distance"],
    corridor: Sequence[str],
    minutes: tuple[float | None, float | None],
    out: Path | None,
    force: bool,
    given: Sequence[str] = (),
) -> None:
    """Write a figure of a result or several, or all of one result, and print where they are.

    Raises
    ------
    ResultError
        The folder holds no result, there is no such figure, train or corridor, or nothing to draw, or
        the file cannot be written.
    """
    demand("figures")
    from tpss.files.several import check_files, save_files
    from tpss.report.figures import catalogue
    from tpss.report.trains import NothingToDrawError
    from tpss.results.result import load_result

    if figure != ALL:
        catalogue.demand_figure(figure)
        if minutes != (None, None) and figure != catalogue.TIME_DISTANCE:
            raise ResultError(f"{figure} is not {catalogue.TIME_DISTANCE}; leave its minutes out")
        _demand_use(figure, train, against, catalogue.OF_A_TRAIN)
        if corridor and figure not in catalogue.ALONG_A_CORRIDOR:
            remedy = f"draw {', '.join(catalogue.ALONG_A_CORRIDOR)}"
            raise ResultError(
                f"{figure} shows the whole run; leave --corridor, --from and --to out, or {remedy}"
            )
    _demand_one_file(folders, figure, out)
    demand_fitting(given, folders)
    place, names = _target(folders[0], figure, out)
    results = [load_result(folder) for folder in folders]
    runs = dict(zip(given or labels(folders, results), results, strict=True))
    if figure == ALL:
        names = {name: file for name, file in names.items() if catalogue.applies(name, results[0])}
    check_files(place, names.values(), force)
    contents: dict[str, bytes] = {}
    left_out: list[tuple[str, str]] = []
    for name, file in names.items():
        try:
            drawn = catalogue.overlay(name, runs, train, against, corridor, minutes)
        except NothingToDrawError as error:
            left_out.append((name, str(error)))
            continue
        contents[file] = figure_bytes(drawn, Path(file).suffix.removeprefix("."))
    if not contents:
        reasons = ", ".join(dict.fromkeys(reason for _, reason in left_out))
        which = ", ".join(
            f"{folder} ({run.status})" for folder, run in zip(folders, results, strict=True)
        )
        raise ResultError(f"{which} holds nothing to draw: {reasons}")
    files = save_files(place, contents, force)
    listed = f"Wrote into {place}: {', '.join(file.name for file in files)}"
    tell(listed if figure == ALL else f"Wrote {files[0]}")
    for name, reason in left_out:
        print(f"Left out {name}: {reason}")


def _demand_one_file(folders: Sequence[Path], figure: str, out: Path | None) -> None:
    """Refuse several results without one figure, or without a place for it."""
    if len(folders) == 1:
        return
    if figure == ALL:
        raise ResultError("of several results one figure is drawn; name it by --figure")
    if out is None:
        raise ResultError("a figure of several results belongs to none of them; give its --out")


def _demand_use(figure: str, train: str | None, against: str, of_a_train: Sequence[str]) -> None:
    """Refuse options that the figure would not use."""
    if train is not None and figure not in of_a_train:
        raise ResultError(
            f"{figure} does not show a single train; leave --train out, or draw {', '.join(of_a_train)}"
        )
    if against == "time" and figure != JOURNEY:
        raise ResultError(f"{figure} is not a {JOURNEY}; leave --against out")


def demand_format(file: Path) -> None:
    """Raise a `ResultError` if figures cannot be written as files of that name."""
    if file.suffix.removeprefix(".").lower() not in FORMATS:
        raise ResultError(
            f"{file} has an unknown format; use a name that ends in .{', .'.join(FORMATS)}"
        )


def _target(folder: Path, figure: str, out: Path | None) -> tuple[Path, dict[str, str]]:
    """Folder to write into, and files in it by the names of their figures."""
    if figure == ALL:
        if out is not None and out.suffix.removeprefix(".").lower() in FORMATS:
            raise ResultError(
                f"{out} is one file, and all figures need a folder; give another --out"
            )
        return out or folder / FIGURES, {name: f"{name}.png" for name in FIGURE_NAMES}
    file = out or folder / FIGURES / f"{figure}.png"
    demand_format(file)
    if not file.parent.is_dir() and out is not None:
        raise ResultError(f"{file} cannot be written: there is no folder {file.parent}")
    return file.parent, {figure: file.name}


def figure_bytes(figure: "Figure", suffix: str) -> bytes:
    """A figure as a file of some format."""
    file = io.BytesIO()
    # Without its date the same result gives the same file.
    undated = {"png": {}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}[suffix.lower()]
    figure.savefig(file, format=suffix.lower(), dpi=DOTS_PER_INCH, metadata=undated)
    return file.getvalue()
