"""The audit's figures: balances recomputed from what was recorded, by another way than solved.

The solver pushes voltages and currents along chains; the audit starts from the recorded voltages, forms
the current of every piece of line and every branch from the voltages at its ends (the nodal admittance
equations), and compares the powers that this asks for with the recorded ones.
"""

import math
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.kernel import blank_records, inlined, kernel
from tpss.physics.constants import BASE_POWER_VA, BASE_VOLTAGE_V, GRAVITY_M_S2
from tpss.physics.curve import curve_at
from tpss.powerflow.network import SHORTEST_PIECE_M, TOLERANCE
from tpss.powerflow.pairs import magnitude, scaled, squared
from tpss.simulation.state import (
    AGGRESSIVE,
    STATE_ARRIVED,
    STATE_BRAKING,
    STATE_COASTING,
    STATE_MOTORING,
    WITHIN_STEP,
    Model,
    Recording,
)

BALANCES = np.dtype(
    [
        ("power_mismatch_va", float),
        ("converter_residual", float),
        ("network_balance", float),
        ("traction_balance", float),
        ("force_balance", float),
        ("motion_error_m", float),
        ("fed_j", float),  # sums, from which the balances follow
        ("drawn_j", float),
        ("lost_j", float),
        ("work_j", float),
        ("moving_j", float),
        ("kinetic_j", float),
        ("fallen_j", float),
        ("slowed_j", float),
    ],
    align=True,
)
"""Figures of an audit, and what they are made of."""


class Scratch(NamedTuple):
    """Room to work in, and the result."""

    balances: Any
    """One record of `BALANCES`."""
    leaving_a: npt.NDArray[np.complex128]
    """Current that leaves each node into contact line and branches. [A]"""
    node_v: npt.NDArray[np.complex128]
    order: npt.NDArray[np.int64]
    """Trains on the line by position."""


def new_scratch(nodes: int, trains: int) -> Scratch:
    """Scratch for so many nodes and trains."""
    return Scratch(
        balances=blank_records(1, BALANCES),
        leaving_a=np.zeros(nodes, dtype=complex),
        node_v=np.zeros(nodes, dtype=complex),
        order=np.arange(trains),
    )


@kernel
def worst(found: float, value: float) -> float:
    """The larger magnitude; NaN, which no limit admits, once there has been one."""
    size = abs(value)
    return found if found >= size or math.isnan(found) else size


@inlined
def audit_run(
    steps: int, types_of: Any, model: Model, recording: Recording, scratch: Scratch
) -> None:
    """Audit a recording; the figures are left in ``scratch.balances``.

    Parameters
    ----------
    steps : int
        Steps carried out.
    types_of : records of `TRAIN`
        The trains, for their types.
    model, recording : Model, Recording
    scratch : Scratch
        As from `new_scratch`, with as many trains as count.
    """
    figures, h = scratch.balances[0], model.options.step_s
    for step in range(steps):
        _audit_network(step, model, recording, scratch)
        _audit_stations(step, model, recording, scratch)
        figures.lost_j += recording.network_losses[step] * h
        for i in range(scratch.order.size):
            state = recording.train_state[step, i]
            if state >= 0 and state != STATE_ARRIVED:
                kind = model.types[types_of[i].train_type]
                _audit_train(step, i, kind, model, recording, figures)
    least = TOLERANCE * BASE_POWER_VA / 1e-9 * h * max(steps, 1)
    gap = abs(figures.fed_j - figures.drawn_j - figures.lost_j)
    figures.network_balance = gap / max(abs(figures.fed_j), least)
    gap = abs(figures.work_j - figures.moving_j - figures.kinetic_j)
    turned_over = figures.work_j + figures.fallen_j + figures.slowed_j
    figures.traction_balance = gap / max(turned_over, 1.0)


@inlined
def _audit_network(step: int, model: Model, recording: Recording, scratch: Scratch) -> None:
    """Power mismatch of every node and train in a step.

    References
    ----------
    [Boullanger2009]_, eq. (F.35)-(F.38).
    """
    network, figures = model.network, scratch.balances[0]
    for n in range(scratch.node_v.size):
        row = recording.nodes[step, n]
        scratch.node_v[n] = complex(row.node_real, row.node_imag)
        scratch.leaving_a[n] = 0.0
    for b in range(network.branches.size):
        branch = network.branches[b]
        drop = scratch.node_v[branch.start_node] - scratch.node_v[branch.end_node]
        current = drop / branch.impedance_ohm
        scratch.leaving_a[branch.start_node] += current
        scratch.leaving_a[branch.end_node] -= current
    count = _sort_trains(step, recording, scratch.order)
    k = 0
    for s in range(network.sections.size):
        k = _audit_section(step, s, k, count, model, recording, scratch)
    for n in range(scratch.node_v.size):
        power = scratch.node_v[n] * scratch.leaving_a[n].conjugate()
        s = network.source_of_node[n]
        if s >= 0:
            row = recording.stations[step, s]
            power -= complex(row.station_active_power, row.station_reactive_power)
        figures.power_mismatch_va = worst(figures.power_mismatch_va, magnitude(power))


