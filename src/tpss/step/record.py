"""Keep everything: states at the instants, forces and powers over the intervals between them."""

import math

from tpss.kernel import at, inlined, kernel
from tpss.numerics.curve import outside_curve
from tpss.numerics.neural_network import outside
from tpss.numerics.pairs import magnitude, squared
from tpss.physics.locomotive import machine_force
from tpss.physics.motor import MotorModel, line_voltage_factor, motor_current, motor_voltage
from tpss.physics.reactive_power import ReactiveModel, bridge_outside_training
from tpss.record import Records
from tpss.sources.kinds import loading, losses
from tpss.step.converter_control import station_power
from tpss.step.model import Model
from tpss.step.recording import Indices, Recording
from tpss.step.state import Counter, State, TrainState
from tpss.vehicle.demand import armature_demand
from tpss.vehicle.effort.kinds import effort_extrapolates
from tpss.vehicle.terms import Demand
from tpss.vehicle.train import Journey, Phase, Train, is_on_line
from tpss.vehicle.train_type import TrainType


@inlined
def note_journey(train: Train, row: Journey) -> None:
    """Keep how a train would continue; copying a whole record at once takes seconds to compile."""
    motion, plan = row.motion, row.plan
    motion.phase = train.motion.phase
    motion.position_m = train.motion.position_m
    motion.speed_m_s = train.motion.speed_m_s
    motion.gradient = train.motion.gradient
    motion.next_stop = train.motion.next_stop
    motion.dwell_steps_left = train.motion.dwell_steps_left
    plan.step = train.plan.step
    plan.hold_steps = train.plan.hold_steps
    plan.first = train.plan.first
    plan.full_steps = train.plan.full_steps
    plan.last = train.plan.last


@kernel
def record_instant(step: int, trains: Records[Train], recording: Recording) -> None:
    """Position and speed of every train on the line, those that have just arrived included."""
    for i in range(trains.size):
        train = trains[at(i)]
        motion, arrived = train.motion, train.motion.phase == Phase.ARRIVED
        if is_on_line(motion.phase) or arrived:
            recording.trains[at(step), at(i)].position = motion.position_m
            recording.trains[at(step), at(i)].speed = motion.speed_m_s
            if arrived:
                recording.train_state[at(step), at(i)] = TrainState.ARRIVED
            if recording.journeys.size > 0:
                note_journey(train, recording.journeys[at(step), at(i)])


@inlined
def state_code(train: Train) -> TrainState:
    """Code of `train_state` of a train on the line."""
    if train.motion.phase == Phase.DWELLING:
        return TrainState.DWELLING
    if train.forces.braking_n > 0.0:  # in a step that holds the speed first there is both
        return TrainState.BRAKING
    return TrainState.MOTORING if train.forces.tractive_n > 0.0 else TrainState.COASTING


@inlined
def record_train(step: int, k: int, model: Model, state: State, recording: Recording) -> None:
    """Forces, voltage and powers of the `k`-th train along the line."""
    i = state.flow.standing[at(k)].train
    train, row = state.trains[at(i)], recording.trains[at(step), at(i)]
    kind, demand, forces = model.types[at(train.train_type)], train.demand, train.forces
    moving_share, voltage = train.decision.moving_share, state.flow.standing[at(k)].voltage_v
    current, _ = armature_demand(demand.wheel_force_n, 0.0, kind, demand)
    if kind.voltage_model != MotorModel.NEW:
        current /= line_voltage_factor(demand.voltage_v, kind.voltage_model)
    recording.train_state[at(step), at(i)] = state_code(train)
    row.acceleration = (forces.next_speed_m_s - train.motion.speed_m_s) / model.options.step_s
    row.tractive_force = forces.tractive_n
    row.braking_force = forces.braking_n
    row.running_resistance = forces.running_resistance_n * moving_share
    row.gradient_force = forces.gradient_n * moving_share
    row.motor_current = motor_current(current, kind.current_model)
    row.pantograph_real = voltage.real
    row.pantograph_imag = voltage.imag
    row.active_power = demand.active_power_w
    row.reactive_power = demand.reactive_power_var
    row.holding_time = train.decision.hold_s
    if demand.force_cap_n > 0.0:
        count_limits(forces.tractive_n, kind, demand, model, recording.counters)


@inlined
def current_limits(kind: TrainType, demand: Demand) -> bool:
    """Whether a limit of the line current is what keeps a train below its driver and its machine."""
    machine_n = max(0.0, demand.machine_force_n)
    rim_n = machine_force(machine_n, demand.resistance_n, kind.rotor_mass_kg, kind.inertia_kg)
    return bool(demand.wheel_force_n < min(demand.force_cap_n, max(0.0, rim_n)))


@inlined
def count_limits(
    force_n: float, kind: TrainType, demand: Demand, model: Model, counters: Indices
) -> None:
    """Count where what describes a train is extrapolated or clipped, if its driver wants force."""
    speed, voltage, networks = demand.speed_m_s, demand.voltage_v, kind.networks
    network = networks.tractive_effort
    if effort_extrapolates(speed, voltage, kind.effort, network, model.points):
        counters[Counter.EFFORT_EXTRAPOLATED] += 1
    if demand.machine_force_n < 0.0:
        counters[Counter.EFFORT_CLIPPED] += 1
    if kind.line_current.highest_current_a < math.inf and current_limits(kind, demand):
        counters[Counter.CURRENT_LIMITED] += 1
    if force_n <= 0.0:
        return
    if outside_curve(speed, kind.efficiency, model.points):
        counters[Counter.EFFICIENCY_EXTRAPOLATED] += 1
    if kind.reactive_model == ReactiveModel.POWER_FACTOR_CURVE:
        if outside_curve(speed, kind.power_factor, model.points):
            counters[Counter.POWER_FACTOR_EXTRAPOLATED] += 1
        return
    if kind.reactive_model != ReactiveModel.DOUBLE_BRIDGE:
        if outside(speed, networks.power_factor, 0):
            counters[Counter.POWER_FACTOR_EXTRAPOLATED] += 1
        return
    motor_v = motor_voltage(
        speed, voltage, kind.base_speed_m_s, kind.highest_motor_voltage_v, kind.voltage_model
    )
    if bridge_outside_training(motor_v, voltage * kind.transformer_ratio, networks.bridge_sine):
        counters[Counter.BRIDGE_EXTRAPOLATED] += 1
    if demand.bridge_sine < 0.0 or demand.bridge_sine > 1.0:
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
        source = network.sources[at(s)]
        node, running = flow.nodes[at(source.node)], flow.sources[at(s)].running
        power = station_power(node)
        row.station_active_power = power.real
        row.station_reactive_power = power.imag
        row.active_converters = running
        row.converter_loading = loading(power, running, source.rating_va)
        row.station_losses = losses(node.leaving_current_a, running, source)
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
        lost_w += section_losses(s, model, state)
    recording.network_losses[at(step)] = lost_w


@inlined
def section_losses(s: int, model: Model, state: State) -> float:
    """Losses of a contact-line section, I²R piece by piece. [W]"""
    section, solution, flow = model.network.sections[at(s)], state.flow.sections[at(s)], state.flow
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
