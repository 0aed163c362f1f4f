r"""Coupled sections: the conductors of a group, pushed from their starts to their ends together.

Along n conductors side by side, with the impedance z_s of each by itself and z_m of any two in common,
a current induces a voltage in all of them, all the way along which it flows,

    dV_k/dx = -z_s I_k - z_m Σ_{j≠k} I_j

Between neighbouring points of *all* conductors (trains on any of them, ends) every current is constant,
so the whole group is cut at every train.  On a piece of length l, and at a point of conductor m,

    piece:  V_k ← V_k - l ((z_s - z_m) I_k + z_m Σ_j I_j)        for every k
    point:  I_m ← I_m - i(V_m) - j b V_m                         for m only

which is that of `chain` for each conductor if z_m = 0: the half shunts are those of the conductor's own
pieces, from one of its own points to the next.  Currents of conductors whose end is reached count no
more: a piece of less than a metre is one of a metre, which may leave one of them a little longer.

The sensitivities are those of all V_k and I_k to all start voltages V_a and start currents I.  With
matrices of pairs, the gaps g = E - V_b at the ends of all conductors give what those of a chain do,

    A δV_a + B δI + g = δV_b       δI = B⁻¹ (δV_b - A δV_a - g)
    end currents:  C δV_a + D δI

blocks between all nodes of the group.  A train costs 2 n² + 2 n pairs in place of four.

A conductor that no source reaches carries no current, and none is induced in it: it is open somewhere.
"""

import math
from typing import Any

from tpss.kernel import at, fused, inlined, kernel, where_any
from tpss.numerics.block_lu import Block
from tpss.numerics.pair_matrix import eliminate
from tpss.numerics.pairs import apply, compose, scaled, squared
from tpss.powerflow.chain import CHECK, LINKED, MOVED, WARM, Pass, push_load, train_current
from tpss.powerflow.groups import Conductor, Groups
from tpss.powerflow.network import UNFED, Flow, Loads, Network


def _stands_alone(*_: Any) -> bool:
    """`is_coupled` where there are no groups."""
    return False


@where_any(without=_stands_alone)
def is_coupled(groups: Groups, s: int) -> bool:
    """Whether section `s` is one of a group."""
    return bool(groups.is_coupled[at(s)])


@fused
def has_derivatives(start: Pass) -> bool:
    """Whether a pass has derivatives."""
    return start != CHECK and start != MOVED


@inlined
def _begin_piece(conductor: Conductor, flow: Flow) -> None:
    """Let the piece ahead of a conductor's point begin."""
    solution = flow.sections[at(conductor.section)]
    conductor.piece_m = solution.closing_m
    if conductor.next < solution.end:
        conductor.piece_m = flow.standing[at(conductor.next)].piece_m
    conductor.ahead_m = conductor.piece_m


@kernel
def _begin(g: int, start: Pass, network: Network, flow: Flow) -> None:
    """Put a group's conductors to its start, with the half shunts of their first pieces."""
    n, w = network.groups.size[at(g)], flow.groups.sensitivity
    w[:] = 0.0
    for k in range(n):
        conductor = flow.groups.conductors[at(k)]
        conductor.section = network.groups.section[at(g), at(k)]
        section, solution = (
            network.sections[at(conductor.section)],
            flow.sections[at(conductor.section)],
        )
        conductor.next, conductor.is_open = solution.first, True
        conductor.is_fed = network.source_of_node[at(section.start_node)] != UNFED
        _begin_piece(conductor, flow)
        shunt = complex(0.0, 0.5 * section.susceptance_s_per_m * conductor.piece_m)
        conductor.voltage_v = flow.nodes[at(section.start_node)].voltage_v
        conductor.current_a = solution.current_a - shunt * conductor.voltage_v
        if has_derivatives(start):
            w[0, k, k, 0] = 1.0
            w[1, k, k, 0] = -shunt
            w[1, k, n + k, 0] = 1.0


@inlined
def _nearest(n: int, flow: Flow) -> int:
    """Conductor whose next point is nearest; -1 at the end of all."""
    nearest = -1
    for k in range(n):
        conductor = flow.groups.conductors[at(k)]
        if conductor.is_open and (
            nearest < 0 or conductor.ahead_m < flow.groups.conductors[at(nearest)].ahead_m
        ):
            nearest = k
    return nearest


