"""What trains brake, and where that goes: to themselves, to others, to the grid, or into heat."""

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from tpss.results.standards.windows import Floats, step_values
from tpss.results.tables import J_PER_MWH, over_time
from tpss.scenario.scenario import Scenario

REGENERATED = "regenerated_power"
"""Variable that a dataset has where trains have electric brakes."""

PARTS = ("friction_mwh", "machine_losses_mwh", "refused_mwh", "own_use_mwh", "fed_back_mwh")
"""Columns into which `braked_mwh` is divided."""


def regeneration(dataset: xr.Dataset) -> pd.DataFrame:
    """One row per train: the work of all its brakes, and its parts, which add up to it.

    Friction brakes give what electric ones do not.  Of the work of these the machine loses a part; of
    what it offers the line may refuse some, which friction brakes or a resistor take; the rest feeds the
    train itself first, its auxiliaries, and its motors in the same step; then the line.  Empty unless
    trains have electric brakes.
    """
    if REGENERATED not in dataset:
        return pd.DataFrame(columns=["train", "service", "braked_mwh", *PARTS])
    braked, electric, regenerated, refused, active = (
        np.nan_to_num(step_values(dataset, name))
        for name in (
            "braking_power",
            "electric_braking_power",
            REGENERATED,
            "refused_power",
            "active_power",
        )
    )
    fed_back = np.maximum(-active, 0.0)
    powers = {
        "braked_mwh": braked,
        "friction_mwh": braked - electric,
        "machine_losses_mwh": electric - regenerated - refused,
        "refused_mwh": refused,
        "own_use_mwh": regenerated - fed_back,
        "fed_back_mwh": fed_back,
    }
    return pd.DataFrame(
        {
            "train": dataset.train.to_numpy(),
            "service": dataset.service.to_numpy(),
            **{name: over_time(power, dataset) / J_PER_MWH for name, power in powers.items()},
        }
    )


def fed_back(dataset: xr.Dataset, scenario: Scenario) -> dict[str, Any] | None:
    """Totals of all trains, and where what they feed back goes; None without electric brakes.

    In each step stations take back no more than trains feed back; what they take beyond comes from
    other stations.
    """
    if REGENERATED not in dataset:
        return None
    totals = regeneration(dataset).drop(columns=["train", "service"]).sum()
    given = np.maximum(-np.nan_to_num(step_values(dataset, "active_power")), 0.0).sum(axis=1)
    taken = np.maximum(-np.nan_to_num(step_values(dataset, "station_active_power")), 0.0)
    # A station that takes nothing back takes a thousandth of its rating at most, for its angle.
    taken[:, [station.feedback == "none" for station in scenario.supply.stations]] = 0.0
    to_stations = _no_more_than(given, taken)
    burns = np.array([station.feedback == "resistor" for station in scenario.supply.stations])
    by_station = over_time(to_stations, dataset) / J_PER_MWH
    to_grid, burnt = float(by_station[~burns].sum()), float(by_station[burns].sum())
    return {
        **{str(name): float(value) for name, value in totals.items()},
        "used_by_others_mwh": float(totals["fed_back_mwh"]) - to_grid - burnt,
        "to_grid_mwh": to_grid,
        "burnt_in_stations_mwh": burnt,
    }


def _no_more_than(given: Floats, taken: Floats) -> Floats:
    """What stations take, shape (steps, stations), scaled down to what is given in each step."""
    total = taken.sum(axis=1)
    share = np.divide(np.minimum(given, total), total, out=np.zeros_like(total), where=total > 0.0)
    return np.asarray(taken * share[:, None])


def in_words(totals: dict[str, Any]) -> str:
    """Where braked energy goes, in a line."""
    braked = totals["braked_mwh"]
    if braked <= 0.0:
        return "Braked: nothing"
    shares = {
        "other trains and the line": totals["used_by_others_mwh"],
        "the grid": totals["to_grid_mwh"],
        "resistors of stations": totals["burnt_in_stations_mwh"],
        "own use": totals["own_use_mwh"],
        "losses of the machines": totals["machine_losses_mwh"],
        "refused by the line": totals["refused_mwh"],
        "friction": totals["friction_mwh"],
    }
    listed = [f"{words} {100.0 * value / braked:.1f} %" for words, value in shares.items() if value]
    return f"Braked: {braked:.3f} MWh, of which {', '.join(listed)}"
