"""Keep everything: states at the instants, forces and powers over the intervals between them."""

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from tpss.driving.own_driver import SLOWEST_WISH_M_S
from tpss.driving.work import mean_powers
from tpss.kernel import at, inlined, kernel, where_any
from tpss.numerics.curve import Points
from tpss.numerics.pairs import magnitude, squared
from tpss.physics.motor import MotorModel, line_voltage_factor, motor_current
from tpss.powerflow.bundle import losses_of_bundles
from tpss.powerflow.bundle_points import is_bundled
from tpss.powerflow.bundles import EARTH, Bundles
from tpss.powerflow.coupled import is_coupled, losses_of_groups
from tpss.powerflow.links import record_links
from tpss.powerflow.network import Flow, Network, Standing
from tpss.powerflow.sharing import losses_by_others
from tpss.record import Records
from tpss.sources.kinds import loading, losses
from tpss.step.converter_control import station_power
from tpss.step.recorded import OnBoardRow, RegenerationRow, StoreRow, TrainRow
from tpss.step.recording import Call, Indices, Recording
from tpss.step.state import Counter, Floats, TrainState
from tpss.storage.store import energy_after, lost_power
from tpss.vehicle.breaches import BREACHES, find_breaches
from tpss.vehicle.demand import armature_demand, motors_power
from tpss.vehicle.on_board import has_store
from tpss.vehicle.terms import Demand
from tpss.vehicle.train import (
    MOST_CALLS,
    Course,
    Phase,
    Train,
    is_on_line,
)
from tpss.vehicle.train_type import TrainType


@kernel
def record_instant(step: int, trains: Records[Train], recording: Recording) -> None:
    """Position and speed of every train on the line, those that have just arrived included."""
    for i in range(trains.size):
        train = trains[at(i)]
        motion, arrived = train.motion, train.motion.phase == Phase.ARRIVED
        if is_on_line(motion.phase) or arrived:
            recording.trains[at(step), at(i)].route_position = motion.position_m
            recording.trains[at(step), at(i)].speed = motion.speed_m_s
            if arrived:
                recording.train_state[at(step), at(i)] = TrainState.ARRIVED


@inlined
def state_of_passage(train: Train) -> TrainState:
    """Code of `train_state` of a train on its passage: what took most work, if it moved."""
    passage = train.passage
    if passage.motor_j > 0.0 and passage.motor_j >= passage.braking_j:
        return TrainState.MOTORING
    if passage.braking_j > 0.0:
        return TrainState.BRAKING
    moves = passage.motion.position_m > train.motion.position_m
    return TrainState.COASTING if moves else TrainState.DWELLING


@inlined
def state_code(train: Train) -> TrainState:
    """Code of `train_state` of a train on the line."""
    if train.decision.course == Course.PASSAGE:
        return state_of_passage(train)
    if train.motion.phase == Phase.DWELLING:
        return TrainState.DWELLING
    if train.forces.braking_n > 0.0:  # in a step that holds the speed first there is both
        return TrainState.BRAKING
    return TrainState.MOTORING if train.forces.tractive_n > 0.0 else TrainState.COASTING


@kernel
def record_trains(
    step: int,
    count: int,
    begin_s: float,
    step_s: float,
    kinds: Records[TrainType],
    points: Points,
    standing: Records[Standing],
    trains: Records[Train],
    rows: Records[TrainRow],
    states: npt.NDArray[np.int8],
    calls: Records[Call],
    counters: Indices,
    without_power_s: Floats,
    regeneration: Records[RegenerationRow],
) -> None:
    """Forces, voltages and powers of the first `count` trains along the line.

    Parameters
    ----------
    begin_s, step_s : float
        When the step begins, and how long it lasts. [s]
    kinds : records of TrainType
    points : records of CurvePoint
    rows, states, calls, counters, without_power_s, regeneration
        Of the recording, which as a whole would cost more to hand over.
    """
    for k in range(count):
        i = standing[at(k)].train
        train, row = trains[at(i)], rows[at(step), at(i)]
        kind = kinds[at(train.train_type)]
        states[at(step), at(i)] = state_code(train)
        if kind.driver.address != 0 and train.decision.wanted_m_s <= SLOWEST_WISH_M_S:
            counters[Counter.LEAST_WISH] += 1
        record_train(standing[at(k)].voltage_v, step_s, train, row)
        if without_power_s.shape[0] > 0:
            passes = train.decision.course == Course.PASSAGE
            without_power_s[at(step), at(i)] = train.passage.without_power_s if passes else 0.0
        if regeneration.shape[0] > 0:
            record_regeneration(train.demand, regeneration[at(step), at(i)])
        if train.decision.course == Course.PASSAGE:
            record_passage(begin_s, step_s, i, train, kind, row, calls)
            count_breaches(train.passage.breaches, counters)
        else:
            record_step(step_s, train, kind, points, row, counters)


