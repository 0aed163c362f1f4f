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
from enum import IntEnum

from tpss.driving.passage import demand_of_passage
from tpss.kernel import at, fused, inlined, kernel, switch
from tpss.numerics.pairs import scaled, squared
from tpss.powerflow.load import demand_with_brakes
from tpss.powerflow.network import Flow, Loads, Network
from tpss.vehicle.demand import electrical_demand
from tpss.vehicle.feed_back import asks_more
from tpss.vehicle.train import Course, Train


class Pass(IntEnum):
    """What an evaluation of the network takes and finds."""

    WARM = 0
    """The trains' currents at the voltages of the state, and all derivatives."""
    FLAT = 1
    """The currents at base voltage, as if they did not depend on the voltage."""
    CHECK = 2
    """As a warm one without derivatives: for a state that is expected to be the solution."""
    LINKED = 3
    """As a warm one, with the trains' currents on their tangents at the voltages of the state."""
    MOVED = 4
    """As a linked one without derivatives, which moves the trains' voltages to those that it finds."""


WARM, FLAT, CHECK = switch(Pass.WARM), switch(Pass.FLAT), switch(Pass.CHECK)
LINKED, MOVED = switch(Pass.LINKED), switch(Pass.MOVED)


@inlined
def train_current(
    i: int, voltage: complex, scale: float, start: Pass, base_v: float, loads: Loads
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
    start : Pass
    base_v : float
        Base voltage. [V]
    loads : Loads
    """
    if start == FLAT:
        voltage = complex(base_v, 0.0)
    square = squared(voltage)
    magnitude = math.sqrt(square)
    train = loads.trains[at(i)]
    if asks_more(loads.types[at(train.train_type)]):
        return _current_with_brakes(voltage, scale, start, train, loads)
    if train.decision.course == Course.PASSAGE:
        return _current_of_passage(voltage, scale, start, train, loads)
    p, q, p_slope, q_slope = electrical_demand(
        magnitude, loads.types[at(train.train_type)], train.demand, loads.scratch
    )
    per_square = 1.0 / square
    reciprocal = scaled(voltage, per_square)  # 1 / conj(V)
    current = complex(scale * p, -scale * q) * reciprocal
    if start == FLAT:
        return current, 0j, 0j
    half = 0.5 * scale * magnitude * per_square
    y1 = complex(half * p_slope, -half * q_slope)
    y2 = (y1 * voltage - current) * reciprocal
    return current, y1, y2


@inlined
def _drawn(
    p: float, q: float, p_slope: float, q_slope: float, voltage: complex, square: float,
    magnitude: float, scale: float, start: Pass,
) -> tuple[complex, complex, complex]:  # fmt: skip
    """`train_current` of a demand and its slopes at a voltage, whose square and magnitude are known."""
    reciprocal = scaled(voltage, 1.0 / square)
    current = complex(scale * p, -scale * q) * reciprocal
    if start == FLAT:
        return current, 0j, 0j
    half = 0.5 * scale / magnitude
    y1 = complex(half * p_slope, -half * q_slope)
    return current, y1, (y1 * voltage - current) * reciprocal


@kernel
def _current_with_brakes(
    voltage: complex, scale: float, start: Pass, train: Train, loads: Loads
) -> tuple[complex, complex, complex]:
    """`train_current` of a train with electric brakes."""
    square = squared(voltage)
    magnitude = math.sqrt(square)
    with_slopes = start != CHECK and start != FLAT
    p, q, p_slope, q_slope = demand_with_brakes(magnitude, with_slopes, train, loads)
    return _drawn(p, q, p_slope, q_slope, voltage, square, magnitude, scale, start)


@kernel
def _current_of_passage(
    voltage: complex, scale: float, start: Pass, train: Train, loads: Loads
) -> tuple[complex, complex, complex]:
    """`train_current` of a train on its passage."""
    square = squared(voltage)
    magnitude = math.sqrt(square)
    p, q, p_slope, q_slope = demand_of_passage(
        magnitude, start != CHECK and start != FLAT, train, loads.types[at(train.train_type)],
        loads.driving, loads.points, loads.scratch,
    )  # fmt: skip
    return _drawn(p, q, p_slope, q_slope, voltage, square, magnitude, scale, start)


@fused
def push_piece(
    z: complex, v_p: complex, v_q: complex, i_p: complex, i_q: complex
) -> tuple[complex, complex]:
    """Sensitivity (v_p, v_q) of the voltage behind a piece of line."""
    return v_p - z * i_p, v_q - z * i_q


@fused
def push_load(
    y1: complex, y2: complex, v_p: complex, v_q: complex, i_p: complex, i_q: complex
) -> tuple[complex, complex]:
    """Sensitivity (i_p, i_q) of the current behind a load."""
    return i_p - y1 * v_p - y2 * v_q.conjugate(), i_q - y1 * v_q - y2 * v_p.conjugate()


@inlined
def run_chain(
    s: int, scale: float, start: Pass, network: Network, flow: Flow, loads: Loads
) -> complex:
    """Push section `s` from its start to its end; return the voltage there. [V]

    Writes the trains' voltages and the end current into `flow`, the sensitivities of end voltage
    and end current into `flow.sensitivity`.
    """
    section, solution = network.sections[at(s)], flow.sections[at(s)]
    z, half_b = section.impedance_ohm_per_m, 0.5 * section.susceptance_s_per_m
    voltage = flow.nodes[at(section.start_node)].voltage_v
    current = solution.current_a
    # Sensitivities: a of the voltage and c of the current to the start voltage, b and d to the
    # start current.
    a_p, a_q, b_p, b_q = 1.0 + 0j, 0j, 0j, 0j
    c_p, c_q, d_p, d_q = 0j, 0j, 1.0 + 0j, 0j
    # 1. The half shunt at the start of the first piece.
    ahead_m = solution.closing_m
    if solution.first < solution.end:
        ahead_m = flow.standing[at(solution.first)].piece_m
    shunt = complex(0.0, half_b * ahead_m)
    current -= shunt * voltage
    c_p -= shunt
    for k in range(solution.first, solution.end):
        # 2. The piece before the train.
        place = flow.standing[at(k)]
        piece_m = ahead_m
        impedance = scaled(z, piece_m)
        voltage -= impedance * current
        place.voltage_v = voltage
        # 3. The train, and the half shunts of the pieces that meet there.
        ahead_m = solution.closing_m if k + 1 == solution.end else flow.standing[at(k + 1)].piece_m
        shunt = complex(0.0, half_b * (piece_m + ahead_m))
        load, y1, y2 = train_current(
            place.train, voltage, scale, start, network.system.base_voltage_v, loads
        )
        current -= load + shunt * voltage
        if start != CHECK:
            y1 += shunt
            a_p, a_q = push_piece(impedance, a_p, a_q, c_p, c_q)
            b_p, b_q = push_piece(impedance, b_p, b_q, d_p, d_q)
            c_p, c_q = push_load(y1, y2, a_p, a_q, c_p, c_q)
            d_p, d_q = push_load(y1, y2, b_p, b_q, d_p, d_q)
    # 4. The piece before the end node, and the half shunt at its end.
    impedance = scaled(z, ahead_m)
    shunt = complex(0.0, half_b * ahead_m)
    voltage -= impedance * current
    solution.end_current_a = current - shunt * voltage
    if start != CHECK:
        w = flow.sensitivity
        w[0, 0, 0], w[0, 0, 1] = push_piece(impedance, a_p, a_q, c_p, c_q)
        w[0, 1, 0], w[0, 1, 1] = push_piece(impedance, b_p, b_q, d_p, d_q)
        w[1, 0, 0], w[1, 0, 1] = c_p - shunt * w[0, 0, 0], c_q - shunt * w[0, 0, 1]
        w[1, 1, 0], w[1, 1, 1] = d_p - shunt * w[0, 1, 0], d_q - shunt * w[0, 1, 1]
    return voltage
