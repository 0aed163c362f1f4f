r"""A contact-line section as a chain: push voltage and current from its start to its end.

Between two points a piece of line is a π-section: half of its shunt susceptance at either end, its
impedance z between.  At a train the current drops by what the train takes.  With voltage V and
current I (towards the section's end),

    piece:  V ← V - z I            train:  I ← I - i(V) - j b V,   i(V) = conj(S(|V|) / V)

where b joins the half shunts of the two pieces that meet there.  The sensitivities to the start
voltage and the start current go along by the same rules, as pairs (see `pairs`); a train's is

    δi = y₁ δV + y₂ δV̄,   y₁ = conj(S') / (2 |V|),   y₂ = y₁ V / V̄ - conj(S) / V̄²

with S' = dP/d|V| + j dQ/d|V|.  A train costs one visit; pieces may be arbitrarily short, and the
state (start voltage, start current) does not depend on which trains stand in between.

References
----------
[Boullanger2009]_, eq. (F.31), (F.32), (F.35)-(F.38), there with an admittance matrix.
"""

import math
from typing import Any

from tpss.kernel import inlined, kernel
from tpss.physics.constants import BASE_VOLTAGE_V
from tpss.physics.locomotive import electrical_demand
from tpss.powerflow.network import Complexes, Flow, Loads, Network
from tpss.powerflow.pairs import squared

WARM = 0
"""A pass takes the trains' currents at the voltages of the state, and finds all derivatives."""
FLAT = 1
"""... takes the currents at base voltage, as if they did not depend on the voltage."""
CHECK = 2
"""... is a warm one without derivatives: for a state that is expected to be the solution."""

SHORTEST_PIECE_M = 1.0
"""Trains closer than this to each other or to a node count as this far away. [m]"""


@inlined
def sort_by_position(standing: Any, count: int, trains: Any) -> None:
    """Sort the first `count` places by the trains' positions; equal ones keep their number's order.

    Trains hardly ever pass each other, so an insertion sort visits each of them once.
    """
    for k in range(1, count):
        train = standing[k].train
        at_m = trains[train].position_m
        at = k
        while at > 0 and trains[standing[at - 1].train].position_m > at_m:
            standing[at].train = standing[at - 1].train
            at -= 1
        standing[at].train = train


@kernel
def place_trains(count: int, trains: Any, network: Network, flow: Flow) -> int:
    """Assign sorted trains to sections, measure the pieces between them, count those too short.

    Parameters
    ----------
    count : int
        Number of trains in `flow.standing`, sorted by position.
    trains : records
        With the field `position_m`. [m]
    """
    short = 0
    k = 0
    last = network.sections.size - 1
    for s in range(last + 1):
        section = network.sections[s]
        before_m = section.start_m
        flow.sections[s].first = k
        while k < count and (
            s == last or trains[flow.standing[k].train].position_m < section.end_m
        ):
            at_m = trains[flow.standing[k].train].position_m
            flow.standing[k].piece_m = max(SHORTEST_PIECE_M, at_m - before_m)
            short += at_m - before_m < SHORTEST_PIECE_M
            before_m = at_m
            k += 1
        flow.sections[s].end = k
        flow.sections[s].closing_m = max(SHORTEST_PIECE_M, section.end_m - before_m)
        short += section.end_m - before_m < SHORTEST_PIECE_M
    return short


@kernel
def train_current(
    i: int, voltage: complex, scale: float, start: int, loads: Loads
) -> tuple[complex, complex, complex]:
    """Current that train `i` takes [A], and its derivative as a pair [S].

    Parameters
    ----------
    i : int
        The train.
    voltage : complex
        Voltage at its pantograph. [V]
    scale : float
        Factor on its load, 1 for the whole. [1]
    start : int
        `WARM`, `FLAT` or `CHECK`.
    """
    if start == FLAT:
        voltage = complex(BASE_VOLTAGE_V, 0.0)
    square = squared(voltage)
    magnitude = math.sqrt(square)
    train = loads.trains[i]
    p, q, p_slope, q_slope = electrical_demand(
        magnitude, loads.types[train.train_type], train, loads.machine[0]
    )
    # 1 / conj(V) = V / |V|²
    current = scale * complex(p, -q) * (voltage / square)
    if start == FLAT:
        return current, 0j, 0j
    y1 = scale * complex(p_slope, -q_slope) / (2.0 * magnitude)
    y2 = (y1 * voltage - current) * (voltage / square)
    return current, y1, y2


@kernel
def _push_piece(z: complex, w: Complexes) -> None:
    for by in range(2):
        for part in range(2):
            w[0, by, part] -= z * w[1, by, part]


@kernel
def _push_load(y1: complex, y2: complex, w: Complexes) -> None:
    for by in range(2):
        p, q = w[0, by, 0], w[0, by, 1]
        w[1, by, 0] -= y1 * p + y2 * q.conjugate()
        w[1, by, 1] -= y1 * q + y2 * p.conjugate()


@kernel
def run_chain(
    s: int, scale: float, start: int, network: Network, flow: Flow, loads: Loads
) -> complex:
    """Push section `s` from its start to its end; return the voltage there. [V]

    Writes the trains' voltages and the end current into `flow`, the sensitivities of end voltage
    and end current into `flow.sensitivity`.
    """
    section, found = network.sections[s], flow.sections[s]
    z = section.impedance_ohm_per_m
    half_jb = 0.5j * section.susceptance_s_per_m
    voltage = flow.nodes[section.start_node].voltage_v
    current = found.current_a
    w = flow.sensitivity
    w[:] = 0.0
    w[0, 0, 0] = 1.0
    w[1, 1, 0] = 1.0
    shunt = 0j
    for k in range(found.first, found.end):
        # 1. The piece before the train, with its half shunt at the start.
        place = flow.standing[k]
        shunt += half_jb * place.piece_m
        impedance = z * place.piece_m
        current -= shunt * voltage
        voltage -= impedance * current
        # 2. The train; the half shunt at the piece's end waits for that of the next piece.
        load, y1, y2 = train_current(place.train, voltage, scale, start, loads)
        place.voltage_v = voltage
        current -= load
        if start != CHECK:
            _push_load(shunt, 0j, w)
            _push_piece(impedance, w)
            _push_load(y1, y2, w)
        shunt = half_jb * place.piece_m
    # 3. The piece before the end node.
    half_shunt = half_jb * found.closing_m
    impedance = z * found.closing_m
    shunt += half_shunt
    current -= shunt * voltage
    voltage -= impedance * current
    current -= half_shunt * voltage
    if start != CHECK:
        _push_load(shunt, 0j, w)
        _push_piece(impedance, w)
        _push_load(half_shunt, 0j, w)
    found.end_current_a = current
    return voltage
