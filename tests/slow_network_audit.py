"""The network's part of the slow audit: powers at all nodes, laws of the stations, balance of energy.

The solver pushes voltages and currents along chains; the audit starts from the recorded voltages,
forms the current of every piece of line and every branch from the voltages at its ends (the nodal
admittance equations), and compares the powers that this asks for with the recorded ones.
"""

from types import SimpleNamespace
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import fsolve

from slow_bundle_audit import add_bundles, bundled_sections
from slow_figures import intervals_s, largest, nan_is_largest
from tpss.audit.balances import ALLOWED_BALANCE
from tpss.powerflow.bundles import NO_BUNDLES
from tpss.powerflow.groups import sections_of
from tpss.powerflow.links import ends_of
from tpss.powerflow.network import SHORTEST_PIECE_M, TOLERANCE, UNFED, Network
from tpss.powerflow.shared_grids import NO_SHARED_GRIDS
from tpss.run.run import Outcome
from tpss.sources.kinds import SourceKind
from tpss.sources.mixed import TYPES
from tpss.sources.rectifier import LEAK
from tpss.step.model import Model
from tpss.step.state import TrainState

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]


def phasors(rows: Any, place: str) -> Complexes:
    """Recorded voltages of trains ("pantograph") or nodes ("node"). [V]"""
    return np.asarray(rows[f"{place}_real"] + 1j * rows[f"{place}_imag"], dtype=complex)


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
    astray_va = 0.0
    if network.bundles != NO_BUNDLES:
        volts = outcome.recording.conductors[rows]
        for k in range(outcome.steps):
            astray_va = max(
                astray_va,
                add_bundles(
                    section[k], place_m[k], volts[k], node_v[k], network, train_a[k], leaving_a[k]
                ),
            )
    for branch in network.branches:
        current = node_v[:, branch.start_node] - node_v[:, branch.end_node]
        current = current / branch.impedance_ohm
        leaving_a[:, branch.start_node] += current
        leaving_a[:, branch.end_node] -= current
    for k, (ends, weights) in enumerate(ends_of(network.links)):
        current = network.links.admittance_s[k] * (node_v[:, ends] @ weights)
        leaving_a[:, ends] += current[:, None] * weights
    fed = np.zeros_like(node_v)
    fed[:, network.sources.node] = (
        stations["station_active_power"] + 1j * stations["station_reactive_power"]
    )
    for m, law in enumerate(network.stores):
        taken_w = outcome.recording.stores[rows]["store_power"][:, m]
        fed[:, law.node] -= np.where(node_v[:, law.node] != 0.0, taken_w, 0.0)
    on_line = outcome.recording.train_state[rows] >= 0
    on_line &= outcome.recording.train_state[rows] != TrainState.ARRIVED
    drawn = trains["active_power"] + 1j * trains["reactive_power"]
    return max(
        largest(node_v * leaving_a.conj() - fed),
        stores_off_w(outcome, model, node_v),
        largest((train_v * train_a.conj() - drawn)[on_line]),
        astray_va,
        key=nan_is_largest,
    )


