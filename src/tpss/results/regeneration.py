"""What trains brake, and where that goes: to themselves, to others, to the grid, or into heat."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import xarray as xr

from tpss.results.grid_side import StationSide, sides_of
from tpss.results.standards.windows import Floats, step_values
from tpss.results.tables import J_PER_MWH, over_time
from tpss.scenario.scenario import Scenario

REGENERATED = "regenerated_power"
"""Variable that a dataset has where trains have electric brakes."""

STORED = "store_power"
"""Variable that it has where there are stores at the line."""

PARTS = (
    "friction_mwh",
    "machine_losses_mwh",
    "refused_mwh",
    "rheostat_mwh",
    "own_use_mwh",
    "own_storage_mwh",
    "fed_back_mwh",
)
"""Columns into which `braked_mwh` is divided."""

USES = ("used_by_others_mwh", "to_stores_mwh", "to_grid_mwh", "burnt_in_stations_mwh")
"""Energies into which `fed_back_mwh` is divided: others are other trains, and the losses on the line."""

TOTALS = ("braked_mwh", *PARTS, *USES)
"""Totals of a run."""

OWN_STORAGE = "train_storage_power"
"""Variable that a dataset has where trains have stores on board."""

RECORDED_POWERS = (
    "braking_power",
    "electric_braking_power",
    REGENERATED,
    "refused_power",
    "active_power",
)
"""Recorded powers of trains from which the parts follow."""


def regeneration(dataset: xr.Dataset, scenario: Scenario) -> pd.DataFrame:
    """One row per train: the work of all its brakes, its parts, and where what it feeds back goes.

    Friction brakes give what electric ones do not.  Of the work of these the machine loses a part; of
    what it offers the line may not take some: `rheostat_mwh` of trains with a rheostat, which burn it,
    and `refused_mwh` of others, whose friction brakes take over.  The rest feeds the train itself first,
    its auxiliaries, its motors in the same step, and its store; then the line.  Empty unless trains have
    electric brakes.

    Of what all trains feed back in a step, stores at the line take some, stations some, into the grid or
    resistors, and the rest is used by other trains or lost on the line.  Trains share these uses in
    proportion to what each one feeds back, wherever they are: power has no sender.
    """
    if REGENERATED not in dataset:
        return pd.DataFrame(columns=["train", "service", *TOTALS])
    of_trains = {name: dataset[name].to_numpy() for name in ("train", "service")}
    return pd.DataFrame({**of_trains, **_energies_mwh(dataset, scenario)})


def fed_back(dataset: xr.Dataset, scenario: Scenario) -> dict[str, float] | None:
    """Totals of all trains, and where what they feed back goes; None without electric brakes.

    In each step stations and stores take no more than trains feed back; what they take beyond comes
    from other stations.
    """
    if REGENERATED not in dataset:
        return None
    return {name: float(mwh.sum()) for name, mwh in _energies_mwh(dataset, scenario).items()}


def by_service(dataset: xr.Dataset, scenario: Scenario) -> pd.DataFrame:
    """The same by service, a column for each of `TOTALS`; without electric brakes all is friction.

    Of what trains feed back in a step, those that feed back have the same share used, taken or burnt.
    """
    if REGENERATED in dataset:
        each = pd.DataFrame(_energies_mwh(dataset, scenario))
    else:
        braked = over_time(step_values(dataset, "braking_power"), dataset) / J_PER_MWH
        each = pd.DataFrame(dict.fromkeys(TOTALS, np.zeros_like(braked)))
        each = each.assign(braked_mwh=braked, friction_mwh=braked)
    return each.groupby(dataset.service.to_numpy(), sort=False).sum()


def _energies_mwh(dataset: xr.Dataset, scenario: Scenario) -> dict[str, Floats]:
    """Energies by the names `TOTALS`, shape (trains,)."""
    stations = step_values(dataset, "station_active_power")
    rheostats = have_rheostats(dataset.service.to_numpy().tolist(), scenario)
    stored = step_values(dataset, STORED) if STORED in dataset else None
    powers = powers_of(_recorded(dataset), stations, sides_of(scenario), rheostats, stored)
    return {name: over_time(each, dataset) / J_PER_MWH for name, each in powers.items()}


def have_rheostats(services: Sequence[str], scenario: Scenario) -> npt.NDArray[np.bool_]:
    """Whether trains of services burn what the line does not take in a rheostat."""
    brakes = {name: train.regeneration for name, train in scenario.trains_by_service().items()}
    burn = {name for name, own in brakes.items() if own is not None and own.rest == "rheostat"}
    return np.array([service in burn for service in services], dtype=bool)


def _recorded(dataset: xr.Dataset) -> dict[str, Floats]:
    known = [*RECORDED_POWERS, *([OWN_STORAGE] if OWN_STORAGE in dataset else [])]
    return {name: step_values(dataset, name) for name in known}


def parts_of(recorded: Mapping[str, Floats], rheostats: npt.NDArray[np.bool_]) -> dict[str, Floats]:
    """Power of the brakes and its parts, by the columns of their energies. [W], shape (steps, trains)

    Parameters
    ----------
    recorded : mapping of str to array, shape (steps, trains)
        What is recorded, by the names `RECORDED_POWERS`, and `OWN_STORAGE` where there is any; NaN of
        trains that are not on the line. [W]
    rheostats : array of bool, shape (trains,)
        Whether they burn what the line does not take.
    """
    braked, electric, regenerated, refused, active = (
        np.nan_to_num(recorded[name]) for name in RECORDED_POWERS
    )
    fed_back = np.maximum(-active, 0.0)
    stored = np.zeros_like(active)
    if OWN_STORAGE in recorded:  # what it takes from the line is no part of what is braked
        taken = np.maximum(np.nan_to_num(recorded[OWN_STORAGE]), 0.0)
        stored = np.where(regenerated > 0.0, taken, 0.0)
    return {
        "braked_mwh": braked,
        "friction_mwh": braked - electric,
        "machine_losses_mwh": electric - regenerated - refused,
        "refused_mwh": np.where(rheostats, 0.0, refused),
        "rheostat_mwh": np.where(rheostats, refused, 0.0),
        "own_use_mwh": regenerated - stored - fed_back,
        "own_storage_mwh": stored,
        "fed_back_mwh": fed_back,
    }


def powers_of(
    recorded: Mapping[str, Floats],
    station_w: Floats,
    sides: Sequence[StationSide],
    rheostats: npt.NDArray[np.bool_],
    stored_w: Floats | None = None,
) -> dict[str, Floats]:
    """Those, and where what is fed back goes, by the names `TOTALS`. [W], shape (steps, trains)

    Parameters
    ----------
    recorded : mapping of str to array, shape (steps, trains)
        As of `parts_of`.
    station_w : array, shape (steps, stations)
        Power that stations feed into the railway. [W]
    sides : sequence of StationSide
        What stations do with what is fed back.
    rheostats : array of bool, shape (trains,)
        As of `parts_of`.
    stored_w : array, shape (steps, stores), optional
        Power that stores at the line take. [W]
    """
    parts = parts_of(recorded, rheostats)
    given = parts["fed_back_mwh"]
    total = given.sum(axis=1)
    taken = np.maximum(-np.nan_to_num(station_w), 0.0)
    # A station that takes nothing back takes a thousandth of its rating at most, for its angle.
    taken[:, [side.blocks for side in sides]] = 0.0
    stored = np.zeros_like(total)
    if stored_w is not None:
        stored = np.maximum(np.nan_to_num(stored_w), 0.0).sum(axis=1)
    # What stations and stores take beyond what trains give comes from other stations.
    whole = np.maximum(total, taken.sum(axis=1) + stored)
    of_each = np.maximum(whole, np.finfo(float).tiny)
    to_stores = given * (stored / of_each)[:, None]
    burns = np.array([side.burns for side in sides], dtype=bool)
    to_grid, burnt = (
        given * (taken[:, which].sum(axis=1) / of_each)[:, None] for which in (~burns, burns)
    )
    return {
        **parts,
        "used_by_others_mwh": given - to_stores - to_grid - burnt,
        "to_stores_mwh": to_stores,
        "to_grid_mwh": to_grid,
        "burnt_in_stations_mwh": burnt,
    }


def in_words(totals: dict[str, Any]) -> str:
    """Where braked energy goes, in a line."""
    braked = totals["braked_mwh"]
    if braked <= 0.0:
        return "Braked: nothing"
    shares = {
        "other trains and the line": totals["used_by_others_mwh"],
        "stores at the line": totals["to_stores_mwh"],
        "the grid": totals["to_grid_mwh"],
        "resistors of stations": totals["burnt_in_stations_mwh"],
        "own use": totals["own_use_mwh"],
        "own stores": totals["own_storage_mwh"],
        "losses of the machines": totals["machine_losses_mwh"],
        "rheostats": totals["rheostat_mwh"],
        "refused by the line": totals["refused_mwh"],
        "friction": totals["friction_mwh"],
    }
    listed = [f"{words} {100.0 * value / braked:.1f} %" for words, value in shares.items() if value]
    return f"Braked: {braked:.3f} MWh, of which {', '.join(listed)}"
