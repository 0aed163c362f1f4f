"""Keep everything: states at the instants, forces and powers over the intervals between them."""

import math
from typing import Any

from tpss.kernel import at, inlined, kernel
from tpss.physics.curve import outside_curve
from tpss.physics.locomotive import armature_demand, machine_force
from tpss.physics.machine import effort_extrapolates
from tpss.physics.motor import NEW, line_voltage_factor, motor_current, motor_voltage
from tpss.physics.neural_network import outside
from tpss.physics.reactive_power import (
    DOUBLE_BRIDGE,
    POWER_FACTOR_CURVE,
    TRANSFORMER_RATIO,
    bridge_outside_training,
)
from tpss.powerflow.pairs import magnitude, squared
from tpss.simulation.converter_control import station_loading, station_power
from tpss.simulation.state import (
    ARRIVED,
    DWELLING,
    STATE_ARRIVED,
    STATE_BRAKING,
    STATE_COASTING,
    STATE_DWELLING,
    STATE_MOTORING,
    Counter,
    Indices,
    Model,
    Recording,
    State,
)
from tpss.simulation.traffic import is_on_line


@inlined
def note_journey(train: Any, row: Any) -> None:
    """Keep how a train would go on; a whole record at once takes seconds to compile."""
    row.phase = train.phase
    row.position_m = train.position_m
    row.speed_m_s = train.speed_m_s
    row.next_stop = train.next_stop
    row.dwell_left = train.dwell_left
    row.plan_step = train.plan_step
    row.plan_hold = train.plan_hold
    row.plan_first = train.plan_first
    row.plan_full = train.plan_full
    row.plan_last = train.plan_last


@kernel
def record_instant(step: int, trains: Any, recording: Recording) -> None:
    """Position and speed of every train on the line, those that have just arrived included."""
    for i in range(trains.size):
        train = trains[at(i)]
        if is_on_line(train.phase) or train.phase == ARRIVED:
            recording.trains[at(step), at(i)].position = train.position_m
            recording.trains[at(step), at(i)].speed = train.speed_m_s
            if train.phase == ARRIVED:
                recording.train_state[at(step), at(i)] = STATE_ARRIVED
            if recording.journeys.size > 0:
                note_journey(train, recording.journeys[at(step), at(i)])


@inlined
def state_code(train: Any) -> int:
    """Code of `train_state` of a train on the line."""
    if train.phase == DWELLING:
        return STATE_DWELLING
    if train.braking_force_n > 0.0:  # in a step that holds the speed first there is both
        return STATE_BRAKING
    return STATE_MOTORING if train.force_n > 0.0 else STATE_COASTING


@inlined
def record_train(step: int, k: int, model: Model, state: State, recording: Recording) -> None:
    """Forces, voltage and powers of the `k`-th train along the line."""
    i = state.flow.standing[at(k)].train
    train, row = state.trains[at(i)], recording.trains[at(step), at(i)]
    kind = model.types[at(train.train_type)]
    current, _ = armature_demand(train.wheel_force_n, 0.0, kind, train)
    if kind.voltage_model != NEW:
        current /= line_voltage_factor(train.voltage_v, kind.voltage_model)
    recording.train_state[at(step), at(i)] = state_code(train)
    row.acceleration = (train.next_speed_m_s - train.speed_m_s) / model.options.step_s
    row.tractive_force = train.force_n
    row.braking_force = train.braking_force_n
    row.running_resistance = train.running_resistance_n * train.moving_share
    row.gradient_force = train.gradient_force_n * train.moving_share
    row.motor_current = motor_current(current, kind.current_model)
    row.pantograph_real = state.flow.standing[at(k)].voltage_v.real
    row.pantograph_imag = state.flow.standing[at(k)].voltage_v.imag
    row.active_power = train.active_power_w
    row.reactive_power = train.reactive_power_var
    row.holding_time = train.hold_s
    if train.force_cap_n > 0.0:
        count_limits(train, kind, model, recording.counters)


@inlined
def current_limits(train: Any, kind: Any) -> bool:
    """Whether a limit of the line current is what keeps a train below wish and machine."""
    machine_n = max(0.0, train.machine_force_n)
    rim_n = machine_force(machine_n, train.resistance_n, kind.rotor_mass_kg, kind.inertia_kg)
    return bool(train.wheel_force_n < min(train.force_cap_n, max(0.0, rim_n)))


