"""Points of bundles: the trains under them in order, and the voltages of all conductors at each."""

import math
from typing import Any

from tpss.kernel import at, inlined, kernel, where_any
from tpss.powerflow.bundles import Bundles
from tpss.powerflow.network import SHORTEST_PIECE_M, Flow, Network


def _stands_alone(*_: Any) -> bool:
    """`is_bundled` where there are no bundles."""
    return False


@where_any(without=_stands_alone)
def is_bundled(bundles: Bundles, s: int) -> bool:
    """Whether section `s` is a conductor of a bundle."""
    return bool(bundles.is_bundled[at(s)])


def _no_points(*_: Any) -> None:
    """Where there are no bundles."""


@where_any(without=_no_points)
def order_points(bundles: Bundles, network: Network, flow: Flow) -> None:
    """Put the trains under bundles in order, from their places under each section."""
    found, own = 0, flow.bundles
    own.is_under[:] = False
    for g in range(bundles.size.size):
        n = bundles.size[at(g)]
        for c in range(n):
            own.next[at(c)] = flow.sections[at(bundles.section[at(g), at(c)])].first
        own.first[at(g)] = found
        section = network.sections[at(bundles.section[at(g), 0])]
        before_m, c = section.start_m, _nearest(g, n, bundles, flow)
        while c >= 0:
            point, k = own.points[at(found)], own.next[at(c)]
            place_m = flow.standing[at(k)].place_m
            point.standing, point.conductor = k, c
            _begin_state(found, g, n, flow.standing[at(k)].train, network, flow)
            point.piece_m = max(SHORTEST_PIECE_M, place_m - before_m)
            before_m, found = place_m, found + 1
            own.next[at(c)] += 1
            c = _nearest(g, n, bundles, flow)
        own.closing_m[at(g)] = max(SHORTEST_PIECE_M, section.end_m - before_m)
    own.first[at(bundles.size.size)] = found


@where_any(without=_no_points)
def start_bundles(bundles: Bundles, network: Network, flow: Flow) -> None:
    """Let all trains have the voltages of the start nodes of their bundles."""
    own = flow.bundles
    for g in range(bundles.size.size):
        for p in range(own.first[at(g)], own.first[at(g + 1)]):
            train = flow.standing[at(own.points[at(p)].standing)].train
            for c in range(bundles.size[at(g)]):
                s = bundles.section[at(g), at(c)]
                start_v = flow.nodes[at(network.sections[at(s)].start_node)].voltage_v
                own.voltage_v[at(train), at(c)] = start_v


@inlined
def _begin_state(p: int, g: int, n: int, train: int, network: Network, flow: Flow) -> None:
    """Let a train of which nothing is known have the voltages of the point before it."""
    own = flow.bundles
    own.is_under[at(train)] = True
    if own.known[at(train)] == 0:
        for c in range(n):
            own.voltage_v[at(train), at(c)] = voltage_before(p, g, c, network, flow)


@kernel
def _nearest(g: int, n: int, bundles: Bundles, flow: Flow) -> int:
    """Conductor whose next train stands nearest to the start of a bundle; -1: there is none."""
    nearest, nearest_m = -1, math.inf
    for c in range(n):
        k = flow.bundles.next[at(c)]
        if k < flow.sections[at(bundles.section[at(g), at(c)])].end:
            place_m = flow.standing[at(k)].place_m
            if nearest < 0 or place_m < nearest_m:
                nearest, nearest_m = c, place_m
    return nearest


@kernel
def voltage_before(p: int, g: int, c: int, network: Network, flow: Flow) -> complex:
    """Voltage of conductor `c` at the point before point `p` of bundle `g`. [V]"""
    if p > flow.bundles.first[at(g)]:
        i = flow.standing[at(flow.bundles.points[at(p - 1)].standing)].train
        return flow.bundles.voltage_v[at(i), at(c)]
    s = network.bundles.section[at(g), at(c)]
    return flow.nodes[at(network.sections[at(s)].start_node)].voltage_v


@kernel
def voltage_at(p: int, g: int, c: int, network: Network, flow: Flow) -> complex:
    """Voltage of conductor `c` at point `p` of bundle `g`, or at its end behind the last one. [V]"""
    if p < flow.bundles.first[at(g + 1)]:
        i = flow.standing[at(flow.bundles.points[at(p)].standing)].train
        return flow.bundles.voltage_v[at(i), at(c)]
    s = network.bundles.section[at(g), at(c)]
    return flow.nodes[at(network.sections[at(s)].end_node)].voltage_v


@kernel
def piece_after_m(p: int, g: int, flow: Flow) -> float:
    """Length of the piece behind point `p` of bundle `g`. [m]"""
    if p + 1 < flow.bundles.first[at(g + 1)]:
        return flow.bundles.points[at(p + 1)].piece_m
    return flow.bundles.closing_m[at(g)]
