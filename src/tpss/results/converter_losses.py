"""What converter stations lose, and what they take from the 50 Hz grid and give back to it."""

import math
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from tpss.results.grid_side import Powers, powers_of, sides_of
from tpss.results.standards.windows import Floats, highest_means, step_values
from tpss.results.tables import J_PER_MWH, over_time, step_s
from tpss.scenario.scenario import Scenario

WINDOWS = {"peak_1_min_mw": 1.0, "peak_15_min_mw": 15.0, "peak_1_h_mw": 60.0}
"""Columns with the highest mean power from the grid, and their windows. [min]"""

PARTS = ("idle_mwh", "by_load_mwh", "auxiliaries_mwh")
"""Columns into which `losses_mwh` is divided."""

ENERGIES = ("from_grid_mwh", "to_grid_mwh", "burnt_mwh", "losses_mwh", *PARTS)
"""Columns that a total adds up."""

COLUMNS = (
    "station",
    *ENERGIES,
    "mean_efficiency",
    "starts",
    "peak_from_grid_mw",
    *WINDOWS,
    "origin",
)


def describes_losses(scenario: Scenario) -> bool:
    """Whether any station says what it loses."""
    return any(side.is_described for side in sides_of(scenario))


def station_powers(dataset: xr.Dataset, scenario: Scenario) -> dict[str, Powers]:
    """Powers on the 50 Hz side in every step, by the stations that describe losses."""
    active, reactive, running = (
        np.nan_to_num(step_values(dataset, name))
        for name in ("station_active_power", "station_reactive_power", "active_converters")
    )
    return {
        side.name: powers_of(active[:, s], reactive[:, s], running[:, s], side)
        for s, side in enumerate(sides_of(scenario))
        if side.is_described
    }


def converter_losses(dataset: xr.Dataset, scenario: Scenario) -> pd.DataFrame:
    """One row per station that describes losses: energies on the 50 Hz side, losses, starts, peaks.

    Energy from the grid, less that to the grid, is what the station fed, plus its losses, plus what its
    resistor burnt.  The efficiency is what leaves the station, to either side, over what it is given.
    Peaks are those of a time step, and of the mean over windows; NaN where the run is shorter.
    """
    running = np.nan_to_num(step_values(dataset, "active_converters"))
    starts = np.maximum(np.diff(running, axis=0), 0.0).sum(axis=0)
    rows, found = [], station_powers(dataset, scenario)
    for s, side in enumerate(sides_of(scenario)):
        if side.name not in found:
            continue
        powers = found[side.name]
        rows.append(
            {
                "station": side.name,
                **_energies(powers, dataset),
                "mean_efficiency": _efficiency([powers], dataset),
                "starts": int(starts[s]),
                **_peaks(powers.from_grid, dataset),
                "origin": side.origin,
            }
        )
    return pd.DataFrame(rows, columns=list(COLUMNS))


def _energies(powers: Powers, dataset: xr.Dataset) -> dict[str, float]:
    found = {
        "from_grid_mwh": powers.from_grid,
        "to_grid_mwh": powers.to_grid,
        "burnt_mwh": powers.burnt,
        "losses_mwh": powers.losses,
        "idle_mwh": powers.idle,
        "by_load_mwh": powers.by_load,
        "auxiliaries_mwh": powers.auxiliaries,
    }
    return {name: float(over_time(watts, dataset)) / J_PER_MWH for name, watts in found.items()}


def _efficiency(stations: Iterable[Powers], dataset: xr.Dataset) -> float:
    """What leaves stations over what they are given; NaN if that is nothing. [1]"""
    given = left = 0.0
    for powers in stations:
        given += float(over_time(powers.from_grid + np.maximum(-powers.fed, 0.0), dataset))
        left += float(over_time(powers.to_grid + np.maximum(powers.fed, 0.0), dataset))
    return left / given if given > 0.0 else math.nan


def _peaks(from_grid_w: Floats, dataset: xr.Dataset) -> dict[str, float]:
    h_min, column = step_s(dataset) / 60.0, from_grid_w[:, None]
    found = {"peak_from_grid_mw": float(np.max(from_grid_w, initial=-math.inf))}
    for name, window_min in WINDOWS.items():
        found[name] = float(highest_means(column, max(window_min / h_min, 1.0))[0][0])
    return {name: w / 1e6 if math.isfinite(w) else math.nan for name, w in found.items()}


def totals(table: pd.DataFrame, dataset: xr.Dataset, scenario: Scenario) -> dict[str, Any] | None:
    """Totals of all stations that describe losses, of plain types; None if none does.

    Parameters
    ----------
    table : DataFrame
        As from `converter_losses`.
    dataset : Dataset
    scenario : Scenario
    """
    if table.empty:
        return None
    efficiency = _efficiency(station_powers(dataset, scenario).values(), dataset)
    undescribed = [
        side.name for side in sides_of(scenario) if any(units.law is None for units in side.units)
    ]
    origins = [origin for each in table.origin for origin in each.split(", ") if origin]
    return {
        **{name: math.fsum(table[name]) for name in ENERGIES},
        "mean_efficiency": None if math.isnan(efficiency) else efficiency,
        "starts": int(table.starts.sum()),
        "origins": list(dict.fromkeys(origins)),
        "stations": {
            str(name): float(mwh) for name, mwh in zip(table.station, table.losses_mwh, strict=True)
        },
        "not_described": undescribed,
    }


def in_words(found: dict[str, Any]) -> str:
    """What converter stations lose, in a line."""
    parts = {"idle": "idle_mwh", "by load": "by_load_mwh", "auxiliaries": "auxiliaries_mwh"}
    listed = ", ".join(f"{words} {found[key]:.3f}" for words, key in parts.items() if found[key])
    text = f"Converter losses: {found['losses_mwh']:.3f} MWh"
    text += f" ({listed})" if listed else ""
    text += f"; from the 50 Hz grid {found['from_grid_mwh']:.3f} MWh"
    if found["to_grid_mwh"]:
        text += f", to it {found['to_grid_mwh']:.3f} MWh"
    if found["burnt_mwh"]:
        text += f", burnt in resistors {found['burnt_mwh']:.3f} MWh"
    return "; ".join([text, *_remarks(found)])


def _remarks(found: dict[str, Any]) -> Iterator[str]:
    if found["mean_efficiency"] is not None:
        yield f"mean efficiency {100.0 * found['mean_efficiency']:.1f} %"
    yield _count(found["starts"], "start")
    if found["origins"]:
        yield f"losses by {' and by '.join(found['origins'])}"
    if found["not_described"]:
        yield f"without converters of {', '.join(found['not_described'])} that are not described"


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"