@inlined
def _sort_trains(step: int, recording: Recording, order: Any) -> int:
    """Bring the trains on the line to the front of `order`; return their number.

    They stand by position, and at the same place by number.
    """
    count = 0
    for k in range(order.size):
        i = order[k]
        state = recording.train_state[step, i]
        if state >= 0 and state != STATE_ARRIVED:
            order[k], order[count] = order[count], i
            count += 1
    for k in range(1, count):
        i, at = order[k], k
        position = recording.trains[step, i].position
        while at > 0:
            j = order[at - 1]
            other = recording.trains[step, j].position
            if other < position or (other == position and j < i):
                break
            order[at] = j
            at -= 1
        order[at] = i
    return count


@inlined
def _audit_section(
    step: int, s: int, first: int, count: int, model: Model, recording: Recording, scratch: Scratch
) -> int:
    """Mismatch of a section's trains, and its part of what leaves its nodes; return the next train.

    Trains at the place of a section's end belong to the next one, if there is one.
    """
    section, figures = model.network.sections[s], scratch.balances[0]
    is_last, z = s == model.network.sections.size - 1, section.impedance_ohm_per_m
    voltage, place_m = scratch.node_v[section.start_node], section.start_m
    entering = complex(0.0, 0.0)  # into the point before, through the piece before
    at_node = True
    k = first
    while True:
        more = k < count
        if more:
            row = recording.trains[step, scratch.order[k]]
            more = is_last or row.position < section.end_m
        if more:
            ahead = complex(row.pantograph_real, row.pantograph_imag)
            ahead_m = row.position
        else:
            ahead, ahead_m = scratch.node_v[section.end_node], section.end_m
        length_m = max(SHORTEST_PIECE_M, ahead_m - place_m)
        current = scaled((voltage - ahead) * z.conjugate(), 1.0 / (squared(z) * length_m))
        shunt = complex(0.0, 0.5 * section.susceptance_s_per_m * length_m)
        leaving = current + shunt * voltage
        if at_node:
            scratch.leaving_a[section.start_node] += leaving
        else:
            _audit_demand(
                step, scratch.order[k - 1], voltage, entering - leaving, recording, figures
            )
        entering = current - shunt * ahead
        if not more:
            scratch.leaving_a[section.end_node] -= entering
            return k
        voltage, place_m, at_node = ahead, ahead_m, False
        k += 1


@inlined
def _audit_demand(
    step: int, i: int, voltage: complex, current: complex, recording: Recording, figures: Any
) -> None:
    """Mismatch between what a train draws and what flows into it."""
    row = recording.trains[step, i]
    drawn = complex(row.active_power, row.reactive_power)
    mismatch = magnitude(voltage * current.conjugate() - drawn)
    figures.power_mismatch_va = worst(figures.power_mismatch_va, mismatch)


@inlined
def _audit_stations(step: int, model: Model, recording: Recording, scratch: Scratch) -> None:
    """Residual of the converters' voltage [p.u.] and angle [rad], and the energy fed.

    References
    ----------
    [Boullanger2009]_, eq. (2.1)-(2.4).
    """
    figures = scratch.balances[0]
    for s in range(model.network.sources.size):
        law, row = model.network.sources[s], recording.stations[step, s]
        p, q, n = row.station_active_power, row.station_reactive_power, row.active_converters
        figures.fed_j += p * model.options.step_s
        voltage = law.no_load_voltage_v - law.droop_v_per_var * q / n
        square = law.motor_voltage_v**2
        q50, x50 = law.grid_reactive_power_var, law.grid_reactance_ohm
        grid = math.atan(x50 * p / (square + x50 * q50)) / 3.0
        x_motor, x_generator = law.motor_reactance_ohm / n, law.generator_reactance_ohm / n
        motor = math.atan(x_motor * p / (square + x_motor * q50)) / 3.0
        generator = math.atan(x_generator * p / (voltage * voltage + x_generator * q))
        node = recording.nodes[step, law.node]
        off = (magnitude(complex(node.node_real, node.node_imag)) - voltage) / BASE_VOLTAGE_V
        figures.converter_residual = worst(figures.converter_residual, off)
        off = math.atan2(node.node_imag, node.node_real) - (
            law.grid_angle_rad - grid - motor - generator
        )
        figures.converter_residual = worst(figures.converter_residual, off)


