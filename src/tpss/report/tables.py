"""Tables of a report: headings with units, cells with text to show and value to download."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from tpss import units
from tpss.results.places import LINE
from tpss.results.regeneration import fed_back
from tpss.results.result import Result
from tpss.results.storage import totals
from tpss.scenario.differences import differences
from tpss.units import on_line

MOST_ROWS = 1_000
"""Rows of a table; the saved result has them all."""

DIGITS = {"MWh": 3, "Mvarh": 3, "km/h": 1, "km": 2, "min": 2, "kV": 3, "MW": 3}
"""Decimals that are shown, by unit; others have two."""


MOST_DIFFERENCES = 60
"""Rows of a table of what differs; a profile of gradients may have thousands."""

OF_VOLTAGE = ("EN 50163", "EN 50388")
"""Standards that limit the voltage at trains."""

MOST_LISTED = 4
"""Items of a list that are shown."""

PLACES_AND_TIMES = ("place of", "time of")
"""Figures whose differences say nothing begin with one of these."""


@dataclass(frozen=True)
class Cell:
    """Text of a cell, and its value to seven digits for sorting and download."""

    text: str
    value: str
    is_number: bool


@dataclass(frozen=True)
class Table:
    """A table that a page shows.

    Attributes
    ----------
    key : str
        Its name in the page, and that of the file to download.
    caption : str
    headings : sequence of str
    rows : sequence of sequence of Cell
    """

    key: str
    caption: str
    headings: Sequence[str]
    rows: Sequence[Sequence[Cell]]


def of_frame(key: str, caption: str, frame: pd.DataFrame) -> Table:
    """Table of a pandas table whose names end with their units; of a long one, the first rows."""
    columns = [str(name) for name in frame.columns]
    rows = [
        [cell(value, units.label(name)) for name, value in zip(columns, row, strict=True)]
        for row in frame.head(MOST_ROWS).itertuples(index=False)
    ]
    if len(frame) > MOST_ROWS:
        caption += f" (the first {MOST_ROWS} of {len(frame)}; the saved result has all)"
    return Table(key, caption, [units.heading(name) for name in columns], rows)


def of_standards(result: Result) -> list[Table]:
    """Key figures by the definitions of the standards."""
    evidence = result.standards
    shown = {
        "violations": ("Violations of limits", evidence.violations),
        "voltage": ("EN 50163: voltage at the pantograph", evidence.voltage),
        "low-voltage-places": (
            "EN 50163: where the voltage is low",
            evidence.low_voltage_places,
        ),
        "useful-voltage-zones": (
            "EN 50388: mean useful voltage of zones",
            evidence.useful_voltage_zones,
        ),
        "useful-voltage-trains": (
            "EN 50388: mean useful voltage of trains",
            evidence.useful_voltage_trains,
        ),
        "station-power": ("Highest mean power of feeding stations", evidence.station_power),
        "losses-by-kind": ("Losses by kind of branch", evidence.losses),
        "grid-busbars": ("Unbalance at the busbars of the grid", evidence.unbalance),
        "neutral-sections": ("Voltages across neutral sections", evidence.neutral_sections),
    }
    return [of_frame(key, caption, frame) for key, (caption, frame) in shown.items() if len(frame)]


def of_converter_losses(result: Result) -> list[Table]:
    """The 50 Hz side of converter stations, where any describes its losses."""
    found = result.converter_losses
    caption = "50 Hz side of the converter stations"
    if found.origin.str.contains("estimate").any():
        caption += ", losses by estimate"
    return [of_frame("converter-losses", caption, found)] if len(found) else []


def of_conductors(result: Result) -> list[Table]:
    """Rails, stray current and autotransformers, where there are any."""
    tables = {
        "rails": ("Voltage of the rails to earth", result.rails),
        "stray_current": ("Stray current", result.stray_current),
        "autotransformers": ("Autotransformers", result.autotransformers),
    }
    return [of_frame(name, title, frame) for name, (title, frame) in tables.items() if len(frame)]


def of_transformer_losses(result: Result) -> list[Table]:
    """The grid's side of transformer stations, where any tells its losses without load."""
    found = result.transformer_losses
    caption = "Grid's side of the transformer stations"
    return [of_frame("transformer-losses", caption, found)] if len(found) else []


