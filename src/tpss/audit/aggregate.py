"""Key figures of a run, gathered from its recording: energies, voltages, loadings, and its audit.

`tpss.results.tables` and its neighbours compute more of them from a dataset, for the reader of one run.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from tpss.audit.balances import Scratch, audit_run, new_scratch
from tpss.kernel import blank_records, inlined, kernel, records
from tpss.powerflow.pairs import magnitude
from tpss.simulation.state import ABSENT, Model, Recording

RUN_FIGURES = np.dtype(
    [
        ("losses_j", float),
        ("drawn_j", float),  # by all trains
        ("lowest_voltage_v", float),  # at a pantograph; NaN, as its place, if there was none
        ("lowest_voltage_m", float),
        ("lowest_voltage_train", np.int64),
        ("lowest_voltage_step", np.int64),
        ("lowest_node_v", float),  # of nodes at the contact line's level
        ("highest_voltage_v", float),  # at pantographs and such nodes
        ("passes", np.int64),
        ("most_passes", np.int64),
    ],
    align=True,
)
"""Figures of the whole run."""

TRAIN_FIGURES = np.dtype(
    [
        ("energy_j", float),
        ("steps", np.int64),  # with a pantograph voltage
        ("lowest_voltage_v", float),
        ("useful_steps", np.int64),  # in the peak window
        ("pulling_steps", np.int64),  # of these, with tractive effort
        ("pulling_voltage_v", float),  # sum over them
        ("first_m", float),
        ("last_m", float),
    ],
    align=True,
)
"""Figures of a train."""

STATION_FIGURES = np.dtype(
    [
        ("energy_j", float),
        ("reactive_j", float),
        ("peak_w", float),
        ("loading", float),  # sum over the steps
        ("peak_loading", float),
    ],
    align=True,
)
"""Figures of a converter station."""

ZONE = np.dtype(
    [
        ("from_km", float),
        ("to_km", float),  # infinite for a zone that ends with the line
        ("steps", np.int64),  # of trains in the peak window
        ("voltage_v", float),  # sum over them
    ],
    align=True,
)
"""A zone with its useful voltage."""


class Figures(NamedTuple):
    """Key figures of a run, all in SI units."""

    run: Any
    """One record of `RUN_FIGURES`."""
    trains: Any
    """Records of `TRAIN_FIGURES`."""
    stations: Any
    """Records of `STATION_FIGURES`."""
    zones: Any
    """Records of `ZONE`."""
    audit: Scratch


def new_figures(model: Model, trains: int, zones: list[tuple[float, float]]) -> Figures:
    """Figures of so many trains before they are gathered, with the zones' ends. [km]"""
    nodes, stations = model.network.source_of_node.size, model.network.sources.size
    return Figures(
        run=blank_records(1, RUN_FIGURES),
        trains=blank_records(trains, TRAIN_FIGURES),
        stations=blank_records(stations, STATION_FIGURES),
        zones=records([(begin, end, 0, 0.0) for begin, end in zones], ZONE),
        audit=new_scratch(nodes, trains),
    )


@kernel
def gather(
    steps: int,
    peak_from: int,
    peak_to: int,
    at_line_level: Any,
    types_of: Any,
    model: Model,
    recording: Recording,
    figures: Figures,
) -> None:
    """Gather the figures of a recording, and audit it.

    Parameters
    ----------
    steps : int
        Steps carried out.
    peak_from, peak_to : int
        Bounds of the peak window, in steps; equal if the run does not cover it.
    at_line_level : array of bool, shape (nodes,)
        Whether a node is at the contact line's level.
    types_of : records of `TRAIN`
        The trains, for their types.
    model, recording : Model, Recording
    figures : Figures
        As from `new_figures`; filled.
    """
    run, h = figures.run[0], model.options.step_s
    run.lowest_voltage_v = math.inf
    run.lowest_node_v = math.inf
    run.highest_voltage_v = -math.inf
    for i in range(figures.trains.size):
        figures.trains[i].lowest_voltage_v = math.inf
        figures.trains[i].first_m = math.inf
        figures.trains[i].last_m = -math.inf
    for s in range(figures.stations.size):
        figures.stations[s].peak_w = -math.inf
        figures.stations[s].peak_loading = -math.inf
    for step in range(steps):
        in_window = peak_from <= step and step < peak_to
        _gather_trains(step, in_window, h, recording, figures)
        _gather_network(step, h, at_line_level, recording, figures)
    for i in range(figures.trains.size):
        _note_place(recording.trains[steps, i].position, figures.trains[i])
    for s in range(figures.stations.size):  # at last, as the tables of a dataset do
        figures.stations[s].energy_j *= h
        figures.stations[s].reactive_j *= h
    _gather_passes(steps, recording, run)
    audit_run(steps, types_of, model, recording, figures.audit)


