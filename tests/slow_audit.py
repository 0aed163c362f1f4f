"""The audit of `tpss.audit` once more, in array operations over all steps at once.

The solver pushes voltages and currents along chains; the audit starts from the recorded voltages,
forms the current of every piece of line and every branch from the voltages at its ends (the nodal
admittance equations), and compares the powers that this asks for with the recorded ones.
"""

import math
from typing import Any

import numpy as np
import numpy.typing as npt

import tpss
from tpss.audit.balances import ALLOWED_BALANCE
from tpss.audit.verdict import JUDGED, Audit, judge, limits_of, usual_limits
from tpss.driving.data import Braking, Driver, MotionModel
from tpss.physics.constants import GRAVITY_M_S2
from tpss.powerflow.groups import sections_of
from tpss.powerflow.network import SHORTEST_PIECE_M, TOLERANCE, UNFED, Network
from tpss.run.run import Outcome, advance_to_end, outcome_of, run_of
from tpss.sources.kinds import SourceKind
from tpss.step.model import Model
from tpss.step.state import TrainState

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]


OF_A_LIMIT = 1e-3
"""The audit's figures are themselves rounding errors, which another order of operations changes."""


def assert_agree(found: Audit, expected: Audit, limits: dict[str, float]) -> None:
    """Assert that two audits agree, as far as rounding errors can."""
    usual = usual_limits(10e6)
    for name in JUDGED:
        own, other = getattr(found, name), getattr(expected, name)
        # What is not judged may be large, and what a forgery has spoilt not a number.
        gap = OF_A_LIMIT * limits.get(name, usual[name]) + 1e-9 * abs(other)
        assert abs(own - other) <= gap or (math.isnan(own) and math.isnan(other)), name
    for name in ("lowest_voltage_v", "highest_voltage_v", "passed"):
        assert getattr(found, name) == getattr(expected, name), name


def audit_of(scenario: tpss.Scenario) -> tuple[Audit, dict[str, float]]:
    """Audit of the run of a scenario, and the limits by which it is judged."""
    prepared = tpss.prepare(scenario)
    start, model = prepared.start, prepared.start.model
    run = run_of(start, prepared.clock)
    outcome = outcome_of(run, advance_to_end(run, start), start.studied)
    return audit(outcome, model, np.array(prepared.layout.supply.node_level)), limits_of(model)


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
        "power_mismatch_va": power_mismatch_va(outcome, model),
        "converter_residual": converter_residual(outcome, model.network),
        "network_balance": network_balance(outcome, model),
        "traction_balance": traction_balance(outcome, model),
        "force_balance": force_balance(outcome, model),
        "motion_error_m": motion_error_m(outcome, model),
        "stop_error_m": float(outcome.state.clock[0].stop_error_m),
    }
    lowest = float(voltages.min()) if voltages.size else None
    highest = float(voltages.max()) if voltages.size else None
    return judge(figures, lowest, highest, limits_of(model), model.network.system)


def phasors(rows: Any, place: str) -> Complexes:
    """Recorded voltages of trains ("pantograph") or nodes ("node"). [V]"""
    return np.asarray(rows[f"{place}_real"] + 1j * rows[f"{place}_imag"], dtype=complex)


def _largest(values: npt.NDArray[Any]) -> float:
    """Largest magnitude; NaN, which no limit admits, if one of the values is NaN."""
    return float(np.abs(values).max(initial=0.0))


def _kinds(outcome: Outcome, model: Model) -> Any:
    """Kind of each train."""
    return model.types[np.array([train.train_type for train in outcome.trains], dtype=int)]


def legs_of(outcome: Outcome, model: Model) -> Any:
    """Leg of every train at every instant, shape (instants, trains)."""
    along_m = np.asarray(outcome.recording.trains["route_position"])
    found = np.empty(along_m.shape, dtype=model.legs.dtype)
    for i, train in enumerate(outcome.trains):
        for leg in model.legs[train.route]:
            found[:, i] = np.where(~(along_m[:, i] < leg.from_m), leg, found[:, i])
    return found


