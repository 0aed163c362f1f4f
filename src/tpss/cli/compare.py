"""The command ``tpss compare``: a result beside measured series."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from rich import box
from rich.markup import escape
from rich.table import Table

from tpss.cli.plot import figure_bytes
from tpss.cli.terminal import Console, print_in_parts, say, tell, widest_text
from tpss.errors import ResultError
from tpss.extras import demand
from tpss.files.several import check_files, save_files
from tpss.results.contents import REPORT, SUMMARY

if TYPE_CHECKING:
    from tpss.measured.compare import MeasuredComparison


class Heading(NamedTuple):
    """A column: its key, its heading, what stands below, and decimals of numbers."""

    key: str
    words: str
    below: str = ""
    digits: int = 3


FIGURES = (
    (
        Heading("unit", "unit"),
        Heading("measured_mean", "measured", "mean"),
        Heading("simulated_mean", "simulated", "mean"),
    ),
    (
        Heading("bias", "bias"),
        Heading("bias_low", "95 %", "from"),
        Heading("bias_high", "95 %", "to"),
        Heading("bias_percent", "bias", "%", 2),
    ),
    (
        Heading("rms_error", "RMS", "error"),
        Heading("error_5", "error", "5 %"),
        Heading("error_95", "error", "95 %"),
    ),
    (
        Heading("measured_energy", "measured", "energy"),
        Heading("simulated_energy", "simulated", "energy"),
        Heading("energy_unit", "unit"),
    ),
)
"""Columns of the figures; those of a group stand beside each other in a narrow terminal too."""


def compare_result(
    folder: Path,
    file: Path,
    columns: Path | None,
    begins: str | None,
    find_offset_min: float | None,
    stamps: Literal["begin", "end"],
    step_min: float | None,
    out: Path | None,
    report: bool,
    force: bool,
) -> None:
    """Compare a result with measured series; print, and write what is asked for.

    Raises
    ------
    ResultError
        The folder holds no result, its audit failed, or files cannot be written.
    ScenarioError
        The measured series have faults, or share no time with the run.
    """
    demand(*(["figures"] if out is not None else []), *(["report"] if report else []))
    from tpss.measured.compare import compare_with_measurements
    from tpss.results.result import load_result

    if (file / SUMMARY).is_file():
        raise ResultError(
            f"{file} is a result; tpss report {folder} {file} compares results with each other"
        )
    result = load_result(folder)
    compared = compare_with_measurements(
        result,
        file,
        columns=columns,
        begins=begins,
        find_offset_min=find_offset_min,
        stamps=stamps,
        step_min=step_min,
    )
    console = Console()
    if out is None:
        print_comparison(compared, console)
        if report:
            from tpss.report.html import write_report

            tell(f"Wrote {write_report(result, folder / REPORT, force=force, measured=compared)}")
        return
    files = _save(compared, out, report, force)
    print_comparison(compared, console)
    tell(f"Wrote into {out}: {', '.join(each.name for each in files)}")


def _save(compared: "MeasuredComparison", out: Path, report: bool, force: bool) -> list[Path]:
    """Write tables, figures and a report that is asked for into a folder, all of them or none."""
    from tpss.measured.save import contents
    from tpss.report.figures import measured_durations, measured_over_time

    drawn = {
        f"{_file_name(k, each.name)}-{kind}.png": (draw, each.name)
        for k, each in enumerate(compared.series, 1)
        for kind, draw in {
            "over-time": measured_over_time, "duration": measured_durations,
        }.items()
    }  # fmt: skip
    files = contents(compared)
    check_files(out, [*files, *drawn, *([REPORT] if report else [])], force)
    for name, (draw, series) in drawn.items():
        figure = draw(compared, series)
        figure.suptitle(f"{compared.result.scenario.name}: {series}", fontsize="large")
        files[name] = figure_bytes(figure, "png")
    if report:
        from tpss.report.html import report as page_of

        files[REPORT] = page_of(compared.result, measured=compared).encode()
    return save_files(out, files, force)


def _file_name(number: int, series: str) -> str:
    """Name of a file for a series, which may hold any character; its number keeps names apart."""
    return f"{number}-{re.sub(r'[^A-Za-z0-9_.]+', '-', series).strip('-')}"


def print_comparison(compared: "MeasuredComparison", console: Console) -> None:
    """Print how the two were compared, tables of figures and windows, and notes."""
    from tpss.measured.words import sentences

    say(console, "")
    for sentence in sentences(compared):
        say(console, sentence)
    _print_table("Error: simulated less measured", FIGURES, compared.figures, console)
    _print_windows(compared.windows, console)
    for note in compared.notes:
        console.print(f"[yellow]Note:[/yellow] {escape(note)}", highlight=False, soft_wrap=True)


def _print_windows(windows: Any, console: Console) -> None:
    """Print the worst means, a row for each series and two columns for each window."""
    if windows.empty:
        return
    rows = windows.pivot(
        index=["series", "unit", "which"], columns="window_min", values=["measured", "simulated"]
    )
    widths: list[float] = sorted(windows.window_min.unique())
    groups = [
        [
            Heading(f"{whose} {width:g}", f"{width:g} min", whose)
            for whose in ("measured", "simulated")
        ]
        for width in widths
    ]
    rows.columns = [f"{whose} {width:g}" for whose, width in rows.columns]
    of_series = rows.loc[windows.series.unique()].reset_index()
    first = [Heading("unit", "unit"), Heading("which", "mean"), *groups[0]]
    _print_table("Worst means over windows", [first, *groups[1:]], of_series, console)


def _print_table(
    title: str, groups: Sequence[Sequence[Heading]], frame: Any, console: Console
) -> None:
    rows: list[Mapping[str, Any]] = frame.to_dict("records")

    def table_of(shown: Sequence[Sequence[Heading]], more: str) -> Table:
        columns = [column for group in shown for column in group]
        table = Table(title=title + more, box=box.SIMPLE_HEAD, title_justify="left", padding=0)
        table.add_column("series", overflow="fold", max_width=widest_text(console))
        for column in columns:
            heading = f"{column.words}\n[dim]{column.below}[/dim]"
            table.add_column(heading, justify="right", no_wrap=True)
        for row in rows:
            cells = [_cell(row[column.key], column.digits) for column in columns]
            table.add_row(escape(row["series"]), *cells)
        return table

    print_in_parts(groups, table_of, console)


def _cell(value: Any, digits: int) -> str:
    if isinstance(value, str):
        return escape(value)
    return "-" if value != value else f"{value:.{digits}f}"
