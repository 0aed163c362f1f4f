"""Voltage all along the contact line, between what was recorded at trains and feeding points.

Between two neighbouring points that draw or feed, the current in the contact line is the same
everywhere, so the voltage phasor is a straight line; only the line's capacitance bends it, by a few
volts, and what a train on a coupled track induces.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import xarray as xr

from tpss.model.supply_plan import CONTACT_LINE
from tpss.report.sampling import Floats
from tpss.results.places import WITHOUT_POWER

Phasors = npt.NDArray[np.complex128]

MOST_POSITIONS = 240
MOST_TIMES = 320
"""Cells of the map of voltages, along the line and over time."""


@dataclass(frozen=True)
class LineVoltage:
    """Voltage along the contact line over a run.

    Attributes
    ----------
    position_km : array, shape (positions,)
    lowest_kv, mean_kv, highest_kv : array, shape (positions,)
        Over all time steps; the lowest and the highest also over the trains near each position.
    time_min : array, shape (times,)
        When each column of the map begins.
    map_kv : array, shape (positions, times)
        Lowest voltage of the time steps that a column stands for.
    steps_a_column : int
        How many those are.
    """

    position_km: Floats
    lowest_kv: Floats
    mean_kv: Floats
    highest_kv: Floats
    time_min: Floats
    map_kv: Floats
    steps_a_column: int


def line_voltage(dataset: xr.Dataset) -> LineVoltage | None:
    """Voltage along the contact line; None for a run without a time step."""
    steps = dataset.sizes["time"] - 1
    if steps < 1:
        return None
    on_line = dataset.node_kind.to_numpy() == CONTACT_LINE
    node_m = dataset.node_position.to_numpy()[on_line]
    position_m = np.linspace(node_m.min(), node_m.max(), MOST_POSITIONS)
    node_v = _phasors(dataset, "node")[:steps, on_line]
    train_m, train_v = dataset.position.to_numpy()[:steps], _at_trains(dataset)[:steps]
    per_column = -(-steps // MOST_TIMES)
    highest, total = np.full(MOST_POSITIONS, -np.inf), np.zeros(MOST_POSITIONS)
    columns = np.full((-(-steps // per_column), MOST_POSITIONS), np.inf)
    for k in range(steps):
        there = np.isfinite(train_v[k])
        at_m = np.concatenate([node_m, train_m[k, there]])
        at_v = np.concatenate([node_v[k], train_v[k, there]])
        order = np.argsort(at_m, kind="stable")
        volts = np.abs(np.interp(position_m, at_m[order], at_v[order]))
        total += volts
        column = columns[k // per_column]
        np.minimum(column, volts, out=column)
        np.maximum(highest, volts, out=highest)
    step, train = np.nonzero(np.isfinite(train_v))
    cell, at_train = _nearest(position_m, train_m[step, train]), np.abs(train_v[step, train])
    np.minimum.at(columns, (step // per_column, cell), at_train)
    np.maximum.at(highest, cell, at_train)
    return LineVoltage(
        position_km=position_m / 1e3,
        lowest_kv=columns.min(axis=0) / 1e3,
        mean_kv=total / steps / 1e3,
        highest_kv=highest / 1e3,
        time_min=dataset.time.to_numpy()[:steps:per_column] / 60.0,
        map_kv=columns.T / 1e3,
        steps_a_column=per_column,
    )


def _nearest(position_m: Floats, place_m: Floats) -> npt.NDArray[np.int64]:
    """Index of the position that is nearest to each place, of two as near the first one."""
    behind = np.clip(np.searchsorted(position_m, place_m), 1, len(position_m) - 1)
    before = behind - 1
    nearer = np.abs(position_m[behind] - place_m) < np.abs(position_m[before] - place_m)
    return np.where(nearer, behind, before)


def phasors_at(dataset: xr.Dataset, place_m: float) -> Phasors:
    """Voltage of the contact line of a line at a place, at every instant. [V]"""
    on_line = dataset.node_kind.to_numpy() == CONTACT_LINE
    node_m, node_v = (
        dataset.node_position.to_numpy()[on_line],
        _phasors(dataset, "node")[:, on_line],
    )
    train_m, train_v = dataset.position.to_numpy(), _at_trains(dataset)
    found = np.full(len(train_v), np.nan, dtype=np.complex128)
    for k, (at_nodes, at_trains) in enumerate(zip(node_v, train_v, strict=True)):
        there = np.isfinite(at_trains)
        at_m = np.concatenate([node_m, train_m[k, there]])
        order = np.argsort(at_m, kind="stable")
        at_v = np.concatenate([at_nodes, at_trains[there]])
        found[k] = np.interp(place_m, at_m[order], at_v[order])
    return found


def _at_trains(dataset: xr.Dataset) -> Phasors:
    """Voltage at the trains, shape (time, train); NaN in neutral sections, of which it tells nothing."""
    phasors = _phasors(dataset, "pantograph")
    if WITHOUT_POWER in dataset:
        phasors[(phasors == 0.0) & (dataset[WITHOUT_POWER].to_numpy() > 0.0)] = np.nan
    return phasors


def _phasors(dataset: xr.Dataset, place: str) -> Phasors:
    magnitude, angle = dataset[f"{place}_voltage"], dataset[f"{place}_angle"]
    return np.asarray(magnitude.to_numpy() * np.exp(1j * angle.to_numpy()))