@inlined
def record_train(voltage: complex, step_s: float, train: Train, row: TrainRow) -> None:
    """What is recorded of every train: forces, and voltage and powers at its pantograph."""
    demand, forces, moving_share = train.demand, train.forces, train.decision.moving_share
    row.acceleration = (forces.next_speed_m_s - train.motion.speed_m_s) / step_s
    row.tractive_force = forces.tractive_n
    row.braking_force = forces.braking_n
    row.running_resistance = forces.running_resistance_n * moving_share
    row.gradient_force = forces.gradient_n * moving_share
    row.pantograph_real = voltage.real
    row.pantograph_imag = voltage.imag
    row.active_power = demand.active_power_w
    row.reactive_power = demand.reactive_power_var
    row.holding_time = train.decision.hold_s


@inlined
def record_regeneration(demand: Demand, row: RegenerationRow) -> None:
    """What electric brakes have done."""
    row.electric_braking_power = demand.electric_power_w
    row.regenerated_power = demand.regenerated_power_w
    row.refused_power = demand.offered_power_w - demand.regenerated_power_w


@inlined
def record_step(
    step_s: float, train: Train, kind: TrainType, points: Points, row: TrainRow, counters: Indices
) -> None:
    """Works, and the state of the machine, in a step that is no passage."""
    demand = train.demand
    current, _ = armature_demand(demand.wheel_force_n, 0.0, kind, demand)
    if kind.voltage_model != MotorModel.NEW:
        current /= line_voltage_factor(demand.voltage_v, kind.voltage_model)
    row.motor_current = motor_current(current, kind.current_model)
    asked_w = demand.active_power_w
    if has_store(kind):  # beside the line it gives and takes
        asked_w += demand.regenerated_power_w - train.stored.power_w
    row.motor_power = (asked_w - kind.auxiliary_power_w) / demand.per_efficiency
    if kind.over_load.count > 0:
        row.motor_power = motors_power(kind, demand)
    if demand.offered_power_w > 0.0:  # in such a step the motors do nothing else
        row.motor_power = 0.0
    traction_w, braking_w, running_w, gradient_w = mean_powers(train, step_s)
    row.traction_power = traction_w
    row.braking_power = braking_w
    row.resistance_power = running_w
    row.gradient_power = gradient_w
    if demand.force_cap_n > 0.0:
        breaches = find_breaches(train.forces.tractive_n, demand.voltage_v, kind, demand, points)
        count_breaches(breaches, counters)


@inlined
def record_passage(
    begin_s: float, step_s: float, i: int, train: Train, kind: TrainType, row: TrainRow,
    calls: Records[Call],
) -> None:  # fmt: skip
    """Works, current and stops of train `i` on its passage, from a time on for a step. [s]"""
    passage, per_second = train.passage, 1.0 / step_s
    row.motor_current = passage.current_as * per_second
    if math.isnan(kind.base_speed_m_s):  # unknown while it stands, too
        row.motor_current = math.nan
    row.motor_power = passage.motor_j * per_second
    row.traction_power = passage.traction_j * per_second
    row.braking_power = passage.braking_j * per_second
    row.resistance_power = passage.running_j * per_second
    row.gradient_power = passage.gradient_j * per_second
    first = train.motion.next_stop - 1
    for place in range(min(MOST_CALLS, passage.motion.next_stop - first)):
        if place > 0:
            calls[at(i), at(first + place)].arrival_s = begin_s + passage.arrival_s[place]
        if first + place >= 0 and not math.isnan(passage.departure_s[place]):
            calls[at(i), at(first + place)].departure_s = begin_s + passage.departure_s[place]


@inlined
def count_breaches(breaches: int, counters: Indices) -> None:
    """Add a step of a train in which these breaches occurred, a bit each."""
    for breach in range(BREACHES):
        if breaches >> breach & 1:
            counters[at(breach)] += 1