def sections_and_places(outcome: Outcome, model: Model) -> tuple[Any, Floats]:
    """Section above every train at every instant, and its place on the line. [m]"""
    legs, sections = legs_of(outcome, model), model.network.sections
    place_m = legs["sign"] * outcome.recording.trains["route_position"] + legs["offset_m"]
    section = legs["first_section"].copy()
    for s in range(1, len(sections)):
        above = (legs["first_section"] < s) & (s < legs["end_section"])
        section = np.where(above & (place_m >= sections.start_m[s]), s, section)
    return section, np.asarray(place_m)


def _nan_is_largest(value: float) -> float:
    return np.inf if np.isnan(value) else value


def power_mismatch_va(outcome: Outcome, model: Model) -> float:
    """Largest mismatch between recorded powers and those that the recorded voltages ask for. [VA]

    References
    ----------
    [Boullanger2009]_, eq. (F.35)-(F.38).
    """
    if outcome.steps == 0:
        return 0.0
    rows, network = slice(0, outcome.steps), model.network
    trains, nodes = outcome.recording.trains[rows], outcome.recording.nodes[rows]
    stations = outcome.recording.stations[rows]
    train_v, node_v = phasors(trains, "pantograph"), phasors(nodes, "node")
    section, place_m = (each[rows] for each in sections_and_places(outcome, model))
    train_a, leaving_a = _contact_line_currents(section, place_m, train_v, node_v, network)
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
    on_line &= outcome.recording.train_state[rows] != TrainState.ARRIVED
    drawn = trains["active_power"] + 1j * trains["reactive_power"]
    return max(
        _largest(node_v * leaving_a.conj() - fed),
        _largest((train_v * train_a.conj() - drawn)[on_line]),
        key=_nan_is_largest,
    )


def _contact_line_currents(
    section: Any, place_m: Floats, train_v: Complexes, node_v: Complexes, network: Network
) -> tuple[Complexes, Complexes]:
    """Current into each train, and current that leaves each node into the contact line. [A]

    The points of a section, its nodes and the trains under it, are sorted by place at every instant.
    """
    drawn_a, leaving_a = np.zeros_like(train_v), np.zeros_like(node_v)
    for group in sections_of(network.groups):
        for k in range(len(place_m)):
            _group_currents(
                group, section[k], place_m[k], train_v[k], node_v[k], network,
                drawn_a[k], leaving_a[k],
            )  # fmt: skip
    for s, part in enumerate(network.sections):
        if any(s in group for group in sections_of(network.groups)):
            continue
        under = np.isfinite(train_v) & (section == s)
        ends_m = np.ones((len(place_m), 1))
        # A train may stand before the first node of a line, or behind the last one, by rounding.
        keys = np.concatenate([-np.inf * ends_m, np.where(under, place_m, np.inf)], axis=1)
        order = np.argsort(keys, axis=1, kind="stable")
        points_m = np.concatenate([part.start_m * ends_m, place_m], axis=1)
        volts = np.concatenate([node_v[:, [part.start_node]], train_v], axis=1)
        there = np.concatenate([ends_m > 0.0, under], axis=1)
        points_m, volts, there = (
            np.take_along_axis(each, order, 1) for each in (points_m, volts, there)
        )
        last = there.sum(axis=1) - 1
        leaving = np.zeros_like(volts)
        for k in range(volts.shape[1]):
            at_end = k == last
            if not at_end.any() and not there[:, k].any():
                break
            after = min(k + 1, volts.shape[1] - 1)
            ahead_v = np.where(at_end, node_v[:, part.end_node], volts[:, after])
            ahead_m = np.where(at_end, part.end_m, points_m[:, after])
            length_m = np.maximum(SHORTEST_PIECE_M, ahead_m - points_m[:, k])
            here = there[:, k]
            drop = np.where(here, volts[:, k] - ahead_v, 0.0)
            current = drop / (part.impedance_ohm_per_m * np.where(here, length_m, 1.0))
            half_shunt = 0.5j * part.susceptance_s_per_m * length_m
            leaving[:, k] += np.where(here, current + half_shunt * volts[:, k], 0.0)
            arriving = np.where(here, half_shunt * ahead_v - current, 0.0)
            leaving_a[:, part.end_node] += np.where(at_end, arriving, 0.0)
            leaving[:, after] += np.where(at_end, 0.0, arriving)
        unsorted = np.zeros_like(leaving)
        np.put_along_axis(unsorted, order, leaving, 1)
        leaving_a[:, part.start_node] += unsorted[:, 0]
        drawn_a -= np.where(under, unsorted[:, 1:], 0.0)
    return drawn_a, leaving_a


