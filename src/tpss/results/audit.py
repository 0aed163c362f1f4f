r"""Every run audits itself: balances recomputed from what was recorded, by another way than solved.

The solver pushes voltages and currents along chains; the audit starts from the recorded voltages,
forms the current of every piece of line and every branch from the voltages at its ends (the nodal
admittance equations), and compares the powers that this asks for with the recorded ones.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from tpss.physics.constants import BASE_POWER_VA, BASE_VOLTAGE_V, GRAVITY_M_S2
from tpss.powerflow.network import SHORTEST_PIECE_M, TOLERANCE, Network, resolution_va
from tpss.powerflow.newton import HIGHEST_VOLTAGE, LOWEST_VOLTAGE
from tpss.results.audit_of_braking import braking_motion_error_m, braking_work
from tpss.simulation.run import Outcome
from tpss.simulation.state import (
    AGGRESSIVE,
    STATE_ARRIVED,
    STATE_BRAKING,
    STATE_COASTING,
    STATE_MOTORING,
    WITHIN_STEP,
    Model,
)

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]

JUDGED_VA = 10.0 * TOLERANCE * BASE_POWER_VA
"""Power mismatch that is judged, an order above the solver's tolerance. [VA]"""

LIMITS = {
    "power_mismatch_va": JUDGED_VA,
    "converter_residual": 1e-9,
    "network_balance": 1e-9,
    "traction_balance": 1e-9,
    "force_balance": 1e-9,
    "motion_error_m": 1e-6,
    "stop_error_m": 1e-3,
}
"""Highest value that each figure of a sound run may have; see `limits_of`."""


@dataclass(frozen=True)
class Audit:
    """Figures of a run's audit, and what is wrong with them.

    Attributes
    ----------
    power_mismatch_va : float
        Largest power mismatch over nodes, trains and steps. [VA]
    converter_residual : float
        Largest residual of the converters' voltage [p.u.] and angle [rad].
    network_balance : float
        Energy of the stations less that of the trains and losses, relative to the first. [1]
    traction_balance : float
        Work of the motors less resistance, climb, kinetic energy and brakes, relative. [1]
    force_balance : float
        Largest difference between the forces on a train and its mass times acceleration, relative to
        its weight. [1]
    motion_error_m : float
        Largest difference between a train's way in a step and that of its speeds. [m]
    stop_error_m : float
        Largest distance between where a braking plan ended and its stop. [m]
    lowest_voltage_v, highest_voltage_v : float
        Range of all voltages at pantographs and contact-line nodes, if there are any. [V]
    failures : tuple of str
        Figures beyond their limits, in words; empty for a sound run.
    """

    power_mismatch_va: float
    converter_residual: float
    network_balance: float
    traction_balance: float
    force_balance: float
    motion_error_m: float
    stop_error_m: float
    lowest_voltage_v: float | None
    highest_voltage_v: float | None
    failures: tuple[str, ...]

    @property
    def passed(self) -> bool:
        """Whether every figure is within its limit."""
        return not self.failures

    def as_dict(self) -> dict[str, Any]:
        """The figures by name."""
        return {**vars(self), "failures": list(self.failures), "passed": self.passed}


def audit(outcome: Outcome, model: Model, node_level: Floats) -> Audit:
    """Audit a run.

    Parameters
    ----------
    outcome : Outcome
    model : Model
    node_level : Floats, shape (nodes,)
        Own voltage of each node over that of the contact line; nodes at another level do not count
        for the voltage range.
    """
    trains, nodes = outcome.recording.trains, outcome.recording.nodes
    at_line_level = phasors(nodes, "node")[:, node_level == 1.0]
    phasor = np.concatenate([phasors(trains, "pantograph").ravel(), at_line_level.ravel()])
    voltages = np.sqrt(phasor.real**2 + phasor.imag**2)
    voltages = voltages[np.isfinite(voltages)]
    figures: dict[str, float] = {
        "power_mismatch_va": power_mismatch_va(outcome, model.network),
        "converter_residual": converter_residual(outcome, model.network),
        "network_balance": network_balance(outcome, model.options.step_s),
        "traction_balance": traction_balance(outcome, model),
        "force_balance": force_balance(outcome, model),
        "motion_error_m": motion_error_m(outcome, model),
        "stop_error_m": float(outcome.state.clock[0].stop_error_m),
    }
    lowest = float(voltages.min()) if voltages.size else None
    highest = float(voltages.max()) if voltages.size else None
    return judge(figures, lowest, highest, limits_of(model))