@inlined
def _push_piece(n: int, length_m: float, derivatives: bool, network: Network, flow: Flow) -> float:
    """Push all conductors of a group over a piece between neighbouring points; return its losses. [W]"""
    conductors, w = flow.groups.conductors, flow.groups.sensitivity
    section = network.sections[at(conductors[0].section)]
    common = scaled(network.groups.mutual_ohm_per_m[at(conductors[0].section)], length_m)
    whole = scaled(section.impedance_ohm_per_m, length_m)
    total, squares = 0j, 0.0
    for k in range(n):
        if conductors[at(k)].is_open and conductors[at(k)].is_fed:
            total += conductors[at(k)].current_a
            squares += squared(conductors[at(k)].current_a)
    for k in range(n):
        conductor = conductors[at(k)]
        if not conductor.is_open:
            continue
        conductor.ahead_m -= length_m
        conductor.voltage_v -= whole * conductor.current_a
        if conductor.is_fed:
            conductor.voltage_v -= common * (total - conductor.current_a)
    if derivatives:
        for c in range(2 * n):
            total_p, total_q = 0j, 0j
            for k in range(n):
                if conductors[at(k)].is_open and conductors[at(k)].is_fed:
                    total_p += w[1, k, c, 0]
                    total_q += w[1, k, c, 1]
            for k in range(n):
                if not conductors[at(k)].is_open:
                    continue
                w[0, k, c, 0] -= whole * w[1, k, c, 0]
                w[0, k, c, 1] -= whole * w[1, k, c, 1]
                if conductors[at(k)].is_fed:
                    w[0, k, c, 0] -= common * (total_p - w[1, k, c, 0])
                    w[0, k, c, 1] -= common * (total_q - w[1, k, c, 1])
    return (whole.real - common.real) * squares + common.real * squared(total)


@inlined
def _pass_train(
    m: int, n: int, scale: float, start: Pass, network: Network, flow: Flow, loads: Loads
) -> None:
    """The train at the next point of conductor `m`, and the half shunts of both pieces there."""
    conductor, w = flow.groups.conductors[at(m)], flow.groups.sensitivity
    place = flow.standing[at(conductor.next)]
    linked = start >= LINKED
    load, y1, y2 = train_current(
        place.train,
        place.voltage_v if linked else conductor.voltage_v,
        scale,
        WARM if linked else start,
        network.system.base_voltage_v,
        loads,
    )
    if linked:
        change = conductor.voltage_v - place.voltage_v
        load += y1 * change + y2 * change.conjugate()
        if start == MOVED:
            flow.search[0].moved_v = max(flow.search[0].moved_v, math.sqrt(squared(change)))
    if start != LINKED:
        place.voltage_v = conductor.voltage_v
    before_m = conductor.piece_m
    conductor.next += 1
    _begin_piece(conductor, flow)
    half_b = 0.5 * network.sections[at(conductor.section)].susceptance_s_per_m
    shunt = complex(0.0, half_b * (before_m + conductor.piece_m))
    conductor.current_a -= load + shunt * conductor.voltage_v
    if has_derivatives(start):
        y1 += shunt
        for c in range(2 * n):
            w[1, m, c, 0], w[1, m, c, 1] = push_load(
                y1, y2, w[0, m, c, 0], w[0, m, c, 1], w[1, m, c, 0], w[1, m, c, 1]
            )


@inlined
def _end(m: int, n: int, start: Pass, network: Network, flow: Flow) -> None:
    """The end of conductor `m`, and the half shunt of the piece before it."""
    conductor, w = flow.groups.conductors[at(m)], flow.groups.sensitivity
    section, solution = (
        network.sections[at(conductor.section)],
        flow.sections[at(conductor.section)],
    )
    shunt = complex(0.0, 0.5 * section.susceptance_s_per_m * conductor.piece_m)
    solution.end_current_a = conductor.current_a - shunt * conductor.voltage_v
    solution.gap_v = conductor.voltage_v - flow.nodes[at(section.end_node)].voltage_v
    flow.nodes[at(section.start_node)].leaving_current_a += solution.current_a
    flow.nodes[at(section.end_node)].leaving_current_a -= solution.end_current_a
    conductor.is_open = False
    if has_derivatives(start):
        for c in range(2 * n):
            w[1, m, c, 0] -= shunt * w[0, m, c, 0]
            w[1, m, c, 1] -= shunt * w[0, m, c, 1]


@inlined
def _push_group(
    g: int, scale: float, start: Pass, network: Network, flow: Flow, loads: Loads
) -> None:
    """Push the conductors of group `g` from their starts to their ends, and join them to their nodes."""
    _begin(g, start, network, flow)
    n, lost_w, derivatives = network.groups.size[at(g)], 0.0, has_derivatives(start)
    m = _nearest(n, flow)
    while m >= 0:
        conductor = flow.groups.conductors[at(m)]
        lost_w += _push_piece(n, conductor.ahead_m, derivatives, network, flow)
        if conductor.next < flow.sections[at(conductor.section)].end:
            _pass_train(m, n, scale, start, network, flow, loads)
        else:
            _end(m, n, start, network, flow)
        m = _nearest(n, flow)
    flow.groups.lost_w[at(g)] = lost_w


@kernel
def _add(block: Block, p: complex, q: complex) -> None:
    block.p += p
    block.q += q