def _group_currents(
    group: Any, section: Any, place_m: Floats, train_v: Complexes, node_v: Complexes,
    network: Network, drawn_a: Complexes, leaving_a: Complexes,
) -> None:  # fmt: skip
    """Add the currents of coupled sections at an instant to those of their trains and nodes. [A]

    Unknown are the currents of all pieces at once; two on different tracks have the impedance in common
    of the length along which they lie beside each other.
    """
    pieces: list[tuple[int, float, float, complex, complex, Any, Any]] = []
    for s in group:
        part = network.sections[s]
        if network.source_of_node[part.start_node] == UNFED:
            continue
        under = np.flatnonzero(np.isfinite(train_v) & (section == s))
        under = under[np.argsort(place_m[under], kind="stable")]
        points_m = [part.start_m, *place_m[under], part.end_m]
        volts = [node_v[part.start_node], *train_v[under], node_v[part.end_node]]
        ends = [("node", part.start_node), *(("train", i) for i in under), ("node", part.end_node)]
        begin_m = 0.0
        for k in range(len(points_m) - 1):
            length_m = max(SHORTEST_PIECE_M, points_m[k + 1] - points_m[k])
            pieces.append(
                (s, begin_m, begin_m + length_m, volts[k], volts[k + 1], ends[k], ends[k + 1])
            )
            begin_m += length_m
    if not pieces:
        return
    part = network.sections[group[0]]
    impedance = np.zeros((len(pieces),) * 2, dtype=complex)
    for i, (s, begin_m, end_m, *_) in enumerate(pieces):
        for j, (other, from_m, to_m, *_) in enumerate(pieces):
            beside_m = min(end_m, to_m) - max(begin_m, from_m)
            if i == j:
                impedance[i, j] = part.impedance_ohm_per_m * (end_m - begin_m)
            elif other != s and beside_m > 0.0:
                impedance[i, j] = network.groups.mutual_ohm_per_m[s] * beside_m
    drops = np.array([piece[3] - piece[4] for piece in pieces])
    for piece, current in zip(pieces, np.linalg.solve(impedance, drops), strict=True):
        _, begin_m, end_m, begin_v, end_v, begin, end = piece
        shunt = 0.5j * part.susceptance_s_per_m * (end_m - begin_m)
        for (kind, number), leaving in (
            (begin, current + shunt * begin_v),
            (end, shunt * end_v - current),
        ):
            if kind == "node":
                leaving_a[number] += leaving
            else:
                drawn_a[number] -= leaving


def converter_residual(outcome: Outcome, network: Network) -> float:
    """Largest distance of a station's voltage from the phasor that its law asks for. [p.u.]"""
    rows = slice(0, outcome.steps)
    stations, nodes = outcome.recording.stations[rows], outcome.recording.nodes[rows]
    sources = network.sources
    p, q = stations["station_active_power"], stations["station_reactive_power"]
    n, node_v = stations["active_converters"], phasors(nodes, "node")[:, sources.node]
    out = n == 0.0  # of service: nothing is asked of them, and nothing fed
    assert (p[out] == 0.0).all()
    assert (q[out] == 0.0).all()
    n = np.where(out, 1.0, n)
    asked_v = np.empty_like(node_v)
    for kind, phasor in (
        (SourceKind.CONVERTER, converter_phasor),
        (SourceKind.GRID, grid_phasor),
    ):
        own = sources.kind == kind
        asked_v[:, own] = phasor(p[:, own], q[:, own], n[:, own], node_v[:, own], sources[own])
    return _largest(np.where(out, 0.0, node_v - asked_v) / network.system.base_voltage_v)


