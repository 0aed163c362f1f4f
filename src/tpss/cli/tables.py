"""What ``tpss run`` prints: tables that a traction engineer reads at a glance."""

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd
from rich.markup import escape
from rich.table import Table

from tpss import units
from tpss.cli.columns import Column, named_rows, table_of_columns
from tpss.cli.terminal import Console, print_in_parts, say, widest_text, width_of
from tpss.results.converter_losses import in_words as losses_in_words
from tpss.results.notes import notes
from tpss.results.regeneration import fed_back, in_words
from tpss.results.result import THERMAL, Result
from tpss.results.step_words import step_lines
from tpss.results.stops import punctuality
from tpss.results.storage import in_words as storage_in_words
from tpss.results.tables import train_steps
from tpss.results.thermal.words import thermal_in_words
from tpss.results.waits import waits_in_words
from tpss.step.recorded import RECORDED
from tpss.units import on_line

REACTIVE = "reactive_energy_mvarh"
"""Column of stations of which a line of direct current has none."""

MOST_TRAINS = 30
MOST_VIOLATIONS = 5


def print_result(result: Result, console: Console) -> None:
    """Print the tables of trains and stations, the key figures and the warnings."""
    summary = result.summary
    title = f"\n[bold]{summary['name']}[/bold]  {escape(summary['description'])}"
    console.print(title, highlight=False, soft_wrap=True)
    _print_trains(result, console)
    direct = result.scenario.supply.is_direct
    columns = [each for each in _STATION_COLUMNS if not (direct and each.key == REACTIVE)]
    rows = named_rows(result.stations, "station")
    print_table("Feeding stations", "station", columns, rows, console)
    if len(result.converter_losses):
        _print_losses(result.converter_losses, console)
    if len(result.autotransformers):
        _print_autotransformers(result.autotransformers, console)
    _print_grid(result, console)
    if len(result.storage):
        _print_storage(result.storage, console)
    for line in key_figures(result):
        say(console, line)
    print_violations(result, console)
    for line in notes(result):
        console.print(f"[yellow]Note:[/yellow] {escape(line)}", highlight=False, soft_wrap=True)
    if "problem" in summary:
        status = summary["status"].capitalize()
        console.print(
            f"[bold red]{status}.[/bold red] {escape(summary['problem'])}", highlight=False
        )
        console.print(f"[bold]What would help:[/bold] {escape(summary['advice'])}", highlight=False)
    for failure in summary["audit"]["failures"]:
        console.print(f"[bold red]Audit failed:[/bold red] {failure}", highlight=False)


_TRAIN_COLUMNS = (
    Column("departure_min", "departs", "min", 2),
    Column("arrival_min", "arrives", "min", 2),
    Column("trip_min", "trip", "min", 2),
    Column("distance_km", "distance", "km", 1),
    Column("mean_speed_kmh", "mean\nspeed", "km/h", 1),
    Column("energy_mwh", "energy", "MWh", 3),
    Column("lowest_voltage_kv", "lowest\nvoltage", "kV", 2),
    Column("lowest_voltage_line", "on", "", 0),
    Column("lowest_voltage_km", "at", "km", 1),
)

_STATION_COLUMNS = (
    Column("line", "on", "", 0),
    Column("position_km", "at", "km", 1),
    Column("energy_mwh", "energy", "MWh", 3),
    Column(REACTIVE, "reactive", "Mvarh", 3),
    Column("peak_power_mw", "peak\npower", "MW", 2),
    Column("mean_loading", "mean load", "%", 1, 100.0),
    Column("peak_loading", "peak load", "%", 1, 100.0),
    Column("mean_converters", "converters", "mean", 1),
)

_AUTOTRANSFORMER_COLUMNS = (
    Column("line", "on", "", 0),
    Column("highest_winding_a", "winding", "A", 0),
    Column("highest_neutral_a", "neutral", "A", 0),
    Column("peak_loading", "peak load", "%", 1, 100.0),
    Column("rms_15_min_loading", "15 min", "%", 1, 100.0),
    Column("rms_60_min_loading", "60 min", "%", 1, 100.0),
)

_RARE = ("to_grid_mwh", "burnt_mwh", "auxiliaries_mwh")
"""Columns of the 50 Hz side that are left out where they are 0."""

_LOSS_COLUMNS = (
    Column("from_grid_mwh", "taken", "MWh", 3),
    Column("to_grid_mwh", "given", "MWh", 3),
    Column("burnt_mwh", "burnt", "MWh", 3),
    Column("losses_mwh", "losses", "MWh", 3),
    Column("idle_mwh", "idle", "MWh", 3),
    Column("by_load_mwh", "by load", "MWh", 3),
    Column("auxiliaries_mwh", "auxiliaries", "MWh", 3),
    Column("mean_efficiency", "mean\nefficiency", "%", 1, 100.0),
    Column("starts", "starts", "", 0),
    Column("peak_from_grid_mw", "peak", "MW", 2),
)