def stores_off_w(outcome: Outcome, model: Model, node_v: Complexes) -> float:
    """Largest distance of a store's power from that of its law, and of its energy from its balance. [W]

    By its efficiency, without the names of the sides: charging keeps eta_c of the power, and giving
    takes 1/eta_d of it; no step passes full or empty, and none its current at its voltage.
    """
    rows, each_s, off = outcome.recording.stores, intervals_s(outcome, model), [0.0]
    for m, law in enumerate(model.network.stores):
        own, volts = law.store, np.abs(node_v[:, law.node])
        energy = np.asarray(rows["stored_energy"][: outcome.steps + 1, m])
        power, lost = (rows[name][: outcome.steps, m] for name in ("store_power", "store_losses"))
        idle_j = np.minimum(own.standby_w * each_s, energy[:-1])
        held = energy[:-1] - idle_j
        highest = np.full_like(power, np.inf)
        if own.capacitance_f:
            highest = own.highest_current_a * np.sqrt(
                2.0 * (energy[:-1] + own.empty_j) / own.capacitance_f
            )
        eta_c, eta_d = own.charge_efficiency, own.discharge_efficiency
        into = np.minimum(own.charge_power_w, highest / eta_c)
        into = np.minimum(into, (own.capacity_j - held) / (eta_c * each_s))
        out = np.minimum(own.discharge_power_w, highest * eta_d)
        out = np.minimum(out, held * eta_d / each_s)
        up = np.clip(law.charge_w_per_v * (volts - law.charges_above_v), 0.0, into)
        down = np.clip(law.discharge_w_per_v * (law.discharges_below_v - volts), 0.0, out)
        asked = np.where(volts > 0.0, up - down, 0.0)
        kept = np.where(power > 0.0, eta_c * power, power / eta_d) * each_s
        passed = np.maximum(-energy[1:], energy[1:] - own.capacity_j)
        off += [
            largest(power - asked),
            largest((held + kept - energy[1:]) / each_s),
            largest((energy[:-1] + (power - lost) * each_s - energy[1:]) / each_s),
            largest(np.maximum(passed, 0.0) / each_s),
        ]
    return max(off, key=nan_is_largest)


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
    bundled = bundled_sections(network)
    for s, part in enumerate(network.sections):
        if any(s in group for group in sections_of(network.groups)) or s in bundled:
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
    if network.bundles != NO_BUNDLES:  # the law is that at the terminals
        current_a = ((p + 1j * q) / node_v).conj()
        node_v = node_v - network.bundles.inner_ohm * current_a
        power_va = node_v * current_a.conj()
        p, q = power_va.real, power_va.imag
    out = n == 0.0  # of service: nothing is asked of them, and nothing fed
    assert (p[out] == 0.0).all()
    assert (q[out] == 0.0).all()
    n = np.where(out, 1.0, n)
    asked_v = np.empty_like(node_v)
    for kind, phasor in (
        (SourceKind.CONVERTER, converter_phasor),
        (SourceKind.GRID, grid_phasor),
        (SourceKind.BOUNDED, bounded_phasor),
        (SourceKind.MIXED, mixed_phasor),
        (SourceKind.RECTIFIER, rectifier_voltage),
    ):
        own = sources.kind == kind
        asked_v[:, own] = phasor(p[:, own], q[:, own], n[:, own], node_v[:, own], sources[own])
    if network.shared != NO_SHARED_GRIDS:
        current_a = np.where(out, 0.0, (p + 1j * q) / np.where(out, 1.0, node_v)).conj()
        asked_v -= current_a @ network.shared.mutual_ohm.T
    return largest(np.where(out, 0.0, node_v - asked_v) / network.system.base_voltage_v)


def rectifier_voltage(p: Floats, q: Floats, n: Floats, v: Complexes, sources: Any) -> Complexes:
    """Voltage of a rectifier station, less what its current differs from that of its law there. [V]

    The difference counts as a fall along the first piece of the characteristic.
    """
    asked_v = v.copy()
    for s, law in enumerate(sources.rectifier):
        amperes, volts = (np.array(each[: law.points]) for each in (law.current_a, law.voltage_v))
        ohm = (volts[0] - volts[1]) / amperes[1]
        last_ohm = (volts[-2] - volts[-1]) / (amperes[-1] - amperes[-2])
        u = v[:, s].real
        beyond = amperes[-1] + (volts[-1] - u) / last_ohm
        given = np.where(u < volts[-1], beyond, np.interp(u, volts[::-1], amperes[::-1]))
        given = n[:, s] * np.where(u > volts[0], LEAK * (volts[0] - u) / ohm, given)
        with np.errstate(invalid="ignore"):
            taken = np.minimum(
                (u - law.inverter_from_v) / law.inverter_ohm, law.inverter_power_w / u
            )
        given -= np.where(u > law.inverter_from_v, taken, 0.0)
        asked_v[:, s] -= ohm / n[:, s] * ((p[:, s] + 1j * q[:, s]) / u - given)
    return np.asarray(asked_v)


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