def converter_phasor(p: Floats, q: Floats, n: Floats, _: Complexes, sources: Any) -> Complexes:
    """Voltage and angle that converters ask for, as a phasor. [V]

    References
    ----------
    [Boullanger2009]_, eq. (2.1)-(2.4).
    """
    law = sources.converter
    voltage = law.no_load_voltage_v - law.droop_v_per_var * q / n
    square = law.motor_voltage_v**2
    q50 = law.grid_reactive_power_var
    grid = np.arctan(law.grid_reactance_ohm * p / (square + law.grid_reactance_ohm * q50)) / 3
    x_motor, x_generator = law.motor_reactance_ohm / n, law.generator_reactance_ohm / n
    motor = np.arctan(x_motor * p / (square + x_motor * q50)) / 3
    generator = np.arctan(x_generator * p / (voltage**2 + x_generator * q))
    angle = law.grid_angle_rad - grid - motor - generator
    return np.asarray(voltage * np.exp(1j * angle))


def grid_phasor(p: Floats, q: Floats, n: Floats, node_v: Complexes, sources: Any) -> Complexes:
    """Voltage behind the impedances of grid and transformers, at the current that is fed. [V]"""
    law = sources.grid
    fed_a = np.conj((p + 1j * q) / node_v)
    impedance_ohm = law.grid_impedance_ohm + law.transformer_impedance_ohm / n
    return np.asarray(law.no_load_voltage_v - impedance_ohm * fed_a)


def network_balance(outcome: Outcome, model: Model) -> float:
    """Relative difference between the stations' energy and that of trains and losses. [1]"""
    recording, step_s = outcome.recording, model.options.step_s
    each_s = intervals_s(outcome, model)
    rows = slice(0, outcome.steps)
    fed = np.nansum(recording.stations["station_active_power"][rows].sum(axis=1) * each_s)
    drawn = np.nansum(np.nansum(recording.trains["active_power"][rows], axis=1) * each_s)
    lost = np.nansum(recording.network_losses[rows] * each_s)
    # Relative to at least a megawatt on average: of that, the solver's tolerance is the limit.
    mismatch_w = TOLERANCE * model.network.system.base_power_va
    least = mismatch_w / ALLOWED_BALANCE * step_s * max(outcome.steps, 1)
    return float(abs(fed - drawn - lost) / max(abs(fed), least))


def intervals_s(outcome: Outcome, model: Model) -> Floats:
    """Lengths of the steps: all alike, but the last one may end with the studied train's arrival. [s]"""
    each_s = np.full(outcome.steps, model.options.step_s)
    each_s[-1:] = np.where(
        np.isclose(np.diff(outcome.instants_s)[-1:], each_s[-1:], rtol=1e-9, atol=0.0),
        each_s[-1:],
        np.diff(outcome.instants_s)[-1:],
    )
    return each_s


def traction_balance(outcome: Outcome, model: Model) -> float:
    """Relative difference between the motors' work and where it went. [1]"""
    if model.options.motion == MotionModel.CONTINUOUS:
        return continuous_traction_balance(outcome, model)
    return stepped_traction_balance(outcome, model)


def continuous_traction_balance(outcome: Outcome, model: Model) -> float:
    """`traction_balance` of trains whose steps may have several phases, from the recorded powers.

    The motors' recorded work counts as far as some efficiency of the train makes it what the drawn
    energy is, less the auxiliaries of the time from departure to arrival.
    """
    trains, timetable = outcome.recording.trains, outcome.state.trains["timetable"]
    kind, count = _kinds(outcome, model), len(outcome.trains)
    h = intervals_s(outcome, model)[:, np.newaxis]
    before, after = trains[:-1], trains[1:]
    step, own = np.arange(outcome.steps)[:, np.newaxis], timetable[:count]
    present_s = h - np.where(step == own["departure_step"], own["departure_wait_s"], 0.0)
    present_s = present_s - np.where(step + 1 == own["arrival_step"], own["stood_s"], 0.0)
    low, high = np.empty(count), np.empty(count)
    for i, curve in enumerate(kind.efficiency):
        values = model.points.value[curve.first : curve.first + curve.points]
        low[i], high[i] = values.min(), values.max()
    for_motors = before["active_power"] * h - kind.auxiliary_power_w * present_s
    recorded = before["motor_power"] * h
    work = np.clip(recorded, low * for_motors, high * for_motors) / kind.slip_factor
    opposing = before["resistance_power"] + before["gradient_power"] + before["braking_power"]
    moving = (opposing - before["traction_power"]) * h + recorded / kind.slip_factor
    kinetic = kind.inertia_kg / 2.0 * (after["speed"] ** 2 - before["speed"] ** 2)
    difference = np.nansum(work) - np.nansum(moving) - np.nansum(kinetic)
    fallen = -np.nansum(np.minimum(before["gradient_power"], 0.0) * h)
    slowed = -np.nansum(np.minimum(kinetic, 0.0))
    return float(abs(difference) / max(np.nansum(work) + fallen + slowed, 1.0))