def of_regeneration(result: Result) -> list[Table]:
    """What each train brakes, and where that goes, where any has electric brakes."""
    found = result.regeneration
    return [of_frame("regeneration", "Braked", found)] if len(found) else []


def of_storage(result: Result) -> list[Table]:
    """What stores of energy took and gave, where there are any."""
    found = result.storage
    return [of_frame("storage", "Stores of energy", found)] if len(found) else []


def of_figures(results: Mapping[str, Result]) -> Table:
    """Key figures of runs, one row per figure and one column per run, with differences to the first."""
    columns = [
        {(name, unit): value for name, unit, value in key_figures(r)} for r in results.values()
    ]
    names = list(dict.fromkeys(name for column in columns for name in column))
    rows = [
        [
            cell(f"{name} [{unit}]" if unit else name, ""),
            *(
                compared(column.get((name, unit)), columns[0].get((name, unit)), name, unit)
                for column in columns
            ),
        ]
        for name, unit in names
    ]
    return Table("key-figures", "Key figures", ["figure", *results], rows)


def key_figures(result: Result) -> list[tuple[str, str, Any]]:
    """Name, unit and value of the most important figures."""
    summary, stations, evidence = result.summary, result.stations, result.standards
    lowest = summary["lowest_voltage"] or {}
    total, lost = summary["total_energy_mwh"], summary["losses_mwh"]
    peaks = zip(stations.station, stations.peak_power_mw, strict=True)
    zones = evidence.useful_voltage_zones
    return [
        ("status", "", result.status),
        ("audit", "", "passed" if result.audit["passed"] else "failed"),
        (
            "violations of voltage limits",
            "",
            int(evidence.violations.standard.isin(OF_VOLTAGE).sum()),
        ),
        ("studied train", "", summary["studied_train"]),
        ("trip time", "min", summary["trip_time_min"]),
        ("simulated time", "min", summary["duration_min"]),
        ("total energy", "MWh", total),
        ("losses", "MWh", lost),
        ("share of losses", "%", 100.0 * lost / total if total else None),
        *_grid_side(summary.get("converter_losses")),
        *_braking(fed_back(result.dataset, result.scenario)),
        *_stored(totals(result.storage)),
        ("lowest voltage", "kV", lowest.get("voltage_kv")),
        ("train with lowest voltage", "", lowest.get("train")),
        _place("place of lowest voltage", lowest),
        ("time of lowest voltage", "min", lowest.get("time_min")),
        *_highest_loading(stations),
        *(
            (f"unbalance at {busbar}, highest mean of 10 min", "%", percent)
            for busbar, percent in zip(
                evidence.unbalance.busbar, evidence.unbalance.mean_10_min_percent, strict=True
            )
        ),
        *(
            (f"mean useful voltage, {zone}", "kV", float(mean_kv))
            for zone, mean_kv in zip(zones.zone, zones.mean_useful_kv, strict=True)
        ),
        *((f"energy of {name}", "MWh", mwh) for name, mwh in summary["station_energy_mwh"].items()),
        *((f"peak power of {name}", "MW", float(peak)) for name, peak in peaks),
        *(
            (f"peak loading of {name}", "%", 100.0 * float(loading))
            for name, loading in zip(stations.station, stations.peak_loading, strict=True)
        ),
    ]


def _grid_side(found: Mapping[str, Any] | None) -> list[tuple[str, str, Any]]:
    """What converter stations lose, take from the 50 Hz grid and give back; empty if not described."""
    if found is None:
        return []
    origin = " by estimate" if "estimate" in found["origins"] else ""
    efficiency = found["mean_efficiency"]
    return [
        (f"losses of converter stations{origin}", "MWh", found["losses_mwh"]),
        ("energy from the 50 Hz grid", "MWh", found["from_grid_mwh"]),
        ("energy to the 50 Hz grid", "MWh", found["to_grid_mwh"]),
        (
            "mean efficiency of converter stations",
            "%",
            None if efficiency is None else 100.0 * efficiency,
        ),
        ("starts of converters", "", found["starts"]),
    ]


