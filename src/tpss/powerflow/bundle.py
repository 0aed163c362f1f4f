r"""A bundle of conductors: eliminate the trains, one after the other, from its start to its end.

Between neighbouring points (trains on any of its tracks, ends) a piece of length l is a π-section of
matrices: the series impedance Z l between, half of the shunt admittance Y l at either end.  With the
voltages V_j of all n conductors at point j, and the train's current i from its contact line c to the
conductor r to which it returns,

    0 = (Z l_j)⁻¹ (V_j - V_{j-1}) + (Z l_{j+1})⁻¹ (V_j - V_{j+1}) + ½ Y (l_j + l_{j+1}) V_j
        + (e_c - e_r) i(V_c - V_r)

The V_j are unknowns of Newton's method, beside those of the nodes.  To push voltages and currents along,
as `chain` does, would not do: where rails leak to earth, rounding grows as exp(γ L), by fourteen orders
of magnitude over 60 km.  So the trains are eliminated, point by point: with what is left of the equation
of the point before,

    δV_{j-1} = R - L δV_a - U δV_j

over the start nodes a and the point ahead, that of point j is

    (D_j + y_j U) δV_j + y_j L δV_a - y_{j+1} δV_{j+1} = -F_j + y_j R,      y_j = (Z l_j)⁻¹,

and nothing grows.  What the start nodes see of the point ahead, A δV_j, goes along: A ← -A U.  At the
end, blocks between the nodes of the bundle are left, as of a group of coupled sections.

A train adds a pair to four blocks of its point, a line is complex-linear; the determinants of the D_j
are factors of that of the whole system, so that its sign is told as by `newton`.

References
----------
[Carson1926]_, on the matrices; the elimination above.
"""

import math
from typing import Any

from tpss.kernel import at, inlined, kernel, where_any
from tpss.numerics.pairs import apply, scaled, squared
from tpss.powerflow.bundle_elimination import begin_elimination, eliminate_point, end_elimination
from tpss.powerflow.bundle_points import piece_after_m, voltage_at, voltage_before
from tpss.powerflow.bundles import EARTH, Bundles
from tpss.powerflow.chain import LINKED, MOVED, WARM, Pass, train_current
from tpss.powerflow.coupled import has_derivatives
from tpss.powerflow.network import Flow, Loads, Network


@kernel
def _along_piece(p: int, g: int, piece_m: float, network: Network, flow: Flow) -> float:
    """Let the currents along the piece before point `p` leave what it joins; return its losses. [W]"""
    n, own, bundles, lost_w = network.bundles.size[at(g)], flow.bundles, network.bundles, 0.0
    is_first, is_last = p == own.first[at(g)], p == own.first[at(g + 1)]
    for k in range(n):
        drop_v = voltage_before(p, g, k, network, flow) - voltage_at(p, g, k, network, flow)
        own.drop_v[at(k)] = scaled(drop_v, 1.0 / piece_m)
    for c in range(n):
        current = 0j
        for k in range(n):
            current += bundles.series_s_m[at(g), at(c), at(k)] * own.drop_v[at(k)]
        lost_w += piece_m * (own.drop_v[at(c)] * current.conjugate()).real
        solution = flow.sections[at(bundles.section[at(g), at(c)])]
        if is_first:
            solution.current_a = current
        else:
            own.rest_a[at(p - 1), at(c)] += current
        if is_last:
            solution.end_current_a = current
        else:
            own.rest_a[at(p), at(c)] = -current
    return lost_w


@kernel
def _across(g: int, c: int, p: int, length_m: float, network: Network, flow: Flow) -> complex:
    """Current that leaves conductor `c` over a length of line, at the voltages before point `p`. [A]"""
    current = 0j
    for k in range(network.bundles.size[at(g)]):
        shunt = network.bundles.shunt_s_per_m[at(g), at(c), at(k)]
        current += shunt * voltage_before(p, g, k, network, flow)
    return scaled(current, length_m)


@inlined
def _leave_ends(g: int, network: Network, flow: Flow) -> float:
    """Add a bundle's currents at its ends to those that leave its nodes; return losses across. [W]"""
    own, lost_w = flow.bundles, 0.0
    first, last = own.first[at(g)], own.first[at(g + 1)]
    begin_m = own.closing_m[at(g)] if first == last else own.points[at(first)].piece_m
    for c in range(network.bundles.size[at(g)]):
        s = network.bundles.section[at(g), at(c)]
        section, solution = network.sections[at(s)], flow.sections[at(s)]
        start, end = flow.nodes[at(section.start_node)], flow.nodes[at(section.end_node)]
        across = _across(g, c, first, 0.5 * begin_m, network, flow)
        solution.current_a += across
        start.leaving_current_a += solution.current_a
        lost_w += (start.voltage_v * across.conjugate()).real
        across = _across_end(g, c, 0.5 * own.closing_m[at(g)], network, flow)
        solution.end_current_a -= across
        end.leaving_current_a -= solution.end_current_a
        lost_w += (end.voltage_v * across.conjugate()).real
    return lost_w


@inlined
def _across_end(g: int, c: int, length_m: float, network: Network, flow: Flow) -> complex:
    """`_across` at the voltages of the end nodes. [A]"""
    current, bundles = 0j, network.bundles
    for k in range(bundles.size[at(g)]):
        end_node = network.sections[at(bundles.section[at(g), at(k)])].end_node
        shunt = bundles.shunt_s_per_m[at(g), at(c), at(k)]
        current += shunt * flow.nodes[at(end_node)].voltage_v
    return scaled(current, length_m)


