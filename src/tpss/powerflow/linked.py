r"""Linked Newton steps, which take the trains' voltages for unknowns too.

Behind many trains whose current falls with the voltage, a rounding at the start of a section is volts
at its end: each train adds its y (see `chain`) to the conductance that the push runs against.  The
equations are then so steep in I that Newton's method has to begin very close.  A linked pass takes the
trains' voltages u for unknowns as well: it pushes

    train:  I ← I - (i(u) + y₁ (V - u) + y₂ conj(V - u)) - j b V

which is linear, so that a Newton step holds as far as the trains' currents are straight, and a second
pass of the same kind, without derivatives, moves u to V.

Linked steps are taken whole.  Across a jump of a demand's slope the next one begins on the other side,
with its slope, and from close by they end on the right one.  Where no train's voltage moves further,
`newton` goes on.  Only paths take them, so they are kernels apart, which few runs need.
"""

import math

from tpss.kernel import at, fused, inlined, kernel
from tpss.numerics.pairs import scaled, squared
from tpss.powerflow.bundle import evaluate_bundles
from tpss.powerflow.bundle_points import is_bundled
from tpss.powerflow.bundle_state import stay_with_bundles
from tpss.powerflow.chain import LINKED, MOVED, WARM, push_load, push_piece, train_current
from tpss.powerflow.coupled import evaluate_groups, is_coupled
from tpss.powerflow.network import Flow, Loads, Network
from tpss.powerflow.newton import (
    MOST_PASSES,
    Solution,
    begin_pass,
    evaluate_nodes,
    find_direction,
    join_section,
    mark_base,
    newton,
    take_step,
)

SETTLED = 1e-7
"""Linked passes end where no train's voltage moves further. [p.u.]"""


@fused
def _push_shunt(
    shunt: complex, v_p: complex, v_q: complex, i_p: complex, i_q: complex
) -> tuple[complex, complex]:
    """Sensitivity (i_p, i_q) of the current behind a shunt."""
    return i_p - shunt * v_p, i_q - shunt * v_q


@inlined
def run_linked_chain(
    s: int, scale: float, moves: bool, network: Network, flow: Flow, loads: Loads
) -> complex:
    """As `run_chain`, with the trains' currents on their tangents; return the voltage at the end. [V]

    Where it `moves` the trains' voltages, it notes how far in `flow.search`; else it writes the
    sensitivities.
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
        a_p, a_q = push_piece(impedance, a_p, a_q, c_p, c_q)
        b_p, b_q = push_piece(impedance, b_p, b_q, d_p, d_q)
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
        c_p, c_q = push_load(y1, y2, a_p, a_q, c_p, c_q)
        d_p, d_q = push_load(y1, y2, b_p, b_q, d_p, d_q)
        if moves:
            largest = max(largest, squared(change))
            place.voltage_v = voltage
    # 3. The half shunt at the end.
    shunt = complex(0.0, half_b * piece_m)
    solution.end_current_a = current - shunt * voltage
    if moves:
        flow.search[0].moved_v = max(flow.search[0].moved_v, math.sqrt(largest))
        return voltage
    w = flow.sensitivity
    w[0, 0, 0], w[0, 0, 1], w[0, 1, 0], w[0, 1, 1] = a_p, a_q, b_p, b_q
    w[1, 0, 0], w[1, 0, 1] = _push_shunt(shunt, a_p, a_q, c_p, c_q)
    w[1, 1, 0], w[1, 1, 1] = _push_shunt(shunt, b_p, b_q, d_p, d_q)
    return voltage


@inlined
def _evaluate_linked(
    scale: float, moves: bool, network: Network, flow: Flow, loads: Loads
) -> tuple[float, float]:
    """`evaluate` with linked chains: largest residual, and the sum of squares."""
    begin_pass(not moves, network, flow)
    largest, merit = 0.0, 0.0
    for s in range(network.sections.size):
        if is_coupled(network.groups, s) or is_bundled(network.bundles, s):
            continue
        end_v = run_linked_chain(s, scale, moves, network, flow, loads)
        square, _ = join_section(s, end_v, not moves, network, flow)
        largest = max(largest, square * network.sections[at(s)].gap_weight)
        merit += square
    start = MOVED if moves else LINKED
    largest, merit, _ = evaluate_groups(
        network.groups, largest, merit, 1.0, scale, start, network, flow, loads
    )
    largest, merit, _ = evaluate_bundles(
        network.bundles, largest, merit, 1.0, scale, start, network, flow, loads
    )
    largest, merit = evaluate_nodes(largest, merit, not moves, network, flow)
    return math.sqrt(largest), merit


@inlined
def _stay(flow: Flow) -> None:
    """Make the step none: at a solution there may be no direction, as pivots may be singular."""
    for n in range(flow.nodes.size):
        flow.nodes[at(n)].direction_v = 0.0
    for s in range(flow.sections.size):
        flow.sections[at(s)].direction_a = 0.0
    stay_with_bundles(flow.bundles)


@kernel
def settle(scale: float, network: Network, flow: Flow, loads: Loads) -> tuple[bool, int]:
    """Take linked steps until the trains' voltages have settled; return whether, and the passes."""
    settled, moves, passes = False, False, 0
    while passes < MOST_PASSES and not settled:
        mismatch, merit = _evaluate_linked(scale, moves, network, flow, loads)
        passes += 1
        if not math.isfinite(merit):
            break
        if moves:
            settled = flow.search[0].moved_v < SETTLED * network.system.base_voltage_v
        else:
            find_direction(network, flow)
            if mismatch < network.tolerance:
                _stay(flow)
            mark_base(flow)
            take_step(1.0, flow)
            flow.search[0].moved_v = 0.0
        moves = not moves
    return settled, passes


@kernel
def newton_linked(scale: float, network: Network, flow: Flow, loads: Loads) -> tuple[int, int]:
    """`newton` that begins with the trains' voltages too, in linked steps."""
    settled, passes = settle(scale, network, flow, loads)
    status: int = Solution.NOT_CONVERGED
    if settled:
        status, more = newton(scale, WARM, MOST_PASSES - passes, network, flow, loads)
        passes += more
    return status, passes