def judge(
    figures: dict[str, float],
    lowest: float | None,
    highest: float | None,
    limits: dict[str, float],
) -> Audit:
    """An audit from its figures, the range of voltages if there are any, and the limits."""
    failures = (*_beyond_limits(figures, limits), *_out_of_range(lowest, highest))
    return Audit(**figures, lowest_voltage_v=lowest, highest_voltage_v=highest, failures=failures)


def limits_of(model: Model) -> dict[str, float]:
    """Limits of the figures that are judged in a run of this model.

    Over impedances of some microohms, a few metres of line, rounding alone is a visible mismatch; the
    limits of what it touches follow it, and a train between two pieces of line meets the roundings of
    both.  A traction balance billed at the start of a step, or with what slip wastes, does not close,
    and is not judged.
    """
    limits = dict(LIMITS)
    blurred = model.network.tolerance / TOLERANCE
    shortest_ohm = np.abs(model.network.sections["impedance_ohm_per_m"]).min() * SHORTEST_PIECE_M
    limits["power_mismatch_va"] *= max(blurred, 2.0 * resolution_va(shortest_ohm) / JUDGED_VA)
    limits["converter_residual"] *= blurred
    limits["network_balance"] *= blurred
    if not model.options.mean_power or model.options.driver == AGGRESSIVE:
        del limits["traction_balance"]
    return limits


def _beyond_limits(figures: dict[str, float], limits: dict[str, float]) -> list[str]:
    return [
        f"{name} is {figures[name]:.3g}, limit {limit:g}"
        for name, limit in limits.items()
        if not figures[name] <= limit
    ]


def _out_of_range(lowest_v: float | None, highest_v: float | None) -> list[str]:
    low, high = LOWEST_VOLTAGE * BASE_VOLTAGE_V, HIGHEST_VOLTAGE * BASE_VOLTAGE_V
    if lowest_v is None or highest_v is None or (low <= lowest_v and highest_v <= high):
        return []
    return [f"voltages leave the range of {low:g} to {high:g} V"]


def phasors(rows: Any, place: str) -> Complexes:
    """Recorded voltages of trains ("pantograph") or nodes ("node"). [V]"""
    return np.asarray(rows[f"{place}_real"] + 1j * rows[f"{place}_imag"], dtype=complex)


def _largest(values: npt.NDArray[Any]) -> float:
    """Largest magnitude; NaN, which no limit admits, if one of the values is NaN."""
    return float(np.abs(values).max(initial=0.0))


def _kinds(outcome: Outcome, model: Model) -> Any:
    """Kind of each train."""
    return model.types[np.array([train.train_type for train in outcome.trains], dtype=int)]


def _nan_is_largest(value: float) -> float:
    return np.inf if np.isnan(value) else value


def power_mismatch_va(outcome: Outcome, network: Network) -> float:
    """Largest mismatch between recorded powers and those that the recorded voltages ask for. [VA]

    References
    ----------
    [Boullanger2009]_, eq. (F.35)-(F.38).
    """
    if outcome.steps == 0:
        return 0.0
    rows = slice(0, outcome.steps)
    trains, nodes = outcome.recording.trains[rows], outcome.recording.nodes[rows]
    stations = outcome.recording.stations[rows]
    train_v, node_v = phasors(trains, "pantograph"), phasors(nodes, "node")
    train_a, leaving_a = _contact_line_currents(trains["position"], train_v, node_v, network)
    for branch in network.branches:
        current = node_v[:, branch.start_node] - node_v[:, branch.end_node]
        current = current / branch.impedance_ohm
        leaving_a[:, branch.start_node] += current
        leaving_a[:, branch.end_node] -= current
    fed = np.zeros_like(node_v)
    fed[:, network.sources.node] = (
        stations["station_active_power"] + 1j * stations["station_reactive_power"]
    )
    on_line = outcome.recording.train_state[rows] >= 0
    on_line &= outcome.recording.train_state[rows] != STATE_ARRIVED
    drawn = trains["active_power"] + 1j * trains["reactive_power"]
    return max(
        _largest(node_v * leaving_a.conj() - fed),
        _largest((train_v * train_a.conj() - drawn)[on_line]),
        key=_nan_is_largest,
    )