@inlined
def record_network(step: int, network: Network, flow: Flow, recording: Recording) -> None:
    """Voltages of nodes, powers of stations, currents of branches and section ends, losses."""
    for n in range(flow.nodes.size):
        recording.nodes[at(step), at(n)].node_real = flow.nodes[at(n)].voltage_v.real
        recording.nodes[at(step), at(n)].node_imag = flow.nodes[at(n)].voltage_v.imag
    for s in range(network.sources.size):
        row = recording.stations[at(step), at(s)]
        source = network.sources[at(s)]
        node, running = flow.nodes[at(source.node)], flow.sources[at(s)].running
        power = station_power(node, running)
        row.station_active_power = power.real
        row.station_reactive_power = power.imag
        row.active_converters = running
        row.converter_loading = loading(power, running, source.rating_va)
        current = node.leaving_current_a
        row.station_losses = losses(current, running, source)
        row.station_losses += losses_by_others(network.shared, s, network, flow)
    lost_w = 0.0
    for b in range(network.branches.size):
        branch = network.branches[at(b)]
        start, end = flow.nodes[at(branch.start_node)], flow.nodes[at(branch.end_node)]
        drop = start.voltage_v - end.voltage_v
        square = squared(drop) * squared(branch.admittance_s)
        recording.branch_current[at(step), at(b)] = math.sqrt(square)
        lost_w += square * branch.impedance_ohm.real
    lumped = network.branches.size
    for s in range(network.sections.size):
        solution = flow.sections[at(s)]
        recording.branch_current[at(step), at(lumped + 2 * s)] = magnitude(solution.current_a)
        recording.branch_current[at(step), at(lumped + 2 * s + 1)] = magnitude(
            solution.end_current_a
        )
        if not (is_coupled(network.groups, s) or is_bundled(network.bundles, s)):
            lost_w += section_losses(s, network, flow)
    lost_w += losses_of_groups(network.groups, flow)
    record_conductors(network.bundles, step, flow, recording)
    lost_w += losses_of_bundles(network.bundles, flow)
    lost_w += record_links(network.links, step, flow.nodes, recording.links)
    recording.network_losses[at(step)] = lost_w


def _no_conductors(*_: Any) -> None:
    """`record_conductors` where there are no bundles."""


@where_any(without=_no_conductors)
def record_conductors(bundles: Bundles, step: int, flow: Flow, recording: Recording) -> None:
    """Voltages of all conductors at the trains under bundles, and of the rails there."""
    own = flow.bundles
    for g in range(bundles.size.size):
        for p in range(own.first[at(g)], own.first[at(g + 1)]):
            point = own.points[at(p)]
            i = flow.standing[at(point.standing)].train
            for c in range(bundles.size[at(g)]):
                voltage_v = own.voltage_v[at(i), at(c)]
                recording.conductors[at(step), at(i), at(c)] = voltage_v
            returns = bundles.returns[at(g), at(point.conductor)]
            if returns != EARTH:
                rails_v = own.voltage_v[at(i), at(returns)]
                recording.rails[at(step), at(i)].rail_real = rails_v.real
                recording.rails[at(step), at(i)].rail_imag = rails_v.imag


@kernel
def settle_stores(
    step: int, step_s: float, network: Network, flow: Flow, rows: Records[StoreRow]
) -> None:
    """Record what the stores at the line do in a step of this length, and take them to its end. [s]"""
    for m in range(network.stores.size):
        store, state, row = network.stores[at(m)].store, flow.stores[at(m)], rows[at(step), at(m)]
        row.stored_energy = state.energy_j
        row.store_power = state.power_w
        row.store_losses = lost_power(state.power_w, step_s, store, state)
        state.energy_j = energy_after(state.power_w, step_s, store, state)
        rows[at(step + 1), at(m)].stored_energy = state.energy_j


@kernel
def settle_own_stores(
    step: int, count: int, step_s: float, kinds: Records[TrainType], standing: Records[Standing],
    trains: Records[Train], rows: Records[OnBoardRow],
) -> None:  # fmt: skip
    """Record what the stores on board of the first `count` trains do in a step, and end it. [s]"""
    for k in range(count):
        i = standing[at(k)].train
        train, row = trains[at(i)], rows[at(step), at(i)]
        store, state = kinds[at(train.train_type)].on_board.store, train.stored
        row.train_stored_energy = state.energy_j
        row.train_storage_power = state.power_w
        row.train_storage_losses = lost_power(state.power_w, step_s, store, state)
        state.energy_j = energy_after(state.power_w, step_s, store, state)
        rows[at(step + 1), at(i)].train_stored_energy = state.energy_j


@inlined
def section_losses(s: int, network: Network, flow: Flow) -> float:
    """Losses of a contact-line section, I²R piece by piece. [W]"""
    section, solution = network.sections[at(s)], flow.sections[at(s)]
    voltage, z = flow.nodes[at(section.start_node)].voltage_v, section.impedance_ohm_per_m
    sum_v2_per_m = 0.0
    for k in range(solution.first, solution.end + 1):
        if k < solution.end:
            after, length_m = flow.standing[at(k)].voltage_v, flow.standing[at(k)].piece_m
        else:
            after, length_m = flow.nodes[at(section.end_node)].voltage_v, solution.closing_m
        sum_v2_per_m += squared(voltage - after) / length_m
        voltage = after
    return sum_v2_per_m * z.real / squared(z)
