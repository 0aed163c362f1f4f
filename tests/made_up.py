"""A small dataset of a run that never was, for hand calculations."""

from typing import Any

import numpy as np
import xarray as xr

nan = float("nan")

INTERVALS = {
    # keyword: (variable, dimension, factor to SI)
    "voltage_kv": ("pantograph_voltage", "train", 1e3),
    "power_mw": ("active_power", "train", 1e6),
    "reactive_mvar": ("reactive_power", "train", 1e6),
    "force_kn": ("tractive_force", "train", 1e3),
    "station_mw": ("station_active_power", "station", 1e6),
    "converters": ("active_converters", "station", 1.0),
    "current_a": ("branch_current", "branch", 1.0),
}


def made_up(
    step_min: float = 1.0,
    position_km: dict[str, list[float]] | None = None,
    losses_kw: list[float] | None = None,
    stations_km: tuple[float, ...] = (0.0, 10.0),
    branches: dict[str, tuple[str, float]] | None = None,
    status: str = "finished",
    **intervals: dict[str, list[float]],
) -> xr.Dataset:
    """Dataset of a 10 km line with the variables that are given.

    Parameters
    ----------
    position_km : dict of str to list
        Positions of each train at every instant, one more than there are steps; by default they go
        1 km in a step.
    losses_kw : list
        Losses of the network in every step.
    branches : dict of str to tuple
        Kind and resistance [Ω] of each branch in `current_a`.
    **intervals : dict of str to list
        What holds in every step, by the keywords of `INTERVALS`, for each train, station or branch.
    """
    steps = len(losses_kw or next(iter(next(iter(intervals.values())).values())))
    dataset = xr.Dataset(
        coords={
            "time": ("time", np.arange(steps + 1.0) * step_min * 60.0),
            "node_position": ("node", [0.0, 10e3]),
            "station_position": ("station", 1e3 * np.array(stations_km)),
        },
        attrs={"time_step_s": step_min * 60.0, "status": status},
    )
    for keyword, given in intervals.items():
        name, dimension, factor = INTERVALS[keyword]
        dataset[dimension] = (dimension, list(given))
        dataset[name] = (("time", dimension), _with_last(list(given.values())) * factor)
    if losses_kw is not None:
        dataset["network_losses"] = ("time", _with_last([losses_kw])[:, 0] * 1e3)
    if branches is not None:
        kinds, resistances = zip(*branches.values(), strict=True)
        dataset = dataset.assign_coords(
            branch_kind=("branch", list(kinds)), branch_resistance=("branch", list(resistances))
        )
    if "train" in dataset.coords:
        each = position_km or {name: list(range(steps + 1)) for name in dataset.train.to_numpy()}
        dataset["position"] = (("time", "train"), 1e3 * np.array(list(each.values()), float).T)
        dataset["route_position"] = dataset.position
    return dataset


def _with_last(columns: list[list[float]]) -> Any:
    """Values of steps as columns, and the last instant, at which there are none."""
    values = np.array(columns, dtype=float).T
    return np.vstack([values, np.full((1, values.shape[1]), nan)])