@inlined
def _note_place(position_m: float, train: Any) -> None:
    if not math.isnan(position_m):
        train.first_m = min(train.first_m, position_m)
        train.last_m = max(train.last_m, position_m)


@inlined
def _gather_trains(
    step: int, in_window: bool, h: float, recording: Recording, figures: Figures
) -> None:
    """Add a step of every train on the line."""
    run = figures.run[0]
    for i in range(figures.trains.size):
        if recording.train_state[step, i] == ABSENT:
            continue
        row, train = recording.trains[step, i], figures.trains[i]
        voltage = magnitude(complex(row.pantograph_real, row.pantograph_imag))
        _note_place(row.position, train)
        if math.isnan(voltage):
            continue
        train.energy_j += row.active_power * h
        train.steps += 1
        train.lowest_voltage_v = min(train.lowest_voltage_v, voltage)
        run.drawn_j += row.active_power * h
        run.highest_voltage_v = max(run.highest_voltage_v, voltage)
        if voltage < run.lowest_voltage_v:
            run.lowest_voltage_v = voltage
            run.lowest_voltage_m = row.position
            run.lowest_voltage_train = i
            run.lowest_voltage_step = step
        if in_window:
            _note_useful_voltage(voltage, row, train, figures.zones)


@inlined
def _note_useful_voltage(voltage_v: float, row: Any, train: Any, zones: Any) -> None:
    """Add a train's voltage to its own useful voltage, and to that of the zone in which it is.

    References
    ----------
    [EN50388]_
    """
    train.useful_steps += 1
    if row.tractive_force > 0.0:
        train.pulling_steps += 1
        train.pulling_voltage_v += voltage_v
    position_km = row.position / 1e3
    for z in range(zones.size):
        if zones[z].from_km <= position_km and position_km < zones[z].to_km:
            zones[z].steps += 1
            zones[z].voltage_v += voltage_v


@inlined
def _gather_network(
    step: int, h: float, at_line_level: Any, recording: Recording, figures: Figures
) -> None:
    """Add a step of stations, nodes and losses."""
    run = figures.run[0]
    run.losses_j += recording.network_losses[step] * h
    for s in range(figures.stations.size):
        row, station = recording.stations[step, s], figures.stations[s]
        station.energy_j += row.station_active_power
        station.reactive_j += row.station_reactive_power
        station.peak_w = max(station.peak_w, row.station_active_power)
        station.loading += row.converter_loading
        station.peak_loading = max(station.peak_loading, row.converter_loading)
    for n in range(at_line_level.size):
        if at_line_level[n]:
            row = recording.nodes[step, n]
            voltage = magnitude(complex(row.node_real, row.node_imag))
            run.lowest_node_v = min(run.lowest_node_v, voltage)
            run.highest_voltage_v = max(run.highest_voltage_v, voltage)


@inlined
def _gather_passes(steps: int, recording: Recording, run: Any) -> None:
    """Evaluations of the network, those of a step without solution included."""
    for step in range(steps + 1):
        passes = recording.passes[step]
        run.passes += passes if step < max(steps, 1) else 0
        run.most_passes = max(run.most_passes, passes)