def mixed_phasor(p: Floats, q: Floats, _: Floats, node_v: Complexes, sources: Any) -> Complexes:
    """Phasor that converters of several types ask for, each by `converter_phasor` of its part. [V]

    The parts are found by a library's method for any equations, from those by rated power.
    """
    asked_v = np.empty_like(node_v)
    for step, s in np.ndindex(*node_v.shape):
        law, power_va = sources.mixed[s], complex(p[step, s], q[step, s])
        kinds = [
            (SimpleNamespace(converter=getattr(law, name)), getattr(law, f"{name}_units"))
            for name in TYPES
            if getattr(law, f"{name}_units") > 0
        ]
        shares = [getattr(law, f"{name}_share") * power_va for name in TYPES[: len(kinds)]]

        def asked_by(powers: Complexes, kinds: Any = kinds) -> Complexes:
            return np.array(
                [
                    converter_phasor(own.real, own.imag, units, own, kind)
                    for own, (kind, units) in zip(powers, kinds, strict=True)
                ]
            )

        def unequal(x: Floats, power_va: complex = power_va) -> Floats:
            """Voltages less that of the first type, and what is missing of the power. [kV], [MW]"""
            powers = 1e6 * (x[0::2] + 1j * x[1::2])
            voltages = asked_by(powers)
            left = np.append(voltages[1:] - voltages[0], 1e-3 * (power_va - powers.sum())) / 1e3
            return left.view(float)

        start = np.array(shares).view(float) / 1e6
        found, more, *_ = fsolve(unequal, start, xtol=1e-13, full_output=True)
        assert np.abs(more["fvec"]).max() < 1e-9
        asked_v[step, s] = asked_by(1e6 * (found[0::2] + 1j * found[1::2]))[0]
    return asked_v


def bounded_phasor(p: Floats, q: Floats, n: Floats, node_v: Complexes, sources: Any) -> Complexes:
    """Phasor that converters with bounds ask for: `converter_phasor`, with less or more voltage. [V]

    The voltage falls to nothing within 2 % of the highest current, the corner rounded off over 0.5 %;
    power that is taken turns the angle by 0.5 rad up to the width, and raises the voltage beyond twice
    the width by all of it within one width, the corner rounded off over half a width.
    """
    asked = converter_phasor(p, q, n, node_v, sources)
    whole_v = np.broadcast_to(sources.converter.no_load_voltage_v, p.shape)
    with np.errstate(all="ignore"):
        limit_a = np.broadcast_to(sources.bounds.highest_current_a, p.shape)
        over = np.hypot(p, q) / np.abs(node_v) / n / limit_a - 1.0
        fall_v = np.where(np.isinf(limit_a), 0.0, whole_v / 0.02 * rounded(over, 0.005))
        taken = np.maximum(-p / n / sources.bounds.blocked_from_w, 0.0)
        z = np.minimum(taken, 1.0)
    rise_v = np.where(taken > 0.0, whole_v * rounded(taken - 2.0, 0.5), 0.0)
    size = np.abs(asked) - np.nan_to_num(fall_v) + rise_v
    return size * np.exp(1j * (np.angle(asked) + 0.5 * (3.0 * z**2 - 2.0 * z**3)))


def rounded(x: Floats, half: float) -> Floats:
    """The larger of a number and 0, its corner a parabola over both halves."""
    return np.where(np.abs(x) < half, (x + half) ** 2 / (4.0 * half), np.maximum(x, 0.0))


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
    lost += np.nansum(recording.stores["store_power"][rows].sum(axis=1) * each_s)
    # Relative to at least a megawatt on average: of that, the solver's tolerance is the limit.
    mismatch_w = TOLERANCE * model.network.system.base_power_va
    least = mismatch_w / ALLOWED_BALANCE * step_s * max(outcome.steps, 1)
    if model.network.bundles != NO_BUNDLES:  # each train has a balance of its own
        least *= max(len(outcome.trains), 1)
    return float(abs(fed - drawn - lost) / max(abs(fed), least))
