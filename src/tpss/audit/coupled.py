r"""The audit of coupled sections: the currents of their pieces from the recorded voltages.

Between two of its own points (trains on it, ends) a conductor of a group carries one current, whatever
stands on the others.  The voltages at the ends of a piece p of conductor k give an equation,

    V_begin - V_end = z_s l_p I_p + z_m Σ_q l_pq I_q

over the pieces q of the other conductors, of which a length l_pq lies beside it.  Where a piece ends,
only those beside that place share an equation with it, one a conductor: eliminated in the order of
their ends, the pieces leave a front of as many equations as there are conductors.  The solver never has
these equations: it pushes voltages and currents.
"""

from typing import Any

from tpss.audit.balances import Scratch, audit_demand
from tpss.kernel import inlined, where_any
from tpss.numerics.pairs import scaled
from tpss.powerflow.groups import Groups
from tpss.powerflow.network import SHORTEST_PIECE_M, UNFED, Network
from tpss.step.model import Model
from tpss.step.recording import Recording


def _pass_nothing(_groups: Groups, _s: int, first: int, *_: Any) -> int:
    """`pass_trains` where there are no groups."""
    return first


@where_any(without=_pass_nothing)
def pass_trains(_groups: Groups, s: int, first: int, count: int, scratch: Scratch) -> int:
    """Leave the trains under section `s`, from the first one on, for later; return the next train."""
    scratch.groups.first[s] = k = first
    while k < count and scratch.section[scratch.order[k]] == s:
        k += 1
    return k


def _audit_nothing(*_: Any) -> None:
    """`audit_groups` of no groups."""


@where_any(without=_audit_nothing)
def audit_groups(
    groups: Groups, step: int, count: int, model: Model, recording: Recording, scratch: Scratch
) -> None:
    """Mismatch of the trains under coupled sections, and their part of what leaves their nodes."""
    network = model.network
    for g in range(groups.size.size):
        n = _begin(g, count, network, scratch)
        pieces = _eliminate(step, n, count, network, recording, scratch)
        _substitute(step, pieces, n, network, recording, scratch)
        for k in range(n):
            conductor = scratch.groups.conductors[k]
            start_node = network.sections[conductor.section].start_node
            scratch.leaving_a[start_node] += conductor.leaving_a


@inlined
def _begin(g: int, count: int, network: Network, scratch: Scratch) -> int:
    """Put those conductors of a group that are fed to its start; return their number."""
    n = 0
    for j in range(network.groups.size[g]):
        s = network.groups.section[g, j]
        if network.source_of_node[network.sections[s].start_node] == UNFED:
            continue
        conductor = scratch.groups.conductors[n]
        conductor.section, conductor.next = s, scratch.groups.first[s]
        conductor.is_open = True
        conductor.current_a = conductor.leaving_a = 0.0
        _begin_piece(network.sections[s].start_m, n, count, network, scratch)
        conductor.begin_v = scratch.node_v[network.sections[s].start_node]
        n += 1
    scratch.groups.front[:] = 0.0
    return n


@inlined
def _begin_piece(place_m: float, k: int, count: int, network: Network, scratch: Scratch) -> None:
    """Measure the piece of a conductor that begins at a place. [m]"""
    conductor = scratch.groups.conductors[k]
    ahead_m = network.sections[conductor.section].end_m
    if _has_train(k, count, scratch):
        ahead_m = scratch.place_m[scratch.order[conductor.next]]
    conductor.length_m = conductor.ahead_m = max(SHORTEST_PIECE_M, ahead_m - place_m)


@inlined
def _has_train(k: int, count: int, scratch: Scratch) -> bool:
    """Whether a train stands at the next point of a conductor."""
    conductor = scratch.groups.conductors[k]
    return (
        conductor.next < count
        and scratch.section[scratch.order[conductor.next]] == conductor.section
    )


@inlined
def _eliminate(
    step: int, n: int, count: int, network: Network, recording: Recording, scratch: Scratch
) -> int:
    """Note the pieces of a group in the order of their ends, and eliminate them; return their number."""
    groups, found = scratch.groups, 0
    while True:
        m = -1
        for k in range(n):
            conductor = groups.conductors[k]
            if conductor.is_open and (m < 0 or conductor.ahead_m < groups.conductors[m].ahead_m):
                m = k
        if m < 0:
            return found
        _go_on(groups.conductors[m].ahead_m, n, network, scratch)
        conductor, piece = groups.conductors[m], groups.pieces[found]
        section = network.sections[conductor.section]
        piece.conductor, piece.train = m, -1
        piece.length_m, piece.begin_v = conductor.length_m, conductor.begin_v
        piece.end_v = scratch.node_v[section.end_node]
        if _has_train(m, count, scratch):
            piece.train = scratch.order[conductor.next]
            row = recording.trains[step, piece.train]
            piece.end_v = complex(row.pantograph_real, row.pantograph_imag)
            conductor.next, conductor.begin_v = conductor.next + 1, piece.end_v
            _begin_piece(scratch.place_m[piece.train], m, count, network, scratch)
        else:
            conductor.is_open = False
        _eliminate_piece(found, m, n, scratch)
        found += 1


@inlined
def _go_on(length_m: float, n: int, network: Network, scratch: Scratch) -> None:
    """Add a length of all open conductors to their equations. [m]"""
    conductors, front = scratch.groups.conductors, scratch.groups.front
    s = conductors[0].section
    own, common = network.sections[s].impedance_ohm_per_m, network.groups.mutual_ohm_per_m[s]
    for k in range(n):
        if conductors[k].is_open:
            conductors[k].ahead_m -= length_m
            for j in range(n):
                if j == k:
                    front[k, j] += scaled(own, length_m)
                elif conductors[j].is_open:
                    front[k, j] += scaled(common, length_m)


@inlined
def _eliminate_piece(p: int, m: int, n: int, scratch: Scratch) -> None:
    """Eliminate the current of piece `p`, that of conductor `m`, whose equation is complete."""
    front, factors, piece = scratch.groups.front, scratch.groups.factors, scratch.groups.pieces[p]
    front[m, n] += piece.begin_v - piece.end_v
    pivot = 1.0 / front[m, m]
    for j in range(n + 1):
        factors[p, j] = front[m, j] * pivot
    for k in range(n):
        if k != m:
            for j in range(n + 1):
                if j != m:
                    front[k, j] -= front[k, m] * factors[p, j]
            front[k, m] = 0.0
    for j in range(n + 1):
        front[m, j] = 0.0
    factors[p, m] = 0.0


@inlined
def _substitute(
    step: int, pieces: int, n: int, network: Network, recording: Recording, scratch: Scratch
) -> None:
    """Find the currents of the pieces, the last one first, and what they leave for their points."""
    conductors, factors = scratch.groups.conductors, scratch.groups.factors
    for p in range(pieces - 1, -1, -1):
        piece = scratch.groups.pieces[p]
        conductor = conductors[piece.conductor]
        current_a = factors[p, n]
        for j in range(n):
            current_a -= factors[p, j] * conductors[j].current_a
        section = network.sections[conductor.section]
        shunt = complex(0.0, 0.5 * section.susceptance_s_per_m * piece.length_m)
        entering_a = current_a - shunt * piece.end_v
        if piece.train < 0:
            scratch.leaving_a[section.end_node] -= entering_a
        else:
            audit_demand(
                step, piece.train, piece.end_v, entering_a - conductor.leaving_a, recording,
                scratch.balances[0],
            )  # fmt: skip
        conductor.current_a = current_a
        conductor.leaving_a = current_a + shunt * piece.begin_v
