"""The audit of bundles: currents of all conductors, piece by piece, from the recorded voltages.

At a train the current that arrives in the contact line and does not go on is the train's; the same
current leaves by the conductor to which it returns, and all others carry on what arrives.
"""

import math
from typing import Any

from tpss.audit.balances import Scratch, audit_demand, worst
from tpss.kernel import inlined, kernel, where_any
from tpss.numerics.pairs import magnitude, scaled
from tpss.powerflow.bundles import EARTH, Bundles
from tpss.powerflow.network import SHORTEST_PIECE_M, UNFED, Network
from tpss.step.model import Model
from tpss.step.recording import Recording


def _pass_nothing(_bundles: Bundles, _s: int, first: int, *_: Any) -> int:
    """`pass_bundled` where there are no bundles."""
    return first


@where_any(without=_pass_nothing)
def pass_bundled(_bundles: Bundles, s: int, first: int, count: int, scratch: Scratch) -> int:
    """Leave the trains under section `s`, from the first one on, for later; return the next train."""
    scratch.bundles.first[s] = k = first
    while k < count and scratch.section[scratch.order[k]] == s:
        k += 1
    scratch.bundles.end[s] = k
    return k


def _together(_bundles: Bundles, _trains: int) -> float:
    """`balances_apart` where there are no bundles: a section's trains are balanced with its ends."""
    return 1.0


@where_any(without=_together)
def balances_apart(_bundles: Bundles, trains: int) -> float:
    """How many balances the solver holds to its tolerance apart: each train under a bundle has one."""
    return float(max(trains, 1))


def _audit_nothing(*_: Any) -> None:
    """`audit_bundles` of no bundles."""


@where_any(without=_audit_nothing)
def audit_bundles(
    bundles: Bundles, step: int, model: Model, recording: Recording, scratch: Scratch
) -> None:
    """Mismatch of the trains under bundles, and what these let leave their nodes."""
    network, own = model.network, scratch.bundles
    for g in range(bundles.size.size):
        n = _begin(g, network, scratch)
        section = network.sections[bundles.section[g, 0]]
        train, conductor, place_m = -1, 0, section.start_m
        while True:
            # 1. The piece ahead, from the point before to the next train or the end.
            c = _nearest(g, n, bundles, scratch)
            after, after_m = -1, section.end_m
            if c >= 0:
                after = scratch.order[own.next[c]]
                after_m = scratch.place_m[after]
            _look_ahead(step, g, n, after, network, recording, scratch)
            length_m = max(SHORTEST_PIECE_M, after_m - place_m)
            _find_currents(g, n, length_m, bundles, scratch)
            # 2. The balance of the point before it.
            if train < 0:
                _leave_start(g, n, network, scratch)
            else:
                _audit_train(step, train, conductor, g, n, bundles, recording, scratch)
            for k in range(n):
                own.arriving_a[k], own.before_v[k] = own.ahead_a[k], own.after_v[k]
            if c < 0:
                break
            own.next[c] += 1
            train, conductor, place_m = after, c, after_m
        _arrive_at_end(g, n, network, scratch)


@inlined
def _begin(g: int, network: Network, scratch: Scratch) -> int:
    """Put a bundle to its start; return the number of its conductors."""
    own, bundles = scratch.bundles, network.bundles
    for c in range(bundles.size[g]):
        s = bundles.section[g, c]
        start_node = network.sections[s].start_node
        is_dead = network.source_of_node[start_node] == UNFED
        own.next[c] = own.end[s] if is_dead else own.first[s]
        own.before_v[c] = scratch.node_v[start_node]
    return bundles.size[g]


@inlined
def _nearest(g: int, n: int, bundles: Bundles, scratch: Scratch) -> int:
    """Conductor whose next train stands nearest to the start of a bundle; -1: there is none."""
    own, nearest, nearest_m = scratch.bundles, -1, math.inf
    for c in range(n):
        if own.next[c] < own.end[bundles.section[g, c]]:
            place_m = scratch.place_m[scratch.order[own.next[c]]]
            if nearest < 0 or place_m < nearest_m:
                nearest, nearest_m = c, place_m
    return nearest


@inlined
def _look_ahead(
    step: int, g: int, n: int, train: int, network: Network, recording: Recording, scratch: Scratch
) -> None:
    """Voltages at the end of the piece ahead: at a train, or at the end nodes."""
    for c in range(n):
        if train >= 0:
            scratch.bundles.after_v[c] = recording.conductors[step, train, c]
        else:
            end_node = network.sections[network.bundles.section[g, c]].end_node
            scratch.bundles.after_v[c] = scratch.node_v[end_node]


@inlined
def _find_currents(g: int, n: int, length_m: float, bundles: Bundles, scratch: Scratch) -> None:
    """Currents that leave into the piece ahead, and those that arrive at its end."""
    own = scratch.bundles
    for c in range(n):
        along, before, after = 0j, 0j, 0j
        for k in range(n):
            series = scaled(bundles.series_s_m[g, c, k], 1.0 / length_m)
            shunt = scaled(bundles.shunt_s_per_m[g, c, k], 0.5 * length_m)
            along += series * (own.before_v[k] - own.after_v[k])
            before += shunt * own.before_v[k]
            after += shunt * own.after_v[k]
        own.leaving_a[c], own.ahead_a[c] = along + before, along - after


@inlined
def _leave_start(g: int, n: int, network: Network, scratch: Scratch) -> None:
    for c in range(n):
        start_node = network.sections[network.bundles.section[g, c]].start_node
        scratch.leaving_a[start_node] += scratch.bundles.leaving_a[c]


@inlined
def _arrive_at_end(g: int, n: int, network: Network, scratch: Scratch) -> None:
    for c in range(n):
        end_node = network.sections[network.bundles.section[g, c]].end_node
        scratch.leaving_a[end_node] -= scratch.bundles.arriving_a[c]


@kernel
def _audit_train(
    step: int, i: int, conductor: int, g: int, n: int, bundles: Bundles, recording: Recording,
    scratch: Scratch,
) -> None:  # fmt: skip
    """Mismatch of a train, of the conductor to which it returns, and of those that it does not touch."""
    own, figures, row = scratch.bundles, scratch.balances[0], recording.trains[step, i]
    returns = bundles.returns[g, conductor]
    voltage = complex(row.pantograph_real, row.pantograph_imag)
    drawn_a = own.arriving_a[conductor] - own.leaving_a[conductor]
    audit_demand(step, i, voltage, drawn_a, recording, figures)
    between_v = own.before_v[conductor]
    if returns != EARTH:
        between_v -= own.before_v[returns]
    off = magnitude(between_v - voltage) * magnitude(drawn_a)
    figures.power_mismatch_va = worst(figures.power_mismatch_va, off)
    for c in range(n):
        if c != conductor:
            rest_a = own.arriving_a[c] - own.leaving_a[c]
            if c == returns:
                rest_a += drawn_a
            off = magnitude(voltage) * magnitude(rest_a)
            figures.power_mismatch_va = worst(figures.power_mismatch_va, off)
