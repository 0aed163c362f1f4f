"""The scenario and its variants: which are run, and their figures side by side."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.table import Table

from tpss.cli.terminal import Console, print_in_parts, widest_text
from tpss.scenario import Scenario
from tpss.scenario.variants import ALL
from tpss.units import on_line

if TYPE_CHECKING:
    from tpss.results.result import Result

BASE = "base"
"""Names the scenario as it is, among its variants."""

COLUMNS = (
    "trip min", "energy MWh", "losses MWh", "lowest\nvoltage kV", "at km", "peak load %",
    "converters lose MWh", "from grid MWh", "to grid MWh", "braked MWh", "fed back MWh", "unbalance %",
)  # fmt: skip
"""Those of which no run has a figure are left out."""

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
    figures: list[float | str | None]


def print_side_by_side(rows: dict[str, Row], console: Console) -> None:
    """Print the key figures of several results, and what differs from the first one."""
    first = next(iter(rows.values())).figures
    compared = [*first[:PLACE], None, *first[PLACE + 1 :]]
    shown = [
        k for k in range(len(COLUMNS)) if any(row.figures[k] is not None for row in rows.values())
    ]

    def table_of(numbers: Sequence[int], more: str) -> Table:
        table = Table(title=f"Variants{more}", title_justify="left", box=None, pad_edge=False)
        table.add_column("variant", overflow="fold", max_width=widest_text(console))
        table.add_column("ended", no_wrap=True)
        for k in numbers:
            table.add_column(COLUMNS[k], justify="right")
        for name, row in rows.items():
            cells = [_cell(row.figures[k], compared[k]) for k in numbers]
            table.add_row(name, row.ended, *cells)
        return table

    print_in_parts(shown, table_of, console)


def row_of(result: "Result") -> Row:
    """Figures of a result in the order of the columns; None of what it does not have."""
    from tpss.results.regeneration import fed_back

    summary, lowest = result.summary, result.summary["lowest_voltage"] or {}
    loading = result.stations.peak_loading.max()
    grid = summary.get("converter_losses") or {}
    braking = fed_back(result.dataset, result.scenario) or {}
    figures = [
        summary["trip_time_min"],
        summary["total_energy_mwh"],
        summary["losses_mwh"],
        lowest.get("voltage_kv"),
        _place(lowest),
        None if loading != loading else 100.0 * float(loading),
        *(grid.get(key) for key in ("losses_mwh", "from_grid_mwh", "to_grid_mwh")),
        *(braking.get(key) for key in ("braked_mwh", "fed_back_mwh")),
        max((each.mean_10_min_percent for each in result.standards.busbars), default=None),
    ]
    return Row(result.status, figures)


def _place(lowest: Mapping[str, Any]) -> float | str | None:
    """Kilometre of the lowest voltage, with its line where there are several."""
    if "line" not in lowest:
        return lowest.get("position_km")
    return on_line(str(lowest["line"]), f"{lowest['position_km']:.2f}")


def _cell(value: float | str | None, base: float | str | None) -> str:
    """A figure, with its difference to the first one where there is one."""
    if value is None:
        return "-"
    if isinstance(value, str) or isinstance(base, str):
        return str(value)
    text = f"{value:.2f}"
    if base is None or f"{value - base:+.2f}" in ("+0.00", "-0.00"):
        return text
    return f"{text} ({value - base:+.2f})"
