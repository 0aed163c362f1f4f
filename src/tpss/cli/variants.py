"""The scenario and its variants: which are run, and their figures side by side."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table

from tpss.scenario import Scenario
from tpss.scenario.variants import ALL

if TYPE_CHECKING:
    from tpss.results.result import Result

BASE = "base"
"""Names the scenario as it is, among its variants."""

PLACE = 4
"""Column of a place, whose differences mean nothing."""


def chosen(scenario: Scenario, names: Sequence[str]) -> dict[str, Scenario]:
    """Scenarios to run by their names: the scenario itself, or the variants of these names.

    Raises
    ------
    ScenarioError
        There is no such variant, or one has faults.
    """
    if not names:
        return {BASE: scenario}
    if ALL in names:
        return {BASE: scenario, **{name: scenario.variant(name) for name in scenario.variants}}
    return {name: scenario.variant(name) for name in dict.fromkeys(names)}


def folders(out: Path | None, scenarios: dict[str, Scenario]) -> dict[str, Path | None]:
    """Folder of each result: that asked for, or one in it for each of several."""
    if out is None or len(scenarios) == 1:
        return dict.fromkeys(scenarios, out)
    return {name: out / name for name in scenarios}


@dataclass(frozen=True)
class Row:
    """How a run ended, and its key figures: what is kept of it for the comparison."""

    ended: str
    figures: list[float | None]


def print_side_by_side(rows: dict[str, Row], console: Console) -> None:
    """Print the key figures of several results, and what differs from the first one."""
    table = Table(title="Variants", title_justify="left", box=None, pad_edge=False)
    table.add_column("variant", no_wrap=True)
    table.add_column("ended", no_wrap=True)
    for column in ("trip min", "energy MWh", "losses MWh", "low U kV", "at km", "peak load %"):
        table.add_column(column, justify="right")
    first = next(iter(rows.values())).figures
    compared = [*first[:PLACE], None, *first[PLACE + 1 :]]
    for name, row in rows.items():
        cells = [_cell(value, base) for value, base in zip(row.figures, compared, strict=True)]
        table.add_row(name, row.ended, *cells)
    console.print(table)


def row_of(result: "Result") -> Row:
    """Trip time, energy, losses, lowest voltage and its place, highest loading of a station."""
    summary, lowest = result.summary, result.summary["lowest_voltage"] or {}
    loading = result.stations.peak_loading.max()
    figures = [
        summary["trip_time_min"],
        summary["total_energy_mwh"],
        summary["losses_mwh"],
        lowest.get("voltage_kv"),
        lowest.get("position_km"),
        None if loading != loading else 100.0 * float(loading),
    ]
    return Row(result.status, figures)


def _cell(value: float | None, base: float | None) -> str:
    """A figure, with its difference to the first one where there is one."""
    if value is None:
        return "-"
    text = f"{value:.2f}"
    if base is None or f"{value - base:+.2f}" in ("+0.00", "-0.00"):
        return text
    return f"{text} ({value - base:+.2f})"