_STORAGE_COLUMNS = (
    Column("line", "on", "", 0),
    Column("position_km", "at", "km", 1),
    Column("capacity_kwh", "holds", "kWh", 2),
    Column("start_kwh", "start", "kWh", 2),
    Column("end_kwh", "end", "kWh", 2),
    Column("charged_kwh", "took", "kWh", 2),
    Column("discharged_kwh", "gave", "kWh", 2),
    Column("losses_kwh", "lost", "kWh", 2),
    Column("peak_charge_kw", "peak in", "kW", 0),
    Column("peak_discharge_kw", "peak out", "kW", 0),
    Column("lowest_soc", "lowest", "%", 0, 100.0),
    Column("highest_soc", "highest", "%", 0, 100.0),
)

_TRANSFORMER_COLUMNS = (
    Column("from_grid_mwh", "taken", "MWh", 3),
    Column("to_grid_mwh", "given", "MWh", 3),
    Column("burnt_mwh", "burnt", "MWh", 3),
    Column("load_mwh", "by load", "MWh", 3),
    Column("no_load_mwh", "no load", "MWh", 3),
    Column("grid_mwh", "in grid", "MWh", 3),
)

_BUSBAR_COLUMNS = (
    Column("peak_r_a", "peak R", "A", 1),
    Column("peak_s_a", "peak S", "A", 1),
    Column("peak_t_a", "peak T", "A", 1),
    Column("peak_percent", "peak\nunbalance", "%", 2),
    Column("mean_10_min_percent", "10 min", "%", 2),
    Column("limit_percent", "limit", "%", 2),
)

_NEUTRAL_COLUMNS = (
    Column("phases_before", "before", "", 0),
    Column("phases_behind", "behind", "", 0),
    Column("angle_deg", "angle", "°", 0),
    Column("mean_kv", "mean\nvoltage", "kV", 2),
    Column("highest_kv", "highest\nvoltage", "kV", 2),
)

_STEP_PLACE = [Column("line", "on", "", 0), Column("track", "track", "", 0)]
"""Where a train is beside its kilometre, where that has to be told."""

_STEP_COLUMNS = [
    Column(each.column, each.heading, units.label(each.column), each.digits)
    for each in RECORDED
    if each.heading
]


def _print_trains(result: Result, console: Console) -> None:
    trips = result.trips
    rows = named_rows(trips.head(MOST_TRAINS), "train")
    print_table("Trains", "train", _TRAIN_COLUMNS, rows, console)
    if len(trips) > MOST_TRAINS:
        say(console, f"... and {len(trips) - MOST_TRAINS} more trains, in the saved result")


def _print_losses(found: pd.DataFrame, console: Console) -> None:
    """Print the 50 Hz side of stations, without columns of what does not occur."""
    occurs = [each for each in _LOSS_COLUMNS if each.key not in _RARE or found[each.key].any()]
    title = "50 Hz side of converter stations"
    print_table(title, "station", occurs, named_rows(found, "station"), console)


def _print_storage(found: pd.DataFrame, console: Console) -> None:
    """Print what stores of energy did, of many on board the first ones."""
    rows = named_rows(found.head(MOST_TRAINS), "store")
    print_table("Stores of energy", "store", _STORAGE_COLUMNS, rows, console)
    if len(found) > MOST_TRAINS:
        say(console, f"... and {len(found) - MOST_TRAINS} more stores, in the saved result")


def _print_autotransformers(found: pd.DataFrame, console: Console) -> None:
    places = [f"{km:g} km" for km in found.position_km]
    rows = named_rows(found.assign(place=places), "place")
    print_table("Autotransformers", "at", _AUTOTRANSFORMER_COLUMNS, rows, console)


def _print_grid(result: Result, console: Console) -> None:
    """Print the grid's side of transformer stations, busbars and voltages across neutral sections."""
    lost = result.transformer_losses
    occurs = [
        each for each in _TRANSFORMER_COLUMNS if each.key not in _RARE or lost[each.key].any()
    ]
    neutral = result.standards.neutral_sections
    places = [
        on_line(line, f"{begin:g}-{end:g} km")
        for line, begin, end in zip(
            neutral.get("line", [""] * len(neutral)), neutral.from_km, neutral.to_km, strict=True
        )
    ]
    shown = (
        ("Grid's side of transformer stations", "station", occurs, lost),
        ("Busbars of the grid", "busbar", _BUSBAR_COLUMNS, result.standards.unbalance),
        ("Neutral sections", "place", _NEUTRAL_COLUMNS, neutral.assign(place=places)),
    )
    for title, first, columns, frame in shown:
        if len(frame):
            print_table(title, first, columns, named_rows(frame, first), console)


def print_table(
    title: str,
    first: str,
    columns: Sequence[Column],
    rows: Sequence[tuple[str, Mapping[str, Any]]],
    console: Console,
) -> None:
    """Print a table, in a narrow terminal in parts that have whole numbers."""
    # A line stays beside its kilometre.
    together = [
        [columns[k - 1], column] if k and columns[k - 1].heading == "on" else [column]
        for k, column in enumerate(columns)
        if column.heading != "on"
    ]

    def table_of(groups: Sequence[Sequence[Column]], more: str) -> Table:
        return table_of_columns(
            title + more,
            first,
            [column for each in groups for column in each],
            rows,
            widest_text(console),
        )

    print_in_parts(together, table_of, console)