@inlined
def _audit_train(
    step: int, i: int, kind: Any, model: Model, recording: Recording, figures: Any
) -> None:
    """Add a train's step to the balances of energy, force and motion.

    References
    ----------
    [Boullanger2009]_, eq. (2.11), (F.19), (2.29) and (2.30).
    """
    before, after = recording.trains[step, i], recording.trains[step + 1, i]
    h = model.options.step_s
    figures.drawn_j += before.active_power * h
    # Not the difference of positions, which would round a short way of a train far along the line.
    way_m = h * (before.speed + after.speed) / 2.0
    efficiency = curve_at(before.speed, kind.efficiency.first, kind.efficiency.points, model.points)
    power_w = (before.active_power - kind.auxiliary_power_w) * efficiency
    figures.work_j += power_w * h / kind.slip_factor
    force, rotor = before.tractive_force, 0.0
    if force > 0.0:
        rotor = max(-force, kind.rotor_mass_kg * before.acceleration)
    opposing = before.running_resistance + before.gradient_force + before.braking_force
    if before.holding_time > 0.0:
        figures.moving_j += _braking_work(before, after.speed, kind, h)
    elif way_m > 0.0:
        figures.moving_j += (rotor + opposing) * way_m
    kinetic = kind.inertia_kg / 2.0 * (after.speed * after.speed - before.speed * before.speed)
    figures.kinetic_j += kinetic
    figures.fallen_j -= min(before.gradient_force, 0.0) * way_m
    figures.slowed_j -= min(kinetic, 0.0)
    _audit_motion(step, i, kind, model, recording, figures)


@inlined
def _braking_work(before: Any, next_speed_m_s: float, kind: Any, step_s: float) -> float:
    """Work of resistances and brakes in a step that holds the speed, then brakes. [J]

    Of the resistances the mean over the step is recorded, for a part of which the train may stand.  To
    hold the speed downhill takes brakes; the rest of their recorded impulse slows the train down.
    """
    v, hold_s = before.speed, before.holding_time
    brake_s = (v - next_speed_m_s) / kind.highest_retardation_m_s2
    impulse_ns = step_s * (before.running_resistance + before.gradient_force)
    resistance_n = impulse_ns / (hold_s + brake_s)
    holding_ns = max(0.0, -resistance_n) * hold_s
    stopping_ns = before.braking_force * step_s - holding_ns
    while_holding = (resistance_n * hold_s + holding_ns) * v
    return while_holding + (resistance_n * brake_s + stopping_ns) * (v + next_speed_m_s) / 2.0


@inlined
def _braking_motion_error(before: Any, after: Any, kind: Any, step_s: float) -> float:
    """Difference between a step's movement and that of its speeds, where trains brake within steps. [m]

    A step that holds the speed v for τ, then brakes with b, goes v τ + (v² - v'²)/2b; together that
    takes the whole step, or less of it if the train stops.  A step without τ is a uniform one, but that
    a train may come to its stop in any part of it: it goes no less than with b, and no further than
    uniformly.
    """
    v, w, hold_s = before.speed, after.speed, before.holding_time
    way_m = after.position - before.position
    brake_s = (v - w) / kind.highest_retardation_m_s2
    uniform_m = step_s * (v + w) / 2.0
    if hold_s > 0.0:
        over_s = hold_s + brake_s - step_s
        over_s = abs(over_s) if w > 0.0 else max(0.0, over_s)
        return abs(way_m - v * hold_s - (v + w) / 2.0 * brake_s) + v * over_s
    if w == 0.0 and v > 0.0:
        shortest_m = min(uniform_m, v / 2.0 * brake_s)
        return way_m - min(max(way_m, shortest_m), uniform_m)
    return way_m - uniform_m


@inlined
def _audit_motion(
    step: int, i: int, kind: Any, model: Model, recording: Recording, figures: Any
) -> None:
    """Note how far a train is off the equations of force and motion in a step."""
    before, after = recording.trains[step, i], recording.trains[step + 1, i]
    h = model.options.step_s
    if model.options.braking == WITHIN_STEP:
        way = _braking_motion_error(before, after, kind, h)
    else:
        way = after.position - before.position - h * (before.speed + after.speed) / 2.0
    figures.motion_error_m = worst(figures.motion_error_m, way)
    change = after.speed - before.speed - h * before.acceleration
    figures.motion_error_m = worst(figures.motion_error_m, change * h)
    state = recording.train_state[step, i]
    if state in (STATE_MOTORING, STATE_COASTING, STATE_BRAKING):
        inertia_kg = kind.inertia_kg
        if model.options.driver == AGGRESSIVE and state == STATE_COASTING:
            inertia_kg = kind.coasting_inertia_kg
        rest = before.tractive_force - before.braking_force - before.running_resistance
        rest -= before.gradient_force + inertia_kg * before.acceleration
        figures.force_balance = worst(figures.force_balance, rest / (kind.mass_kg * GRAVITY_M_S2))