BRAKED = {
    "braked_mwh": "energy braked",
    "friction_mwh": "braked by friction",
    "machine_losses_mwh": "lost in machines that brake",
    "refused_mwh": "refused by the line",
    "rheostat_mwh": "burnt in rheostats of trains",
    "own_use_mwh": "own use of trains that brake",
    "own_storage_mwh": "taken by stores of their own",
    "fed_back_mwh": "fed back by trains",
    "used_by_others_mwh": "of it used by other trains and the line",
    "to_stores_mwh": "of it taken by stores at the line",
    "to_grid_mwh": "of it taken back by stations",
    "burnt_in_stations_mwh": "of it burnt in resistors of stations",
}
"""Words for where braked energy goes."""

OF_STORES = ("own_storage_mwh", "to_stores_mwh")
"""Those that are left out where nothing goes there."""


def _braking(found: Mapping[str, float] | None) -> list[tuple[str, str, Any]]:
    """Where braked energy goes; empty without electric brakes."""
    if found is None:
        return []
    shown = [key for key in BRAKED if found[key] or key not in OF_STORES]
    return [(BRAKED[key], "MWh", found[key]) for key in shown]


def _stored(found: Mapping[str, Mapping[str, float]]) -> list[tuple[str, str, Any]]:
    """What stores of energy took, gave, lost and held; empty without any."""
    return [
        (f"{words} stores {place}", "kWh", sums[key])
        for place, sums in found.items()
        for key, words in STORED.items()
    ]


STORED = {
    "charged_kwh": "taken by",
    "discharged_kwh": "given by",
    "losses_kwh": "lost in",
    "start_kwh": "at the beginning in",
    "end_kwh": "at the end in",
}
"""Words for what stores of energy do, before their place."""


def _place(name: str, found: Mapping[str, Any]) -> tuple[str, str, Any]:
    """A place as a figure: its kilometre, or where there are several lines, in words."""
    if LINE not in found:
        return name, "km", found.get("position_km")
    return name, "", on_line(str(found[LINE]), f"km {found['position_km']:.2f}")


def _highest_loading(stations: pd.DataFrame) -> list[tuple[str, str, Any]]:
    """The highest peak loading, where there are several stations, with the station and its place."""
    loading = stations.peak_loading
    if len(stations) < 2 or loading.isna().all():
        return []
    ordered = stations.sort_values("peak_loading", ascending=False)
    worst = {str(name): value for name, value in ordered.iloc[0].items()}
    return [
        ("highest peak loading", "%", 100.0 * worst["peak_loading"]),
        ("station with highest peak loading", "", worst["station"]),
        _place("place of highest peak loading", worst),
    ]


def of_differences(results: Mapping[str, Result]) -> Table:
    """What the scenarios of runs differ in, one row per key path and one column per run."""
    differing = differences([result.scenario for result in results.values()])
    rows = [
        [cell(path, ""), *(cell("–" if value is None else _short(value), "") for value in values)]
        for path, values in list(differing.items())[:MOST_DIFFERENCES]
    ]
    caption = "What differs"
    if len(differing) > MOST_DIFFERENCES:
        caption += f" (the first {MOST_DIFFERENCES} of {len(differing)} keys)"
    return Table("differences", caption, ["key", *results], rows)


def _short(value: Any) -> Any:
    """A value as one would write it; of a long list the beginning."""
    if isinstance(value, float):
        return f"{value:g}"
    if isinstance(value, list) and len(value) > MOST_LISTED:
        return f"{str(value[:MOST_LISTED])[:-1]}, ... {len(value)} in all]"
    return str(value)


def compared(value: Any, base: Any, name: str, unit: str) -> Cell:
    """Cell of a figure, with its difference to that of the first run where that says something."""
    plain = cell(value, unit)
    numbers = all(isinstance(each, int | float) and each == each for each in (value, base))
    if not numbers or value == base or name.startswith(PLACES_AND_TIMES):
        return plain
    difference = f"{value - base:+.{DIGITS.get(unit, 2) if isinstance(value, float) else 0}f}"
    return Cell(f"{plain.text} ({difference})", plain.value, is_number=True)


def cell(value: Any, unit_of_it: str) -> Cell:
    """Cell of a value in the decimals of its unit."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return Cell("–", "", is_number=True)
    if isinstance(value, bool):
        return Cell("yes" if value else "no", "yes" if value else "no", is_number=False)
    if not isinstance(value, int | float):
        return Cell(str(value), str(value), is_number=False)
    digits = 0 if isinstance(value, int) else DIGITS.get(unit_of_it, 2)
    return Cell(f"{value:z.{digits}f}", f"{value:.7g}", is_number=True)
