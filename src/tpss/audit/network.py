"""The audit of the network: power balances, and the laws of the sources.

The solver pushes voltages and currents along chains; the audit starts from the recorded voltages, forms
the current of every piece of line and every branch from the voltages at its ends (the nodal admittance
equations; of coupled sections see `coupled`), and compares the powers that this asks for with the
recorded ones.  That a source's law is right is the business of its own tests; that the solution obeys it
is the audit's.
"""

import math

from tpss.audit.balances import Scratch, audit_demand, worst
from tpss.audit.bundles import audit_bundles, pass_bundled
from tpss.audit.coupled import audit_groups, pass_trains
from tpss.audit.links import audit_links
from tpss.audit.sharing import drop_by_others
from tpss.audit.stores import join_stores
from tpss.kernel import inlined
from tpss.numerics.pairs import magnitude, scaled, squared
from tpss.powerflow.bundle_points import is_bundled
from tpss.powerflow.bundle_state import terminal_voltage
from tpss.powerflow.coupled import is_coupled
from tpss.powerflow.network import SHORTEST_PIECE_M, UNFED
from tpss.powerflow.placing import is_unfed, section_at
from tpss.record import Records
from tpss.sources.kinds import residual
from tpss.step.model import Model
from tpss.step.recorded import TrainRow
from tpss.step.recording import Recording
from tpss.step.state import TrainState
from tpss.track.leg import leg_at, place_on_line
from tpss.vehicle.train import Train


@inlined
def draws_power(state: int) -> bool:
    """Whether a train of this `TrainState` is on the line."""
    return state >= 0 and state != TrainState.ARRIVED


@inlined
def audit_network(
    step: int, trains: Records[Train], model: Model, recording: Recording, scratch: Scratch
) -> None:
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
        if branch.admittance_s == 0.0:  # out of service
            continue
        drop = scratch.node_v[branch.start_node] - scratch.node_v[branch.end_node]
        current = drop / branch.impedance_ohm
        scratch.leaving_a[branch.start_node] += current
        scratch.leaving_a[branch.end_node] -= current
    audit_links(network.links, scratch.node_v, scratch.leaving_a)
    count = sort_trains(step, trains, model, recording, scratch)
    k = 0
    for s in range(network.sections.size):
        if is_coupled(network.groups, s) and not is_unfed(s, network):
            k = pass_trains(network.groups, s, k, count, scratch)
        elif is_bundled(network.bundles, s):
            k = pass_bundled(network.bundles, s, k, count, scratch)
        else:
            k = _audit_section(step, s, k, count, model, recording, scratch)
    audit_groups(network.groups, step, count, model, recording, scratch)
    audit_bundles(network.bundles, step, model, recording, scratch)
    if network.stores.size > 0:
        join_stores(step, network, recording.stores, scratch, figures)
    for n in range(scratch.node_v.size):
        power = scratch.node_v[n] * scratch.leaving_a[n].conjugate()
        s = network.source_of_node[n]
        if s == UNFED:
            off = magnitude(scratch.node_v[n]) / network.system.base_voltage_v
            figures.converter_residual = worst(figures.converter_residual, off)
        if s >= 0:
            fed = recording.stations[step, s]
            power -= complex(fed.station_active_power, fed.station_reactive_power)
        figures.power_mismatch_va = worst(figures.power_mismatch_va, magnitude(power))


@inlined
def sort_trains(
    step: int, trains: Records[Train], model: Model, recording: Recording, scratch: Scratch
) -> int:
    """Bring the trains on the line to the front of ``scratch.order``; return their number.

    They stand by section and place, and at the same place by number.
    """
    order, count, near = scratch.order, 0, 0
    for k in range(order.size):
        i = order[k]
        if draws_power(recording.train_state[step, i]):
            order[k], order[count] = order[count], i
            count += 1
            near = _locate(i, near, recording.trains[step, i], trains[i], model, scratch)
    for k in range(1, count):
        i, place = order[k], k
        while place > 0 and not _stands_behind(i, order[place - 1], scratch):
            order[place] = order[place - 1]
            place -= 1
        order[place] = i
    return count


@inlined
def _locate(i: int, near: int, row: TrainRow, train: Train, model: Model, scratch: Scratch) -> int:
    """Note section and place of train `i`, and return the section."""
    leg = model.legs[train.route, leg_at(row.route_position, 0, train.route, model.legs)]
    scratch.place_m[i] = place_on_line(row.route_position, leg)
    scratch.section[i] = section_at(scratch.place_m[i], near, leg, model.network.sections)
    return scratch.section[i]


@inlined
def _stands_behind(i: int, j: int, scratch: Scratch) -> bool:
    """Whether train `i` stands behind train `j`."""
    if scratch.section[i] != scratch.section[j]:
        return scratch.section[i] > scratch.section[j]
    place_m, other_m = scratch.place_m[i], scratch.place_m[j]
    return place_m > other_m or (place_m == other_m and i > j)


@inlined
def _audit_section(
    step: int, s: int, first: int, count: int, model: Model, recording: Recording, scratch: Scratch
) -> int:
    """Mismatch of a section's trains, and its part of what leaves its nodes; return the next train."""
    section, figures = model.network.sections[s], scratch.balances[0]
    z = section.impedance_ohm_per_m
    voltage, place_m = scratch.node_v[section.start_node], section.start_m
    entering = complex(0.0, 0.0)  # into the point before, through the piece before
    at_node = True
    k = first
    while True:
        more = k < count and scratch.section[scratch.order[k]] == s
        if more:
            row = recording.trains[step, scratch.order[k]]
            ahead = complex(row.pantograph_real, row.pantograph_imag)
            ahead_m = scratch.place_m[scratch.order[k]]
        else:
            ahead, ahead_m = scratch.node_v[section.end_node], section.end_m
        length_m = max(SHORTEST_PIECE_M, ahead_m - place_m)
        current = scaled((voltage - ahead) * z.conjugate(), 1.0 / (squared(z) * length_m))
        shunt = complex(0.0, 0.5 * section.susceptance_s_per_m * length_m)
        leaving = current + shunt * voltage
        if at_node:
            scratch.leaving_a[section.start_node] += leaving
        else:
            audit_demand(
                step, scratch.order[k - 1], voltage, entering - leaving, recording, figures
            )
        entering = current - shunt * ahead
        if not more:
            scratch.leaving_a[section.end_node] -= entering
            return k
        voltage, place_m, at_node = ahead, ahead_m, False
        k += 1


@inlined
def audit_sources(
    step: int, step_s: float, model: Model, recording: Recording, scratch: Scratch
) -> None:
    """Residual of the sources' laws, and the energy that they feed in a step of this length. [s]

    That one that is out of service feeds nothing shows in the balance of its node, and in the energy.
    """
    network, figures = model.network, scratch.balances[0]
    for s in range(network.sources.size):
        source, row = network.sources[s], recording.stations[step, s]
        figures.fed_j += row.station_active_power * step_s
        if row.active_converters > source.installed:
            figures.converter_residual = math.inf
        if source.installed == 0:
            continue
        node = recording.nodes[step, source.node]
        voltage = complex(node.node_real, node.node_imag)
        power = complex(row.station_active_power, row.station_reactive_power)
        current = (power / voltage).conjugate()
        voltage = terminal_voltage(network.bundles, s, voltage, current)
        off, _, _ = residual(voltage, current, row.active_converters, source, False)
        off += drop_by_others(network.shared, s, step, model, recording)
        per_unit = magnitude(off) / network.system.base_voltage_v
        figures.converter_residual = worst(figures.converter_residual, per_unit)