def stepped_traction_balance(outcome: Outcome, model: Model) -> float:
    """`traction_balance` of trains that move in steps of one acceleration.

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
    x = np.clip(x, points.x[0], points.x[-1])
    k = np.clip(np.searchsorted(points.x, x, side="right") - 1, 0, points.size - 2)
    before, after = points[k], points[k + 1]
    step = after.x - before.x
    t = (x - before.x) / step
    values = before.value * (1 + 2 * t) * (1 - t) ** 2 + after.value * t**2 * (3 - 2 * t)
    slopes = before.slope * t * (1 - t) ** 2 - after.slope * t**2 * (1 - t)
    return np.asarray(values + step * slopes, dtype=float)


def _limits(position_m: Floats, kind: Any, model: Model) -> Floats:
    """Speed limits that trains of their lengths have to keep. [m/s]"""
    limits, row = model.limits, np.broadcast_to(kind.profile, position_m.shape)
    begun = (limits.from_m[row] <= position_m[..., np.newaxis]).sum(axis=-1)
    return np.asarray(limits.value[row, np.maximum(begun - 1, 0)], dtype=float)


def force_balance(outcome: Outcome, model: Model) -> float:
    """Largest |F - F_res - F_brake - M a| of a moving train, relative to its weight. [1]

    References
    ----------
    [Boullanger2009]_, eq. (2.11) and (F.19).
    """
    rows = slice(0, outcome.steps)
    trains = outcome.recording.trains[rows]
    state = outcome.recording.train_state[rows]
    kind = _kinds(outcome, model)
    rest = trains["tractive_force"] - trains["braking_force"]
    rest = rest - trains["running_resistance"] - trains["gradient_force"]
    inertia_kg = np.broadcast_to(kind.inertia_kg, state.shape)
    if model.options.driver == Driver.AGGRESSIVE:
        # At its limit and above a driver switches off; below, the machine may give nothing.
        limit = np.minimum(_limits(trains["route_position"], kind, model), kind.highest_speed_m_s)
        coasts = (state == TrainState.COASTING) & (trains["speed"] >= limit)
        inertia_kg = np.where(coasts, kind.coasting_inertia_kg, inertia_kg)
    rest = rest - inertia_kg * trains["acceleration"]
    driven = (
        (state == TrainState.MOTORING)
        | (state == TrainState.COASTING)
        | (state == TrainState.BRAKING)
    )
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
        outcome.recording.train_state[:-1] != TrainState.ARRIVED
    )
    if model.options.motion == MotionModel.CONTINUOUS:
        return continuous_motion_error_m(outcome, model, both)
    way = after["route_position"] - before["route_position"]
    way = way - step_s * (before["speed"] + after["speed"]) / 2.0
    if model.options.braking == Braking.WITHIN_STEP:
        way = braking_motion_error_m(before, after, _kinds(outcome, model), step_s)
    speed = after["speed"] - before["speed"] - step_s * before["acceleration"]
    return max(_largest(way[both]), _largest(speed[both]) * step_s, key=_nan_is_largest)


def continuous_motion_error_m(outcome: Outcome, model: Model, both: npt.NDArray[np.bool_]) -> float:
    """How far a train runs backwards, or further than its limits let it, and |v' - v - a h| h.

    A train that comes to an instant faster than its limit there, and no slower than it was, is over it.
    """
    trains = outcome.recording.trains
    kind = _kinds(outcome, model)
    h = intervals_s(outcome, model)[:, np.newaxis]
    before, after = trains[:-1], trains[1:]
    from_m, to_m = before["route_position"], after["route_position"]
    fastest = np.maximum(
        before["speed"], np.minimum(_limits(from_m, kind, model), kind.highest_speed_m_s)
    )
    for j in range(model.limits.from_m.shape[1]):
        begins_m, value = model.limits.from_m[kind.profile, j], model.limits.value[kind.profile, j]
        passed = (from_m < begins_m) & (begins_m <= to_m)
        allowed = np.minimum(value, kind.highest_speed_m_s)
        fastest = np.where(passed, np.maximum(fastest, allowed), fastest)
    way_m = to_m - from_m
    limit = np.minimum(_limits(to_m, kind, model), kind.highest_speed_m_s)
    over = np.where(before["speed"] <= after["speed"], np.maximum(0.0, after["speed"] - limit), 0.0)
    change = after["speed"] - before["speed"] - h * before["acceleration"]
    errors = (np.minimum(0.0, way_m), np.maximum(0.0, way_m - fastest * h), over * h, change * h)
    return max((_largest(error[both]) for error in errors), key=_nan_is_largest)


def braking_work(before: Any, after: Any, kind: Any, step_s: float) -> Floats:
    """Work of resistances and brakes, phase by phase. [J]

    Of the resistances the mean over the step is recorded, for a part of which the train may stand.  To
    hold the speed downhill takes brakes; the rest of their recorded impulse slows the train down.

    Parameters
    ----------
    before, after : records of `TrainRow`, shape (steps, trains)
        At the instants before and after each step.
    kind : records of `TrainType`, shape (trains,)
    step_s : float
        Time step. [s]
    """
    v, hold_s = before["speed"], before["holding_time"]
    brake_s = (v - after["speed"]) / kind.highest_retardation_m_s2
    moving_s = hold_s + brake_s
    impulse_ns = step_s * (before["running_resistance"] + before["gradient_force"])
    resistance_n = impulse_ns / np.where(moving_s > 0.0, moving_s, np.nan)
    holding_ns = np.maximum(0.0, -resistance_n) * hold_s
    stopping_ns = before["braking_force"] * step_s - holding_ns
    while_holding = (resistance_n * hold_s + holding_ns) * v
    while_braking = (resistance_n * brake_s + stopping_ns) * (v + after["speed"]) / 2.0
    return np.asarray(while_holding + while_braking, dtype=float)


def braking_motion_error_m(before: Any, after: Any, kind: Any, step_s: float) -> Floats:
    """Difference between the way of each step and that of its speeds. [m]

    A step that holds the speed v for τ, then brakes with b, goes v τ + (v² - v'²)/2b; together that
    takes the whole step, or less of it if the train stops.  A step without τ is a uniform one, but that
    a train may come to its stop in any part of it: it goes no less than with b, and no further than
    uniformly.  Parameters are those of `braking_work`.
    """
    v, w, hold_s = before["speed"], after["speed"], before["holding_time"]
    way_m = after["route_position"] - before["route_position"]
    brake_s = (v - w) / kind.highest_retardation_m_s2
    over_s = hold_s + brake_s - step_s
    over_s = np.where(w > 0.0, np.abs(over_s), np.maximum(0.0, over_s))
    held_m = v * hold_s + (v + w) / 2.0 * brake_s
    uniform_m = step_s * (v + w) / 2.0
    shortest_m = np.minimum(uniform_m, v / 2.0 * brake_s)
    stop_m = np.clip(way_m, shortest_m, uniform_m)
    other_m = np.where((w == 0.0) & (v > 0.0), stop_m, uniform_m)
    error = np.where(hold_s > 0.0, np.abs(way_m - held_m) + v * over_s, way_m - other_m)
    return np.asarray(error, dtype=float)