@inlined
def count_limits(train: Any, kind: Any, model: Model, counters: Indices) -> None:
    """Count where what describes a train is extrapolated or clipped, if its driver wants force."""
    machine, speed, voltage = model.machine[0], train.speed_m_s, train.voltage_v
    if effort_extrapolates(speed, voltage, kind, machine, model.points):
        counters[Counter.EFFORT_EXTRAPOLATED] += 1
    if train.machine_force_n < 0.0:
        counters[Counter.EFFORT_CLIPPED] += 1
    if kind.highest_line_current_a < math.inf and current_limits(train, kind):
        counters[Counter.CURRENT_LIMITED] += 1
    if train.force_n <= 0.0:
        return
    if outside_curve(speed, kind.efficiency, model.points):
        counters[Counter.EFFICIENCY_EXTRAPOLATED] += 1
    if kind.reactive_model == POWER_FACTOR_CURVE:
        if outside_curve(speed, kind.power_factor, model.points):
            counters[Counter.POWER_FACTOR_EXTRAPOLATED] += 1
        return
    if kind.reactive_model != DOUBLE_BRIDGE:
        if outside(speed, machine.power_factor, 0):
            counters[Counter.POWER_FACTOR_EXTRAPOLATED] += 1
        return
    motor_v = motor_voltage(
        speed, voltage, kind.base_speed_m_s, kind.highest_motor_voltage_v, kind.voltage_model
    )
    if bridge_outside_training(motor_v, voltage * TRANSFORMER_RATIO, machine.bridge_sine):
        counters[Counter.BRIDGE_EXTRAPOLATED] += 1
    if train.bridge_sine < 0.0 or train.bridge_sine > 1.0:
        counters[Counter.BRIDGE_CLIPPED] += 1


@inlined
def record_network(step: int, model: Model, state: State, recording: Recording) -> None:
    """Voltages of nodes, powers of stations, currents of branches and section ends, losses."""
    network, flow = model.network, state.flow
    for n in range(flow.nodes.size):
        recording.nodes[at(step), at(n)].node_real = flow.nodes[at(n)].voltage_v.real
        recording.nodes[at(step), at(n)].node_imag = flow.nodes[at(n)].voltage_v.imag
    for s in range(network.sources.size):
        row = recording.stations[at(step), at(s)]
        power = station_power(flow.nodes[at(network.sources[at(s)].node)])
        row.station_active_power = power.real
        row.station_reactive_power = power.imag
        row.active_converters = flow.sources[at(s)].converters
        rating_va = network.sources[at(s)].rating_va
        row.converter_loading = station_loading(power, flow.sources[at(s)].converters, rating_va)
    losses = 0.0
    for b in range(network.branches.size):
        branch = network.branches[at(b)]
        start, end = flow.nodes[at(branch.start_node)], flow.nodes[at(branch.end_node)]
        drop = start.voltage_v - end.voltage_v
        square = squared(drop) * squared(branch.admittance_s)
        recording.branch_current[at(step), at(b)] = math.sqrt(square)
        losses += square * branch.impedance_ohm.real
    lumped = network.branches.size
    for s in range(network.sections.size):
        found = flow.sections[at(s)]
        recording.branch_current[at(step), at(lumped + 2 * s)] = magnitude(found.current_a)
        recording.branch_current[at(step), at(lumped + 2 * s + 1)] = magnitude(found.end_current_a)
        losses += section_losses(s, model, state)
    recording.network_losses[at(step)] = losses


@inlined
def section_losses(s: int, model: Model, state: State) -> float:
    """Losses of a contact-line section, I²R piece by piece. [W]"""
    section, found, flow = model.network.sections[at(s)], state.flow.sections[at(s)], state.flow
    voltage, z = flow.nodes[at(section.start_node)].voltage_v, section.impedance_ohm_per_m
    sum_v2_per_m = 0.0
    for k in range(found.first, found.end + 1):
        if k < found.end:
            after, length_m = flow.standing[at(k)].voltage_v, flow.standing[at(k)].piece_m
        else:
            after, length_m = flow.nodes[at(section.end_node)].voltage_v, found.closing_m
        sum_v2_per_m += squared(voltage - after) / length_m
        voltage = after
    return sum_v2_per_m * z.real / squared(z)
