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

Behind many trains whose current falls with the voltage, a rounding at the start of a section is volts
at its end: each train adds its y to the conductance that the push runs against.  The equations are
then so steep in I that Newton's method has to begin very close.  A linked pass takes the trains'
voltages u for unknowns as well: it pushes

    train:  I ← I - (i(u) + y₁ (V - u) + y₂ conj(V - u)) - j b V

which is linear, so that a Newton step holds as far as the trains' currents are straight, and a second
pass of the same kind moves u to V.

References
----------
[Boullanger2009]_, eq. (F.31), (F.32), (F.35)-(F.38), there with an admittance matrix.
"""

import math
from enum import IntEnum

from tpss.driving.passage import demand_of_passage
from tpss.kernel import at, fused, inlined, kernel, switch
from tpss.numerics.pairs import scaled, squared
from tpss.powerflow.network import Flow, Loads, Network
from tpss.vehicle.demand import electrical_demand
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
    """The currents on their tangents at the voltages that the trains have, which stay; derivatives."""
    MOVE = 4
    """As a linked one without derivatives, and the trains take the voltages."""


WARM, FLAT, CHECK = switch(Pass.WARM), switch(Pass.FLAT), switch(Pass.CHECK)
LINKED, MOVE = switch(Pass.LINKED), switch(Pass.MOVE)


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
    reciprocal = scaled(voltage, 1.0 / square)
    current = complex(scale * p, -scale * q) * reciprocal
    if start == FLAT:
        return current, 0j, 0j
    half = 0.5 * scale / magnitude
    y1 = complex(half * p_slope, -half * q_slope)
    return current, y1, (y1 * voltage - current) * reciprocal


@fused
def _push_piece(
    z: complex, v_p: complex, v_q: complex, i_p: complex, i_q: complex
) -> tuple[complex, complex]:
    """Sensitivity (v_p, v_q) of the voltage behind a piece of line."""
    return v_p - z * i_p, v_q - z * i_q


@fused
def _push_load(
    y1: complex, y2: complex, v_p: complex, v_q: complex, i_p: complex, i_q: complex
) -> tuple[complex, complex]:
    """Sensitivity (i_p, i_q) of the current behind a load."""
    return i_p - y1 * v_p - y2 * v_q.conjugate(), i_q - y1 * v_q - y2 * v_p.conjugate()


@fused
def _push_shunt(
    shunt: complex, v_p: complex, v_q: complex, i_p: complex, i_q: complex
) -> tuple[complex, complex]:
    """Sensitivity (i_p, i_q) of the current behind a shunt."""
    return i_p - shunt * v_p, i_q - shunt * v_q


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
            a_p, a_q = _push_piece(impedance, a_p, a_q, c_p, c_q)
            b_p, b_q = _push_piece(impedance, b_p, b_q, d_p, d_q)
            c_p, c_q = _push_load(y1, y2, a_p, a_q, c_p, c_q)
            d_p, d_q = _push_load(y1, y2, b_p, b_q, d_p, d_q)
    # 4. The piece before the end node, and the half shunt at its end.
    impedance = scaled(z, ahead_m)
    shunt = complex(0.0, half_b * ahead_m)
    voltage -= impedance * current
    solution.end_current_a = current - shunt * voltage
    if start != CHECK:
        w = flow.sensitivity
        w[0, 0, 0], w[0, 0, 1] = _push_piece(impedance, a_p, a_q, c_p, c_q)
        w[0, 1, 0], w[0, 1, 1] = _push_piece(impedance, b_p, b_q, d_p, d_q)
        w[1, 0, 0], w[1, 0, 1] = c_p - shunt * w[0, 0, 0], c_q - shunt * w[0, 0, 1]
        w[1, 1, 0], w[1, 1, 1] = d_p - shunt * w[0, 1, 0], d_q - shunt * w[0, 1, 1]
    return voltage


@inlined
def run_linked_chain(
    s: int, scale: float, start: Pass, network: Network, flow: Flow, loads: Loads
) -> complex:
    """As `run_chain`, with the trains' currents on their tangents; return the voltage at the end. [V]

    With `MOVE` it moves the trains' voltages, and notes how far in `flow.search`.
    """
    section, solution = network.sections[at(s)], flow.sections[at(s)]
    z, half_b = section.impedance_ohm_per_m, 0.5 * section.susceptance_s_per_m
    voltage = flow.nodes[at(section.start_node)].voltage_v
    current = solution.current_a
    a_p, a_q, b_p, b_q = 1.0 + 0j, 0j, 0j, 0j
    c_p, c_q, d_p, d_q = 0j, 0j, 1.0 + 0j, 0j
    piece_m, half_before_m, largest = 0.0, 0.0, 0.0
    for k in range(solution.first, solution.end + 1):
        # 1. The piece ahead, and the half shunts that meet before it.
        closing = k == solution.end
        piece_m = solution.closing_m if closing else flow.standing[at(k)].piece_m
        shunt = complex(0.0, half_b * (half_before_m + piece_m))
        current -= shunt * voltage
        c_p, c_q = _push_shunt(shunt, a_p, a_q, c_p, c_q)
        d_p, d_q = _push_shunt(shunt, b_p, b_q, d_p, d_q)
        impedance = scaled(z, piece_m)
        voltage -= impedance * current
        a_p, a_q = _push_piece(impedance, a_p, a_q, c_p, c_q)
        b_p, b_q = _push_piece(impedance, b_p, b_q, d_p, d_q)
        half_before_m = piece_m
        if closing:
            break
        # 2. The train.
        place = flow.standing[at(k)]
        load, y1, y2 = train_current(
            place.train, place.voltage_v, scale, WARM, network.system.base_voltage_v, loads
        )
        change = voltage - place.voltage_v
        current -= load + y1 * change + y2 * change.conjugate()
        c_p, c_q = _push_load(y1, y2, a_p, a_q, c_p, c_q)
        d_p, d_q = _push_load(y1, y2, b_p, b_q, d_p, d_q)
        if start == MOVE:
            largest = max(largest, squared(change))
            place.voltage_v = voltage
    # 3. The half shunt at the end.
    shunt = complex(0.0, half_b * piece_m)
    solution.end_current_a = current - shunt * voltage
    if start == MOVE:
        flow.search[0].moved_v = max(flow.search[0].moved_v, math.sqrt(largest))
        return voltage
    w = flow.sensitivity
    w[0, 0, 0], w[0, 0, 1], w[0, 1, 0], w[0, 1, 1] = a_p, a_q, b_p, b_q
    w[1, 0, 0], w[1, 0, 1] = _push_shunt(shunt, a_p, a_q, c_p, c_q)
    w[1, 1, 0], w[1, 1, 1] = _push_shunt(shunt, b_p, b_q, d_p, d_q)
    return voltage