@inlined
def _balance_point(
    p: int, g: int, scale: float, start: Pass, network: Network, flow: Flow, loads: Loads
) -> tuple[float, float]:
    """Add the train at point `p`, and what leaves across there, to what leaves along the line.

    Return the sum of the squares of the residuals [A²], and the losses across [W].
    """
    own, point, total, lost_w = flow.bundles, flow.bundles.points[at(p)], 0.0, 0.0
    load, y1, y2 = _train_at(p, g, scale, start, network, flow, loads)
    r = network.bundles.returns[at(g), at(point.conductor)]
    own.rest_a[at(p), at(point.conductor)] += load
    if r != EARTH:
        own.rest_a[at(p), at(r)] -= load
    own.pair_s[at(p), 0], own.pair_s[at(p), 1] = y1, y2
    half_m = 0.5 * (point.piece_m + piece_after_m(p, g, flow))
    for c in range(network.bundles.size[at(g)]):
        across = _across(g, c, p + 1, half_m, network, flow)
        lost_w += (voltage_before(p + 1, g, c, network, flow) * across.conjugate()).real
        own.rest_a[at(p), at(c)] += across
        total += squared(own.rest_a[at(p), at(c)])
    return total, lost_w


@kernel
def _train_at(
    p: int, g: int, scale: float, start: Pass, network: Network, flow: Flow, loads: Loads
) -> tuple[complex, complex, complex]:
    """Current of the train at point `p` [A], and its derivative as a pair [S]."""
    own, point = flow.bundles, flow.bundles.points[at(p)]
    place = flow.standing[at(point.standing)]
    i, r = place.train, network.bundles.returns[at(g), at(point.conductor)]
    voltage = own.voltage_v[at(i), at(point.conductor)]
    if r != EARTH:
        voltage -= own.voltage_v[at(i), at(r)]
    if start == MOVED:
        moved_v = math.sqrt(squared(voltage - place.voltage_v))
        flow.search[0].moved_v = max(flow.search[0].moved_v, moved_v)
    place.voltage_v = voltage
    linked = start >= LINKED
    return train_current(
        i, voltage, scale, WARM if linked else start, network.system.base_voltage_v, loads
    )


def _no_more_gaps(
    _bundles: Bundles, largest: float, merit: float, sign: float, *_: Any
) -> tuple[float, float, float]:
    """`evaluate_bundles` of no bundles."""
    return largest, merit, sign


@where_any(without=_no_more_gaps)
def evaluate_bundles(
    bundles: Bundles, largest: float, merit: float, sign: float, scale: float, start: Pass,
    network: Network, flow: Flow, loads: Loads,
) -> tuple[float, float, float]:  # fmt: skip
    """Balance all bundles, and join them to their nodes.

    Parameters
    ----------
    bundles : Bundles
        Those of the network.
    largest, merit, sign : float
        Of all that is not bundled, as of `coupled.evaluate_groups`.
    scale : float
        Factor on all loads. [1]
    start : Pass

    Returns
    -------
    largest, merit, sign : float
        With the balances of the trains' points; the sign only of passes with derivatives.
    """
    own, per_square = flow.bundles, network.system.per_square_ampere
    for g in range(bundles.size.size):
        first, last, lost_w = own.first[at(g)], own.first[at(g + 1)], 0.0
        # 1. Along the line, across it at its ends, and what trains take.
        for p in range(first, last + 1):
            piece_m = own.closing_m[at(g)] if p == last else own.points[at(p)].piece_m
            lost_w += _along_piece(p, g, piece_m, network, flow)
        lost_w += _leave_ends(g, network, flow)
        for p in range(first, last):
            square, across_w = _balance_point(p, g, scale, start, network, flow, loads)
            lost_w += across_w
            merit += square * per_square
            largest = max(largest, square * per_square)
        own.lost_w[at(g)] = lost_w
        # 2. The derivatives.
        if has_derivatives(start):
            begin_elimination(g, network, flow)
            for p in range(first, last):
                sign *= eliminate_point(p, g, network, flow)
            end_elimination(g, network, flow)
    return largest, merit, sign


def _no_more_directions(*_: Any) -> None:
    """`direct_bundles` of no bundles."""


@where_any(without=_no_more_directions)
def direct_bundles(bundles: Bundles, network: Network, flow: Flow) -> None:
    """Newton steps of the voltages at the trains, from those of the nodes."""
    own = flow.bundles
    for g in range(bundles.size.size):
        n = bundles.size[at(g)]
        for p in range(own.first[at(g + 1)] - 1, own.first[at(g)] - 1, -1):
            i = flow.standing[at(own.points[at(p)].standing)].train
            for c in range(n):
                row = own.solved[at(p), at(c)]
                change_v = row[at(2 * n), 0] + row[at(2 * n), 1]
                for k in range(n):
                    section = network.sections[at(bundles.section[at(g), at(k)])]
                    start_v = flow.nodes[at(section.start_node)].direction_v
                    if p + 1 < own.first[at(g + 1)]:
                        after = flow.standing[at(own.points[at(p + 1)].standing)].train
                        ahead_v = own.direction_v[at(after), at(k)]
                    else:
                        ahead_v = flow.nodes[at(section.end_node)].direction_v
                    change_v -= apply(row[at(k), 0], row[at(k), 1], start_v)
                    change_v -= apply(row[at(n + k), 0], row[at(n + k), 1], ahead_v)
                own.direction_v[at(i), at(c)] = change_v


def _no_losses(*_: Any) -> float:
    """`losses_of_bundles` of no bundles. [W]"""
    return 0.0


@where_any(without=_no_losses)
def losses_of_bundles(bundles: Bundles, flow: Flow) -> float:
    """Losses of all bundles at the last evaluation, along and across them. [W]"""
    lost_w = 0.0
    for g in range(bundles.size.size):
        lost_w += flow.bundles.lost_w[at(g)]
    return lost_w