def _contact_line_currents(
    position_m: Floats, train_v: Complexes, node_v: Complexes, network: Network
) -> tuple[Complexes, Complexes]:
    """Current into each train, and current that leaves each node into the contact line. [A]

    All points of the line (nodes and trains) are sorted by position at every instant; a node comes
    before a train at the same place, but the line's last node comes after it.
    """
    sections = network.sections
    line_nodes = np.append(sections.start_node, sections.end_node[-1])
    node_m = np.append(sections.start_m, sections.end_m[-1])
    steps, count = position_m.shape
    node_keys = np.tile(node_m, (steps, 1))
    train_keys = np.where(np.isfinite(train_v), position_m, np.inf)
    keys = np.concatenate([node_keys[:, :-1], train_keys, node_keys[:, -1:]], axis=1)
    volts = np.concatenate(
        [node_v[:, line_nodes[:-1]], train_v, node_v[:, line_nodes[-1:]]], axis=1
    )
    order = np.argsort(keys, axis=1, kind="stable")
    keys, volts = np.take_along_axis(keys, order, 1), np.take_along_axis(volts, order, 1)
    is_node = (order < len(line_nodes) - 1) | (order == keys.shape[1] - 1)
    section = np.clip(np.cumsum(is_node, axis=1)[:, :-1] - 1, 0, len(sections) - 1)
    on_line = np.isfinite(keys[:, 1:])
    ahead_m = np.where(on_line, keys[:, 1:], 0.0) - np.where(on_line, keys[:, :-1], 0.0)
    length_m = np.maximum(SHORTEST_PIECE_M, ahead_m)
    impedance = sections.impedance_ohm_per_m[section] * length_m
    half_shunt = 0.5j * sections.susceptance_s_per_m[section] * length_m
    current = np.where(on_line, (volts[:, :-1] - volts[:, 1:]) / impedance, 0.0)
    shunt = np.where(on_line, half_shunt, 0.0)
    leaving = np.zeros_like(volts)
    leaving[:, :-1] += current + shunt * volts[:, :-1]
    leaving[:, 1:] += shunt * volts[:, 1:] - current
    unsorted = np.zeros_like(leaving)
    np.put_along_axis(unsorted, order, leaving, 1)
    leaving_nodes = np.zeros_like(node_v)
    leaving_nodes[:, line_nodes[:-1]] = unsorted[:, : len(line_nodes) - 1]
    leaving_nodes[:, line_nodes[-1]] = unsorted[:, -1]
    return -unsorted[:, len(line_nodes) - 1 : len(line_nodes) - 1 + count], leaving_nodes


def converter_residual(outcome: Outcome, network: Network) -> float:
    """Largest residual of the converters' equations, voltage in p.u. and angle in rad.

    References
    ----------
    [Boullanger2009]_, eq. (2.1)-(2.4).
    """
    rows = slice(0, outcome.steps)
    stations, nodes = outcome.recording.stations[rows], outcome.recording.nodes[rows]
    law = network.sources
    p, q = stations["station_active_power"], stations["station_reactive_power"]
    n = stations["active_converters"]
    voltage = law.no_load_voltage_v - law.droop_v_per_var * q / n
    square = law.motor_voltage_v**2
    q50 = law.grid_reactive_power_var
    grid = np.arctan(law.grid_reactance_ohm * p / (square + law.grid_reactance_ohm * q50)) / 3
    x_motor, x_generator = law.motor_reactance_ohm / n, law.generator_reactance_ohm / n
    motor = np.arctan(x_motor * p / (square + x_motor * q50)) / 3
    generator = np.arctan(x_generator * p / (voltage**2 + x_generator * q))
    angle = law.grid_angle_rad - grid - motor - generator
    node_v = phasors(nodes, "node")[:, law.node]
    return max(
        _largest((np.abs(node_v) - voltage) / BASE_VOLTAGE_V),
        _largest(np.angle(node_v) - angle),
        key=_nan_is_largest,
    )


def network_balance(outcome: Outcome, step_s: float) -> float:
    """Relative difference between the stations' energy and that of trains and losses. [1]"""
    recording = outcome.recording
    fed = np.nansum(recording.stations["station_active_power"]) * step_s
    drawn = np.nansum(recording.trains["active_power"]) * step_s
    lost = np.nansum(recording.network_losses) * step_s
    # Relative to at least a megawatt on average: of that, the solver's tolerance is the limit.
    least = TOLERANCE * BASE_POWER_VA / LIMITS["network_balance"] * step_s * max(outcome.steps, 1)
    return float(abs(fed - drawn - lost) / max(abs(fed), least))