@inlined
def _stamp_group(g: int, network: Network, flow: Flow) -> float:
    """Add a group's blocks and gap currents to the node system; return the sign of det B."""
    n, w = network.groups.size[at(g)], flow.groups.sensitivity
    rows, place = flow.groups.rows[at(g), :n, : 3 * n], network.groups.place[at(g)]
    # 1. δI = B⁻¹ (δV_b - A δV_a - g).
    for k in range(n):
        for j in range(n):
            for part in range(2):
                rows[k, j, part] = w[0, k, n + j, part]
                rows[k, n + j, part] = 0.0
                rows[k, 2 * n + j, part] = w[0, k, j, part]
        rows[k, n + k, 0] = 1.0
    sign = eliminate(rows)
    for k in range(n):
        section = network.sections[at(network.groups.section[at(g), at(k)])]
        start, end = flow.nodes[at(section.start_node)], flow.nodes[at(section.end_node)]
        for j in range(n):
            gap_v = flow.sections[at(network.groups.section[at(g), at(j)])].gap_v
            bi_p, bi_q = rows[k, n + j, 0], rows[k, n + j, 1]
            _add(flow.blocks[at(place[k, n + j])], bi_p, bi_q)
            _add(flow.blocks[at(place[k, j])], -rows[k, 2 * n + j, 0], -rows[k, 2 * n + j, 1])
            start.right_side += apply(bi_p, bi_q, gap_v)
            # 2. The end currents, C δV_a + D δI.
            db_p, db_q, dba_p, dba_q = 0j, 0j, 0j, 0j
            for i in range(n):
                d_p, d_q = w[1, k, n + i, 0], w[1, k, n + i, 1]
                p, q = compose(d_p, d_q, rows[i, n + j, 0], rows[i, n + j, 1])
                db_p, db_q = db_p + p, db_q + q
                p, q = compose(d_p, d_q, rows[i, 2 * n + j, 0], rows[i, 2 * n + j, 1])
                dba_p, dba_q = dba_p + p, dba_q + q
            _add(flow.blocks[at(place[n + k, n + j])], -db_p, -db_q)
            _add(flow.blocks[at(place[n + k, j])], dba_p - w[1, k, j, 0], dba_q - w[1, k, j, 1])
            end.right_side -= apply(db_p, db_q, gap_v)
    return sign


def _no_more_gaps(
    _groups: Groups, largest: float, merit: float, sign: float, *_: Any
) -> tuple[float, float, float]:
    """`evaluate_groups` of no groups."""
    return largest, merit, sign


@where_any(without=_no_more_gaps)
def evaluate_groups(
    groups: Groups, largest: float, merit: float, sign: float, scale: float, start: Pass,
    network: Network, flow: Flow, loads: Loads,
) -> tuple[float, float, float]:  # fmt: skip
    """Push all groups of coupled sections, and join them to their nodes.

    Parameters
    ----------
    groups : Groups
        Those of the network.
    largest, merit, sign : float
        Of the sections that stand alone: the largest square of the power that a gap causes, the sum of
        squares of the gaps, both in per unit, and the sign of their determinants.
    scale : float
        Factor on all loads. [1]
    start : Pass

    Returns
    -------
    largest, merit, sign : float
        Of all sections; the sign only of passes with derivatives.
    """
    for g in range(groups.size.size):
        _push_group(g, scale, start, network, flow, loads)
        for k in range(groups.size[at(g)]):
            s = groups.section[at(g), at(k)]
            square = squared(flow.sections[at(s)].gap_v) * network.system.per_square_volt
            largest = max(largest, square * network.sections[at(s)].gap_weight)
            merit += square
        if has_derivatives(start):
            sign *= _stamp_group(g, network, flow)
    return largest, merit, sign


def _no_more_directions(*_: Any) -> None:
    """`direct_groups` of no groups."""


@where_any(without=_no_more_directions)
def direct_groups(groups: Groups, network: Network, flow: Flow) -> None:
    """Newton steps of the currents that enter the sections of groups, from those of the nodes."""
    for g in range(groups.size.size):
        n = groups.size[at(g)]
        for k in range(n):
            change_a, row = 0j, flow.groups.rows[at(g), k]
            for j in range(n):
                s = groups.section[at(g), at(j)]
                section, gap_v = network.sections[at(s)], flow.sections[at(s)].gap_v
                start_v = flow.nodes[at(section.start_node)].direction_v
                end_v = flow.nodes[at(section.end_node)].direction_v
                change_a += apply(row[n + j, 0], row[n + j, 1], end_v - gap_v)
                change_a -= apply(row[2 * n + j, 0], row[2 * n + j, 1], start_v)
            flow.sections[at(groups.section[at(g), at(k)])].direction_a = change_a


def _no_losses(*_: Any) -> float:
    """`losses_of_groups` of no groups. [W]"""
    return 0.0


@where_any(without=_no_losses)
def losses_of_groups(groups: Groups, flow: Flow) -> float:
    """Losses of all groups at the last evaluation. [W]"""
    lost_w = 0.0
    for g in range(groups.size.size):
        lost_w += flow.groups.lost_w[at(g)]
    return lost_w