def key_figures(result: Result) -> list[str]:
    """Lines with trip time, energy, losses, voltages and audit."""
    summary, lines = result.summary, []
    if summary["trip_time_min"] is not None:
        lines.append(f"Trip time of {summary['studied_train']}: {summary['trip_time_min']:.2f} min")
    if any(entry.is_scheduled for entry in result.scenario.traffic):
        lines += punctuality(result.stops)
    lines += waits_in_words(result.waits)
    lines += _lost_time(summary.get("lost_time"))
    total, losses = summary["total_energy_mwh"], summary["losses_mwh"]
    share = f" ({100 * losses / total:.2f} %)" if total > 0 else ""
    duration = summary["duration_min"]
    lines.append(
        f"Energy over {duration:.2f} min: {total:.3f} MWh, of which losses {losses:.3f} MWh{share}"
    )
    if (totals := fed_back(result.dataset, result.scenario)) is not None:
        lines.append(in_words(totals))
    lines += storage_in_words(result.storage)
    if (lost := summary.get("converter_losses")) is not None:
        lines.append(losses_in_words(lost))
    lowest = summary["lowest_voltage"]
    if lowest is not None:
        place = f"{lowest['position_km']:.2f} km"
        lines.append(
            f"Lowest voltage: {lowest['voltage_kv']:.3f} kV, {lowest['train']} at "
            f"{on_line(lowest.get('line', ''), place)}, {lowest['time_min']:.2f} min"
        )
    if result.standards.voltage_in_words:
        lines.append(f"Voltage: {result.standards.voltage_in_words}")
    lines += result.judged_rails.in_words
    if result.standards.unbalance_in_words:
        lines.append(f"Unbalance: {result.standards.unbalance_in_words}")
    lines += thermal_in_words(summary.get(THERMAL))
    lines += step_lines(summary)
    lines.append(_audit(summary["audit"]))
    if laws := summary["provenance"].get("laws"):
        lines.append(f"Not equations of TPSS: {laws}")
    lines.append(f"Simulated in {1e3 * summary['simulation_s']:.0f} ms")
    return lines


def _lost_time(lost: Mapping[str, Any] | None) -> list[str]:
    """What trains lost to the voltage, in a line; none where that is not known, or nothing."""
    if lost is None or lost["total_min"] < LEAST_LOST_MIN:
        return []
    trains = "1 train" if lost["trains"] == 1 else f"{lost['trains']} trains"
    text = f"Lost to the voltage: {lost['total_min']:.2f} min by {trains} that arrived"
    if lost["trains"] > 1:
        text += f", most by {lost['worst_train']}, {lost['worst_min']:.2f} min"
    return [f"{text} (against {lost['voltage_kv']:g} kV everywhere)"]


LEAST_LOST_MIN = 0.005
"""Lost time below this is nothing. [min]"""

_AUDITED = {
    "power mismatch": ("power_mismatch_va", " VA"),
    "converters": ("converter_residual", ""),
    "energy balance": ("network_balance", ""),
    "traction": ("traction_balance", ""),
}
"""Figures of the audit that are printed: their names, and with which unit."""


def _audit(audit: Mapping[str, Any]) -> str:
    """Verdict of the audit, and its most important figures with the limits that held."""
    limits = audit.get("limits")  # of results saved before, they are not known
    texts = []
    for words, (name, unit) in _AUDITED.items():
        text = f"{words} {audit[name]:.1e}{unit}"
        if limits is not None:
            text += f" (limit {limits[name]:.1e})" if name in limits else " (not judged)"
        texts.append(text)
    return f"Audit {'passed' if audit['passed'] else 'FAILED'}: {', '.join(texts)}"


def print_violations(result: Result, console: Console) -> None:
    """Print the worst violations of limits in words, and how many more there are."""
    figures = result.summary["standards"]
    words = figures["worst_violations"][:MOST_VIOLATIONS]
    for line in words:
        text = f"[bold yellow]Limit violated:[/bold yellow] {escape(line)}"
        console.print(text, highlight=False, soft_wrap=True)
    if figures["violations"] > len(words):
        say(console, f"... and {figures['violations'] - len(words)} more; tpss export lists all")


def print_train(result: Result, name: str, console: Console) -> None:
    """Print a train's journey, one row per step, or that it was not on the line."""
    if name not in result.dataset.train.to_numpy():
        say(console, f"Note: {name} was not on the line during this run")
        return
    steps = train_steps(result.dataset.sel(train=[name]))
    rows = named_rows(steps.assign(time=steps.time_min.map("{:.2f}".format)), "time")
    columns = [*_STEP_PLACE, *_STEP_COLUMNS]
    table = table_of_columns(name, "time\n[dim]min[/dim]", columns, rows)
    # A row stays on one line, in a narrow terminal too.
    Console(file=console.file, width=max(console.width, width_of(table))).print(table)
