"""What a report says of a comparison with measurements: sentences, tables, plots."""

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from plotly.graph_objects import Figure

from tpss.measured.compare import MeasuredComparison
from tpss.measured.words import sentences
from tpss.report.drawings.measured import measured_durations, measured_over_time
from tpss.report.render.interactive import render
from tpss.report.tables import Cell, Table, cell

PANEL_PX, AROUND_PX = 210, 110
"""Height of a panel of a plot, and of what is around the panels. [px]"""

FIGURES = {
    "unit": "unit",
    "compared_min": "compared [min]",
    "measured_mean": "measured mean",
    "simulated_mean": "simulated mean",
    "bias": "bias",
    "bias_low": "bias, 95 % from",
    "bias_high": "bias, 95 % to",
    "bias_percent": "bias [%]",
    "rms_error": "RMS error",
    "error_5": "error, 5 %",
    "error_95": "error, 95 %",
    "measured_energy": "measured energy",
    "simulated_energy": "simulated energy",
    "energy_unit": "of energy",
}
"""Headings of the figures that are shown."""

WINDOWS = {
    "unit": "unit",
    "window_min": "window [min]",
    "which": "mean",
    "measured": "measured",
    "measured_from_min": "measured from [min]",
    "simulated": "simulated",
    "simulated_from_min": "simulated from [min]",
}

UNITS = {"compared_min": "min", "bias_percent": "%", "window_min": "", "measured_from_min": "min",
         "simulated_from_min": "min"}  # fmt: skip
"""Units of the columns that do not have that of their series."""

FINE = "MW"
"""A unit with the decimals of powers, voltages and energies."""


class MeasuredPart(NamedTuple):
    """Part of a page about measurements."""

    sentences: Sequence[str]
    notes: Sequence[str]
    tables: Sequence[Table]


def measured_part(comparison: MeasuredComparison) -> tuple[MeasuredPart, dict[str, Figure]]:
    """Part of a page, and its plots by the names of their elements."""
    height = AROUND_PX + PANEL_PX * len(comparison.series)
    figures = {
        "measured": render(measured_over_time(comparison), height),
        "measured-durations": render(measured_durations(comparison), height),
    }
    shown = [
        _table("measured-figures", "Means, errors and energies", comparison.figures, FIGURES),
        _table("measured-windows", "Worst means over windows", comparison.windows, WINDOWS),
    ]
    return MeasuredPart(sentences(comparison), comparison.notes, shown), figures


def _table(key: str, caption: str, frame: Any, headings: dict[str, str]) -> Table:
    rows = [[cell(row["series"], ""), *_cells(row, headings)] for row in frame.to_dict("records")]
    return Table(key, caption, ["series", *headings.values()], rows)


def _cells(row: dict[str, Any], columns: Iterable[str]) -> list[Cell]:
    return [cell(row[name], UNITS.get(name, FINE)) for name in columns]
