"""Key figures of a run, gathered from its recording: energies, voltages, loadings, and its audit.

`tpss.results.tables` and its neighbours compute more of them from a dataset, for the reader of one run.
"""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.audit.balances import ALLOWED_BALANCE, Scratch, new_scratch
from tpss.audit.bundles import balances_apart
from tpss.audit.motion import audit_train
from tpss.audit.network import audit_network, audit_sources, draws_power
from tpss.audit.on_board import audit_own_store
from tpss.audit.stores import audit_stores
from tpss.kernel import inlined, kernel
from tpss.numerics.pairs import magnitude
from tpss.powerflow.network import TOLERANCE
from tpss.record import Record, Records
from tpss.step.model import Model
from tpss.step.recorded import TrainRow
from tpss.step.recording import Recording, lacks_power
from tpss.step.state import TrainState
from tpss.track.leg import Leg, leg_at, place_on_line
from tpss.vehicle.train import Train


class RunFigures(Record):
    """Figures of the whole run."""

    losses_j: float
    """Losses of the network. [J]"""
    drawn_j: float
    """Energy of all trains. [J]"""
    lowest_voltage_v: float
    """Lowest voltage at a pantograph; infinite if there was none. [V]"""
    lowest_voltage_m: float
    """Where that was, along the route of its train. [m]"""
    lowest_voltage_train: int
    lowest_voltage_step: int
    lowest_node_v: float
    """Lowest voltage of a node at the contact line's level. [V]"""
    highest_voltage_v: float
    """Highest voltage at pantographs and such nodes. [V]"""
    passes: int
    """Evaluations of the network."""
    most_passes: int
    """Most of a step."""


class TrainFigures(Record):
    """Figures of a train."""

    energy_j: float
    """Energy at the pantograph. [J]"""
    steps: int
    """Steps with a pantograph voltage."""
    lowest_voltage_v: float
    """Lowest voltage at its pantograph. [V]"""
    useful_steps: int
    """Steps in the peak window."""
    pulling_steps: int
    """Of these, those with tractive effort."""
    pulling_voltage_v: float
    """Voltage, summed over them. [V]"""
    first_m: float
    """Lowest position. [m]"""
    last_m: float
    """Highest position. [m]"""


class StationFigures(Record):
    """Figures of a feeding station."""

    energy_j: float
    """Energy fed. [J]"""
    reactive_j: float
    """Reactive energy fed. [var s]"""
    peak_w: float
    """Highest active power. [W]"""
    loading: float
    """Loading, summed over the steps. [1]"""
    peak_loading: float
    """Highest loading. [1]"""


class Zone(Record):
    """A zone with its useful voltage."""

    line: int
    """Index of its line."""
    from_km: float
    to_km: float
    """Where it ends; infinite for a zone that ends with the line. [km]"""
    steps: int
    """Steps of trains in the peak window."""
    voltage_v: float
    """Voltage, summed over them. [V]"""


class Figures(NamedTuple):
    """Key figures of a run, all in SI units."""

    run: Records[RunFigures]
    """One record."""
    trains: Records[TrainFigures]
    stations: Records[StationFigures]
    zones: Records[Zone]
    audit: Scratch


def new_figures(model: Model, trains: int, zones: list[tuple[int, float, float]]) -> Figures:
    """Figures of so many trains before they are gathered, with the zones' lines and ends. [km]"""
    stations = model.network.sources.size
    return Figures(
        run=RunFigures.blank(1),
        trains=TrainFigures.blank(trains),
        stations=StationFigures.blank(stations),
        zones=Zone.array((*zone, 0, 0.0) for zone in zones),
        audit=new_scratch(model.network, trains),
    )


@kernel
def gather(
    first: int,
    last: int,
    steps: int,
    last_step_s: float,
    peak_from: int,
    peak_to: int,
    at_line_level: npt.NDArray[np.bool_],
    trains: Records[Train],
    model: Model,
    recording: Recording,
    figures: Figures,
) -> None:
    """Gather the figures of steps of a recording, and audit them; all of them, a stretch at a time.

    Parameters
    ----------
    first, last : int
        The first step, and the one after the last, of a stretch with one network: that of the model.
    steps : int
        Steps carried out in all.
    last_step_s : float
        Length of the last one. [s]
    peak_from, peak_to : int
        Bounds of the peak window, in steps; equal if the run does not cover it.
    at_line_level : array of bool, shape (nodes,)
        Whether a node is at the contact line's level.
    trains : records of Train
        The trains, for their types and times.
    model, recording : Model, Recording
    figures : Figures
        As from `new_figures`; filled.
    """
    run, h = figures.run[0], model.options.step_s
    if first == 0:
        _begin(figures)
    for step in range(first, last):
        in_window = peak_from <= step and step < peak_to
        duration = h if step + 1 < steps else last_step_s
        gather_trains(step, in_window, duration, trains, model.legs, recording, figures)
        gather_network(step, duration, at_line_level, recording, figures)
    _audit(first, last, steps, last_step_s, trains, model, recording, figures.audit)
    if last < steps:
        return
    for i in range(figures.trains.size):
        note_place(recording.trains[steps, i].route_position, figures.trains[i])
    for s in range(figures.stations.size):  # at last, as the tables of a dataset do
        station, row = figures.stations[s], recording.stations[max(steps, 1) - 1, s]
        station.energy_j *= h
        station.reactive_j *= h
        if last_step_s != h and steps > 0:
            station.energy_j -= row.station_active_power * (h - last_step_s)
            station.reactive_j -= row.station_reactive_power * (h - last_step_s)
    _gather_passes(steps, recording, run)
    conclude_audit(steps, model, figures.audit)


