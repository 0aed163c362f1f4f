"""Tables of trains and feeding stations: one row per train, one row per station."""

import numpy as np
import numpy.typing as npt
import pandas as pd
import xarray as xr

from tpss.results.places import (
    TRACK,
    line_names,
    lines_of,
    train_lines,
    train_tracks,
    where_told,
)
from tpss.step.recorded import RECORDED
from tpss.units import si_factor

J_PER_MWH = 3.6e9


def trips(dataset: xr.Dataset) -> pd.DataFrame:
    """One row per train: times, distance, energy, and where its voltage was lowest, if it was fed.

    Trains that were on the line at the start have no departure, those still on it no arrival.
    """
    time_min = dataset.time.to_numpy() / 60.0
    position_km, travelled_km = dataset.position.to_numpy() / 1e3, distance_km(dataset)
    voltage_kv = dataset.pantograph_voltage.to_numpy() / 1e3
    fed = voltage_kv > 0.0
    lowest = np.argmin(np.where(fed, voltage_kv, np.inf), axis=0)
    each = np.arange(dataset.sizes["train"])
    names = line_names(dataset)
    line = np.array(names, dtype=object)
    drawn = fed.any(axis=0)
    departure_min = dataset.departure_time.to_numpy() / 60.0
    arrival_min = dataset.arrival_time.to_numpy() / 60.0
    # A train that braked within a step has arrived before the first instant at which it stands.
    seen = np.isfinite(position_km)
    stood_min = np.where(seen, time_min[:, None], -np.inf).max(axis=0) - arrival_min
    there = np.isfinite(voltage_kv).astype(float)
    # One that departs within a step is there from the instant before.
    waited_min = np.nan_to_num(departure_min - time_min[there.argmax(axis=0)]) * drawn
    moving_min = over_time(there, dataset) / 60.0 - np.nan_to_num(stood_min) - waited_min
    return pd.DataFrame(
        {
            "train": dataset.train.to_numpy(),
            "service": dataset.service.to_numpy(),
            "departure_min": departure_min,
            "arrival_min": arrival_min,
            "trip_min": arrival_min - departure_min,
            "distance_km": travelled_km,
            "mean_speed_kmh": travelled_km / np.where(moving_min > 0, moving_min, np.nan) * 60.0,
            "energy_mwh": over_time(dataset.active_power.to_numpy(), dataset) / J_PER_MWH,
            "lowest_voltage_kv": np.where(drawn, voltage_kv[lowest, each], np.nan),
            **where_told({"lowest_voltage_line": line[train_lines(dataset)[lowest, each]]}, names),
            "lowest_voltage_km": np.where(drawn, position_km[lowest, each], np.nan),
            "lowest_voltage_min": np.where(drawn, time_min[lowest], np.nan),
        }
    )


def stations(dataset: xr.Dataset) -> pd.DataFrame:
    """One row per feeding station: energy, peaks, loading, converters."""
    active = dataset.station_active_power.to_numpy()
    reactive = dataset.station_reactive_power.to_numpy()
    loading = dataset.converter_loading.to_numpy()
    converters = dataset.active_converters.to_numpy()
    steps, names = max(dataset.sizes["time"] - 1, 1), line_names(dataset)

    def peak(values: np.ndarray) -> np.ndarray:
        return np.asarray(np.max(np.where(np.isfinite(values), values, -np.inf), axis=0))

    return pd.DataFrame(
        {
            "station": dataset.station.to_numpy(),
            **where_told(
                {"line": np.array(names, dtype=object)[lines_of(dataset, "station")]}, names
            ),
            "position_km": dataset.station_position.to_numpy() / 1e3,
            "energy_mwh": over_time(active, dataset) / J_PER_MWH,
            "reactive_energy_mvarh": over_time(reactive, dataset) / J_PER_MWH,
            "peak_power_mw": peak(active) / 1e6,
            "mean_loading": np.nansum(loading, axis=0) / steps,
            "peak_loading": peak(loading),
            "mean_converters": np.nansum(converters, axis=0) / steps,
        }
    ).replace(-np.inf, np.nan)


TRAIN_STEPS = {each.column: each.name for each in RECORDED if each.column}
"""Columns of `train_steps` that are numbers, and the variables that they show."""


def train_steps(dataset: xr.Dataset) -> pd.DataFrame:
    """One row per train and instant at which it is on the line, train by train.

    Position and speed are those at the instant, all else applies from there to the next one.
    """
    there = np.isfinite(dataset.position.to_numpy().T)
    train, instant = np.nonzero(there)
    names = line_names(dataset)
    line = np.array(names, dtype=object)
    states = dataset.train_state.attrs["flag_meanings"].split()
    state = dataset.train_state.to_numpy().T[there]
    return pd.DataFrame(
        {
            "train": dataset.train.to_numpy()[train],
            "service": dataset.service.to_numpy()[train],
            "time_min": dataset.time.to_numpy()[instant] / 60.0,
            **where_told({"line": line[train_lines(dataset).T[there]]}, names),
            **({"track": train_tracks(dataset).T[there]} if TRACK in dataset else {}),
            "state": np.array([*states, ""], dtype=object)[state],
            **{
                column: dataset[name].to_numpy().T[there] / si_factor(column)
                for column, name in TRAIN_STEPS.items()
            },
        }
    )


def distance_km(dataset: xr.Dataset) -> npt.NDArray[np.float64]:
    """Distance that each train covers within the run. [km]"""
    position_m = dataset.route_position.to_numpy()
    distance_m = np.nanmax(position_m, axis=0) - np.nanmin(position_m, axis=0)
    return np.asarray(np.nan_to_num(distance_m) / 1e3)


def step_s(dataset: xr.Dataset) -> float:
    """Length of a time step. [s]"""
    return float(dataset.attrs["time_step_s"])


def short_s(dataset: xr.Dataset) -> float:
    """What the last time step lacks of the others, as it may end with an arrival. [s]"""
    return step_s(dataset) - float(dataset.attrs.get("last_step_s", step_s(dataset)))


def over_time(values: npt.NDArray[np.float64], dataset: xr.Dataset) -> npt.NDArray[np.float64]:
    """Values that hold over the steps, summed over time: watts become joules.

    Parameters
    ----------
    values : array, shape (steps or instants, ...)
        NaN where there is none.
    dataset : Dataset
        Of the run.
    """
    if dataset.sizes["time"] < 2:
        return np.zeros(values.shape[1:])
    last = np.nan_to_num(values[dataset.sizes["time"] - 2])
    return np.asarray(np.nansum(values, axis=0) * step_s(dataset) - last * short_s(dataset))
