"""Tables of a report: headings with units, cells with what is shown and what is downloaded."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from tpss import units
from tpss.results.result import Result

ENERGY_UNITS = {"_mwh": "MWh", "_mvarh": "Mvarh", "_mw": "MW"}
"""Suffixes that no scenario uses."""

DIGITS = {"MWh": 3, "Mvarh": 3, "km/h": 1, "km": 2, "min": 2, "kV": 3, "MW": 3}
"""Decimals that are shown, by unit; others have two."""


@dataclass(frozen=True)
class Cell:
    """What a cell shows, and its value to seven digits, by which it is sorted and downloaded."""

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
    """Table of a pandas table whose names end with their units."""
    columns = [str(name) for name in frame.columns]
    rows = [
        [_cell(value, unit(name)) for name, value in zip(columns, row, strict=True)]
        for row in frame.itertuples(index=False)
    ]
    return Table(key, caption, [heading(name) for name in columns], rows)


def of_figures(results: Mapping[str, Result]) -> Table:
    """Key figures of runs, a row a figure and a column a run."""
    columns = [dict(key_figures(result)) for result in results.values()]
    names = list(dict.fromkeys(name for column in columns for name in column))
    rows = [
        [_cell(heading(name), ""), *(_cell(column.get(name), unit(name)) for column in columns)]
        for name in names
    ]
    return Table("key-figures", "Key figures", ["figure", *results], rows)


def key_figures(result: Result) -> list[tuple[str, Any]]:
    """Name, with its unit, and value of what a reader asks for first."""
    summary, stations = result.summary, result.stations
    lowest = summary["lowest_voltage"] or {}
    total = summary["total_energy_mwh"]
    peaks = zip(stations.station, stations.peak_power_mw, strict=True)
    return [
        ("status", result.status),
        ("audit", "passed" if result.audit["passed"] else "failed"),
        ("studied_train", summary["studied_train"]),
        ("trip_time_min", summary["trip_time_min"]),
        ("simulated_time_min", summary["duration_min"]),
        ("total_energy_mwh", total),
        ("losses_mwh", summary["losses_mwh"]),
        ("share_of_losses_percent", 100.0 * summary["losses_mwh"] / total if total else None),
        ("lowest_voltage_kv", lowest.get("voltage_kv")),
        ("train_with_lowest_voltage", lowest.get("train")),
        ("place_of_lowest_voltage_km", lowest.get("position_km")),
        ("time_of_lowest_voltage_min", lowest.get("time_min")),
        *((f"energy of {name}_mwh", mwh) for name, mwh in summary["station_energy_mwh"].items()),
        *((f"peak power of {name}_mw", float(peak)) for name, peak in peaks),
    ]


def heading(name: str) -> str:
    """A name in words, with its unit in brackets."""
    mark = f" [{unit(name)}]" if unit(name) else ""
    return name.removesuffix(_suffix(name)).replace("_", " ") + mark


def unit(name: str) -> str:
    """Unit of a name as it is written for people; empty for a pure number."""
    if name.endswith("_percent"):
        return "%"
    return ENERGY_UNITS.get(_suffix(name), "") or units.label(name)


def _suffix(name: str) -> str:
    further = [suffix for suffix in (*ENERGY_UNITS, "_percent") if name.endswith(suffix)]
    return further[0] if further else units.suffix(name)


def _cell(value: Any, unit_of_it: str) -> Cell:
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return Cell("–", "", is_number=True)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return Cell(str(value), str(value), is_number=False)
    digits = 0 if isinstance(value, int) else DIGITS.get(unit_of_it, 2)
    return Cell(f"{value:.{digits}f}", f"{value:.7g}", is_number=True)