@inlined
def _begin(figures: Figures) -> None:
    """Extremes of nothing."""
    run = figures.run[0]
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


@inlined
def note_place(position_m: float, train: TrainFigures) -> None:
    """Note where a train has been. [m]"""
    if not math.isnan(position_m):
        train.first_m = min(train.first_m, position_m)
        train.last_m = max(train.last_m, position_m)


@inlined
def gather_trains(
    step: int, in_window: bool, h: float, trains: Records[Train], legs: Records[Leg],
    recording: Recording, figures: Figures,
) -> None:  # fmt: skip
    """Add a step of every train on the line."""
    run = figures.run[0]
    for i in range(figures.trains.size):
        if recording.train_state[step, i] == TrainState.ABSENT:
            continue
        row, train = recording.trains[step, i], figures.trains[i]
        voltage = magnitude(complex(row.pantograph_real, row.pantograph_imag))
        note_place(row.route_position, train)
        if math.isnan(voltage) or voltage == 0.0 or lacks_power(step, i, h, recording):
            continue  # it is not fed, and draws nothing
        train.energy_j += row.active_power * h
        train.steps += 1
        train.lowest_voltage_v = min(train.lowest_voltage_v, voltage)
        run.drawn_j += row.active_power * h
        run.highest_voltage_v = max(run.highest_voltage_v, voltage)
        if voltage < run.lowest_voltage_v:
            run.lowest_voltage_v = voltage
            run.lowest_voltage_m = row.route_position
            run.lowest_voltage_train = i
            run.lowest_voltage_step = step
        if in_window:
            route = trains[i].route
            leg = legs[route, leg_at(row.route_position, 0, route, legs)]
            _note_useful_voltage(voltage, row, leg, train, figures.zones)


@inlined
def _note_useful_voltage(
    voltage_v: float, row: TrainRow, leg: Leg, train: TrainFigures, zones: Records[Zone]
) -> None:
    """Add a train's voltage to its own useful voltage, and to that of the zone in which it is.

    References
    ----------
    [EN50388]_
    """
    train.useful_steps += 1
    if row.tractive_force > 0.0:
        train.pulling_steps += 1
        train.pulling_voltage_v += voltage_v
    place_km = place_on_line(row.route_position, leg) / 1e3
    for z in range(zones.size):
        zone = zones[z]
        if zone.line == leg.line and zone.from_km <= place_km and place_km < zone.to_km:
            zones[z].steps += 1
            zones[z].voltage_v += voltage_v


@inlined
def gather_network(
    step: int,
    h: float,
    at_line_level: npt.NDArray[np.bool_],
    recording: Recording,
    figures: Figures,
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
            node = recording.nodes[step, n]
            voltage = magnitude(complex(node.node_real, node.node_imag))
            if voltage == 0.0:  # it is not fed
                continue
            run.lowest_node_v = min(run.lowest_node_v, voltage)
            run.highest_voltage_v = max(run.highest_voltage_v, voltage)


@inlined
def _gather_passes(steps: int, recording: Recording, run: RunFigures) -> None:
    """Evaluations of the network, those of a step without solution included."""
    for step in range(steps + 1):
        passes = recording.passes[step]
        run.passes += passes if step < max(steps, 1) else 0
        run.most_passes = max(run.most_passes, passes)


@inlined
def _audit(
    first: int, last: int, steps: int, last_step_s: float, trains: Records[Train], model: Model,
    recording: Recording, scratch: Scratch,
) -> None:  # fmt: skip
    """Audit a stretch of a recording; the figures are left in ``scratch.balances``.

    Parameters
    ----------
    first, last, steps : int
        As of `gather`.
    last_step_s : float
        Length of the last one. [s]
    trains : records of Train
        The trains, for their types and times.
    model, recording : Model, Recording
    scratch : Scratch
        As from `new_scratch`, with as many trains as count.
    """
    h = model.options.step_s
    for step in range(first, last):
        duration = h if step + 1 < steps else last_step_s
        audit_step(step, duration, trains, model, recording, scratch)


@inlined
def audit_step(
    step: int, duration: float, trains: Records[Train], model: Model, recording: Recording,
    scratch: Scratch,
) -> None:  # fmt: skip
    """Audit one step of this length. [s]"""
    figures = scratch.balances[0]
    audit_network(step, trains, model, recording, scratch)
    audit_sources(step, duration, model, recording, scratch)
    if model.network.stores.size > 0:
        audit_stores(step, duration, model.network, recording.stores, scratch, figures)
    figures.lost_j += recording.network_losses[step] * duration
    for i in range(scratch.order.size):
        if draws_power(recording.train_state[step, i]):
            audit_train(step, i, duration, trains[i], model, recording, figures)
            if recording.on_board.shape[0] > 0:
                kind = model.types[trains[i].train_type]
                audit_own_store(step, i, duration, kind, recording, scratch.stored[0], figures)


@inlined
def conclude_audit(steps: int, model: Model, scratch: Scratch) -> None:
    """Find the balances of a whole recording."""
    figures, h = scratch.balances[0], model.options.step_s
    least = TOLERANCE * model.network.system.base_power_va / ALLOWED_BALANCE * h * max(steps, 1)
    least *= balances_apart(model.network.bundles, scratch.order.size)
    gap = abs(figures.fed_j - figures.drawn_j - figures.stored_j - figures.lost_j)
    figures.network_balance = gap / max(abs(figures.fed_j), least)
    gap = abs(figures.work_j - figures.moving_j - figures.kinetic_j)
    turned_over = figures.work_j + figures.fallen_j + figures.slowed_j
    figures.traction_balance = gap / max(turned_over, 1.0)