def traction_balance(outcome: Outcome, model: Model) -> float:
    """Relative difference between the motors' work and where it went. [1]

    The motors' work is that of the recorded electric power; it goes into slip, the rotors, running
    resistance, climb, kinetic energy and brakes.
    """
    trains, h = outcome.recording.trains, model.options.step_s
    kind = _kinds(outcome, model)
    before, after = trains[:-1], trains[1:]
    # Not the difference of positions, which would round a short way of a train far along the line.
    way_m = h * (before["speed"] + after["speed"]) / 2.0
    efficiency = _efficiency(before["speed"], kind, model.points)
    power_w = (before["active_power"] - kind.auxiliary_power_w) * efficiency
    work = power_w * h / kind.slip_factor
    force = before["tractive_force"]
    rotor = np.where(
        force > 0.0, np.maximum(-force, kind.rotor_mass_kg * before["acceleration"]), 0.0
    )
    opposing = before["running_resistance"] + before["gradient_force"] + before["braking_force"]
    moving = np.where(way_m > 0.0, (rotor + opposing) * way_m, 0.0)
    moving = np.where(before["holding_time"] > 0.0, braking_work(before, after, kind, h), moving)
    kinetic = kind.inertia_kg / 2.0 * (after["speed"] ** 2 - before["speed"] ** 2)
    difference = np.nansum(work) - np.nansum(moving) - np.nansum(kinetic)
    # Where the motors do no work, gravity and the trains' own motion turn over the energy.
    fallen = -np.nansum(np.minimum(before["gradient_force"], 0.0) * way_m)
    slowed = -np.nansum(np.minimum(kinetic, 0.0))
    return float(abs(difference) / max(np.nansum(work) + fallen + slowed, 1.0))


def _efficiency(speed: Floats, kind: Any, points: Any) -> Floats:
    """Efficiency of each train at its speeds, shape (steps, trains). [1]"""
    found = np.empty_like(speed)
    for i, curve in enumerate(kind.efficiency):
        own = points[curve.first : curve.first + curve.points]
        found[:, i] = _curve(speed[:, i], own) if curve.points > 1 else own.value[0]
    return found


def _curve(x: Floats, points: Any) -> Floats:
    """Values of a curve, written as Hermite's basis functions; beyond its ends the outer ones."""
    x = np.clip(x, points.at[0], points.at[-1])
    k = np.clip(np.searchsorted(points.at, x, side="right") - 1, 0, points.size - 2)
    before, after = points[k], points[k + 1]
    step = after.at - before.at
    t = (x - before.at) / step
    values = before.value * (1 + 2 * t) * (1 - t) ** 2 + after.value * t**2 * (3 - 2 * t)
    slopes = before.slope * t * (1 - t) ** 2 - after.slope * t**2 * (1 - t)
    return np.asarray(values + step * slopes, dtype=float)


def force_balance(outcome: Outcome, model: Model) -> float:
    """Largest |F - F_res - F_brake - M a| of a moving train, relative to its weight. [1]

    References
    ----------
    [Boullanger2009]_, eq. (2.11) and (F.19).
    """
    rows = slice(0, outcome.steps)
    trains, state = outcome.recording.trains[rows], outcome.recording.train_state[rows]
    kind = _kinds(outcome, model)
    rest = trains["tractive_force"] - trains["braking_force"]
    rest = rest - trains["running_resistance"] - trains["gradient_force"]
    inertia_kg = np.broadcast_to(kind.inertia_kg, state.shape)
    if model.options.driver == AGGRESSIVE:
        inertia_kg = np.where(state == STATE_COASTING, kind.coasting_inertia_kg, inertia_kg)
    rest = rest - inertia_kg * trains["acceleration"]
    driven = (state == STATE_MOTORING) | (state == STATE_COASTING) | (state == STATE_BRAKING)
    return _largest((rest / (kind.mass_kg * GRAVITY_M_S2))[driven])


def motion_error_m(outcome: Outcome, model: Model) -> float:
    """Largest |x' - x - h (v + v')/2|, and |v' - v - a h| h, of a train. [m]

    Braking within steps has `braking_motion_error_m` in place of the first.

    References
    ----------
    [Boullanger2009]_, implied by eq. (2.29) and (2.30).
    """
    trains, step_s = outcome.recording.trains, model.options.step_s
    before, after = trains[:-1], trains[1:]
    # Present at both instants; positions that are not numbers stay, and fail.
    both = (outcome.recording.train_state[:-1] >= 0) & (
        outcome.recording.train_state[:-1] != STATE_ARRIVED
    )
    way = after["position"] - before["position"]
    way = way - step_s * (before["speed"] + after["speed"]) / 2.0
    if model.options.braking == WITHIN_STEP:
        way = braking_motion_error_m(before, after, _kinds(outcome, model), step_s)
    speed = after["speed"] - before["speed"] - step_s * before["acceleration"]
    return max(_largest(way[both]), _largest(speed[both]) * step_s, key=_nan_is_largest)
