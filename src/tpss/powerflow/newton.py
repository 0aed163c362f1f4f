r"""Newton's method for the coupled load flow.

Unknowns are the voltages V of the fixed nodes and the current I_s that enters each section.  Four
kinds of equation, all complex:

    section s from a to b:  E_s(V_a, I_s) = V_b            (`chain` pushes V_a, I_s to the end E_s)
    node without source:    Σ leaving currents = 0
    node with source:       V = f(P, Q),  P + jQ = V conj(J),  J = Σ leaving currents
    ... that shares a grid: J + Σ Y (V - E) = 0, see `shared_grids`
    node that is not fed:   V = 0
    node that follows:      V = V of another node, of which it is a second name

f is the converter law (2.1)-(2.4).  The trains' equations stand inside the chains, so forces,
accelerations and powers are solved together with the voltages.

A section's linearised equation, A δV_a + B δI_s + g = δV_b with the gap g = E_s - V_b, gives

    δI_s = B⁻¹ (δV_b - A δV_a - g)

and, put into the currents at both ends (end current C δV_a + D δI_s), blocks between its nodes only:

    leaving a:  B⁻¹(δV_b - A δV_a - g)       leaving b:  -(C - D B⁻¹A) δV_a - D B⁻¹ (δV_b - g)

A source's row is the linearised f: with δS = J̄ δV + V δJ̄ and the pair (s₁, s₂) of f over S,

    δV - (s₁J̄, s₂J) δV - (s₂V̄, s₁V) δJ = -(V - f)

All derivatives are pairs (see `pairs`); the system over the nodes is solved by `block_lu`.

The determinant of the whole Jacobian is, but for a positive factor, the product of the B's and of
the pivots.  From zero load on it stays positive until the solution branch turns, so its sign
distinguishes the stable branch from the one beyond the turning point.

A step is halved until it lowers the sum of squares.  Where the slope of a demand jumps (a current
limitation begins, a machine reaches its limit) that may be in vain: the slope of this side leads
across, and beyond it another one holds.  Linked steps (see `linked`) get past it.

References
----------
[Boullanger2009]_, eq. (3.5), (F.29)-(F.41).
"""

import math
from enum import IntEnum

from tpss.kernel import at, inlined, kernel, switch
from tpss.numerics.block_lu import Block, solve_blocks, substitute_passive
from tpss.numerics.pairs import (
    Pair,
    apply,
    compose,
    determinant,
    inverse,
    scaled,
    squared,
)
from tpss.powerflow.bundle import direct_bundles, evaluate_bundles
from tpss.powerflow.bundle_points import is_bundled
from tpss.powerflow.bundle_state import (
    mark_bundles,
    step_bundles,
    terminal_voltage,
    through_terminals,
)
from tpss.powerflow.chain import (
    CHECK,
    FLAT,
    WARM,
    Pass,
    run_chain,
)
from tpss.powerflow.coupled import direct_groups, evaluate_groups, is_coupled
from tpss.powerflow.following import FOLLOWS, follow
from tpss.powerflow.links import leave_by_links
from tpss.powerflow.network import UNFED, Flow, Loads, Network
from tpss.powerflow.passive import evaluate_passive
from tpss.powerflow.plausible import sources_are_plausible, voltages_are_plausible
from tpss.powerflow.sharing import balance_of_sharing, shares_its_grid
from tpss.powerflow.stores import add_stores
from tpss.sources.kinds import residual

CLOSE = 1e-4
"""Mismatch from which one Newton step usually reaches the tolerance.  The determinant does not change
its sign over so short a distance except at the turning point itself. [p.u.]"""

MOST_PASSES = switch(40)
"""Evaluations of the network after which it is given up."""

MOST_HALVINGS = 12


class Solution(IntEnum):
    """How Newton's method ended."""

    SOLVED = 0
    NOT_CONVERGED = 1
    IMPLAUSIBLE = 2
    """A voltage outside the plausible band."""
    WRONG_BRANCH = 3
    """A solution beyond the turning point of the branch that begins at no load."""
    OUT_OF_STEP = 4
    """A source in a state that its law does not admit."""


@kernel
def _add(block: Block, p: complex, q: complex) -> None:
    block.p += p
    block.q += q


@inlined
def _stamp_section(s: int, network: Network, flow: Flow) -> float:
    """Add a section's blocks and gap currents to the node system; return the sign of det B."""
    section, solution, w = network.sections[at(s)], flow.sections[at(s)], flow.sensitivity
    a_p, a_q = w[0, 0, 0], w[0, 0, 1]
    bi_p, bi_q = inverse(w[0, 1, 0], w[0, 1, 1])
    ba_p, ba_q = compose(bi_p, bi_q, a_p, a_q)
    db_p, db_q = compose(w[1, 1, 0], w[1, 1, 1], bi_p, bi_q)
    dba_p, dba_q = compose(db_p, db_q, a_p, a_q)
    _add(flow.blocks[at(section.block_aa)], -ba_p, -ba_q)
    _add(flow.blocks[at(section.block_ab)], bi_p, bi_q)
    _add(flow.blocks[at(section.block_ba)], dba_p - w[1, 0, 0], dba_q - w[1, 0, 1])
    _add(flow.blocks[at(section.block_bb)], -db_p, -db_q)
    flow.nodes[at(section.start_node)].right_side += apply(bi_p, bi_q, solution.gap_v)
    flow.nodes[at(section.end_node)].right_side -= apply(db_p, db_q, solution.gap_v)
    solution.inverse_p, solution.inverse_q = bi_p, bi_q
    solution.transfer_p, solution.transfer_q = a_p, a_q
    return math.copysign(1.0, determinant(w[0, 1, 0], w[0, 1, 1]))


@inlined
def _leave_by_branches(network: Network, flow: Flow) -> None:
    """Start the nodes' leaving currents with those into the lumped branches."""
    for n in range(flow.nodes.size):
        flow.nodes[at(n)].leaving_current_a = 0.0
    for b in range(network.branches.size):
        branch = network.branches[at(b)]
        start, end = flow.nodes[at(branch.start_node)], flow.nodes[at(branch.end_node)]
        current = (start.voltage_v - end.voltage_v) * branch.admittance_s
        start.leaving_current_a += current
        end.leaving_current_a -= current
    leave_by_links(network.links, flow.nodes)


@inlined
def _stamp_branches(network: Network, flow: Flow) -> None:
    """Start the linear system with the lumped branches."""
    for k in range(flow.blocks.size):
        flow.blocks[at(k)].p = network.admittance_s[at(k)]
        flow.blocks[at(k)].q = 0.0
    for n in range(flow.nodes.size):
        flow.nodes[at(n)].right_side = 0.0


@inlined
def _turn_source_row(
    number: int, value: complex, by_voltage: Pair, by_current: Pair, network: Network, flow: Flow
) -> None:
    """Turn the current balance of a node, all parts added, into the row of its source's law."""
    node, own = flow.nodes[at(number)], flow.blocks[at(number)]
    c_p, c_q = by_current
    begin, end = network.pattern.row_start[at(number)], network.pattern.row_start[at(number + 1)]
    for k in range(begin, end):
        block = flow.blocks[at(network.pattern.places[at(k)])]
        block.p, block.q = compose(c_p, c_q, block.p, block.q)
    own.p += by_voltage[0]
    own.q += by_voltage[1]
    # The right side holds minus the change of the leaving current that closes the gaps.
    node.right_side = apply(c_p, c_q, node.right_side) - value


@kernel
def hold_at_zero(n: int, derivatives: bool, network: Network, flow: Flow) -> float:
    """`evaluate_node` of one that no source reaches: V = 0."""
    voltage_v = flow.nodes[at(n)].voltage_v
    if derivatives:
        nothing, itself = (0j, 0j), (complex(1.0, 0.0), 0j)
        _turn_source_row(n, voltage_v, itself, nothing, network, flow)
    return squared(voltage_v) * network.system.per_square_volt


@inlined
def evaluate_node(n: int, derivatives: bool, network: Network, flow: Flow) -> float:
    """Square of the residual of node `n` [p.u.], and its row of the linear system.

    References
    ----------
    [Boullanger2009]_, eq. (F.29), (F.30), (F.33), (F.37)-(F.41).
    """
    node, s = flow.nodes[at(n)], network.source_of_node[at(n)]
    if s < 0:
        if s == UNFED:
            return hold_at_zero(n, derivatives, network, flow)
        if s <= FOLLOWS:
            return follow(n, FOLLOWS - s, network, flow)
        node.right_side -= node.leaving_current_a
        return squared(node.leaving_current_a) * network.system.per_square_ampere
    if shares_its_grid(network.shared, s):
        return balance_of_sharing(network.shared, n, s, network, flow)
    running = flow.sources[at(s)].running
    voltage_v = terminal_voltage(network.bundles, s, node.voltage_v, node.leaving_current_a)
    value, by_voltage, by_current = residual(
        voltage_v, node.leaving_current_a, running, network.sources[at(s)], derivatives
    )
    if derivatives:
        by_current = through_terminals(network.bundles, s, by_voltage, by_current)
        _turn_source_row(n, value, by_voltage, by_current, network, flow)
    return squared(value) * network.system.per_square_volt


@inlined
def evaluate_nodes(
    largest: float, merit: float, derivatives: bool, network: Network, flow: Flow
) -> tuple[float, float]:
    """`evaluate_node` of all nodes: the largest square of a residual so far, and the sum of them."""
    # 1. Rows that are eliminated once, before those to which they are carried over become laws.
    for k in range(network.pattern.once):
        square = evaluate_passive(k, derivatives, network, flow)
        largest = max(largest, square)
        merit += square
    # 2. All others.
    for n in range(flow.nodes.size):
        if network.pattern.is_once[at(n)]:
            continue
        square = evaluate_node(n, derivatives, network, flow)
        largest = max(largest, square)
        merit += square
    return largest, merit


@inlined
def begin_pass(derivatives: bool, network: Network, flow: Flow) -> None:
    """Start the leaving currents, and the linear system, with the lumped branches and the stores."""
    _leave_by_branches(network, flow)
    if derivatives:
        _stamp_branches(network, flow)
    if network.stores.size > 0:
        add_stores(derivatives, network, flow)


@inlined
def join_section(
    s: int, end_v: complex, derivatives: bool, network: Network, flow: Flow
) -> tuple[float, float]:
    """Join a section that was pushed to its end, where its voltage is `end_v`, to its nodes.

    Return the square of its gap [p.u.], and the sign of det B if it has derivatives.
    """
    section, solution = network.sections[at(s)], flow.sections[at(s)]
    solution.gap_v = end_v - flow.nodes[at(section.end_node)].voltage_v
    flow.nodes[at(section.start_node)].leaving_current_a += solution.current_a
    flow.nodes[at(section.end_node)].leaving_current_a -= solution.end_current_a
    sign = 1.0
    if derivatives:
        sign = _stamp_section(s, network, flow)
    return squared(solution.gap_v) * network.system.per_square_volt, sign


@inlined
def evaluate(
    scale: float, start: Pass, network: Network, flow: Flow, loads: Loads
) -> tuple[float, float, float]:
    """One pass over the network: residuals, and the linear system of the next Newton step.

    Parameters
    ----------
    scale : float
        Factor on all loads. [1]
    start : Pass

    Returns
    -------
    mismatch : float
        Largest residual, per unit of base power (nodes, gaps) or base voltage (sources).
    merit : float
        Sum of squares that a step has to lower; infinite where the pass has no result.
    sign : float
        Sign of the product of the sections' determinants (not with `CHECK`).
    """
    derivatives = start != CHECK
    # 1. Lumped branches.
    begin_pass(derivatives, network, flow)
    # 2. Contact-line sections (F.35)-(F.38), with the trains' demands.
    largest, merit, sign = 0.0, 0.0, 1.0
    for s in range(network.sections.size):
        if is_coupled(network.groups, s) or is_bundled(network.bundles, s):
            continue
        end_v = run_chain(s, scale, start, network, flow, loads)
        square, side = join_section(s, end_v, derivatives, network, flow)
        sign *= side
        largest = max(largest, square * network.sections[at(s)].gap_weight)
        merit += square
    largest, merit, sign = evaluate_groups(
        network.groups, largest, merit, sign, scale, start, network, flow, loads
    )
    largest, merit, sign = evaluate_bundles(
        network.bundles, largest, merit, sign, scale, start, network, flow, loads
    )
    # 3. Current balance of the nodes, or the law of the sources.
    largest, merit = evaluate_nodes(largest, merit, derivatives, network, flow)
    if not math.isfinite(merit):
        return math.inf, math.inf, 0.0
    return math.sqrt(largest), merit, sign


@inlined
def find_direction(network: Network, flow: Flow) -> float:
    """Solve for the Newton step; return the sign of the node system's determinant."""
    sign = solve_blocks(network.pattern, flow.blocks, flow.nodes)
    substitute_passive(network.pattern, network.admittance_s, flow.nodes)
    for n in range(flow.nodes.size):
        flow.nodes[at(n)].direction_v = flow.nodes[at(n)].right_side
    for s in range(network.sections.size):
        section, solution = network.sections[at(s)], flow.sections[at(s)]
        start_v = flow.nodes[at(section.start_node)].direction_v
        end_v = flow.nodes[at(section.end_node)].direction_v
        change = end_v - apply(solution.transfer_p, solution.transfer_q, start_v) - solution.gap_v
        solution.direction_a = apply(solution.inverse_p, solution.inverse_q, change)
    direct_groups(network.groups, network, flow)
    direct_bundles(network.bundles, network, flow)
    return sign


@inlined
def mark_base(flow: Flow) -> None:
    """Let the next step start from this state."""
    for node in range(flow.nodes.size):
        flow.nodes[at(node)].base_v = flow.nodes[at(node)].voltage_v
    for s in range(flow.sections.size):
        flow.sections[at(s)].base_a = flow.sections[at(s)].current_a
    mark_bundles(flow.bundles)


@inlined
def take_step(size: float, flow: Flow) -> None:
    """Take a share of the whole step from where it starts."""
    for n in range(flow.nodes.size):
        node = flow.nodes[at(n)]
        node.voltage_v = node.base_v + size * node.direction_v
    for s in range(flow.sections.size):
        section = flow.sections[at(s)]
        section.current_a = section.base_a + size * section.direction_a
    step_bundles(flow.bundles, size)


@inlined
def _close_gaps(flow: Flow) -> None:
    """Spread what is left of each section's gap over its pieces, in proportion to their length.

    The gap is a rounding (below the tolerance), but over a closing piece of a metre even a rounding is
    a visible current; spread over the whole section it is none.
    """
    for s in range(flow.sections.size):
        section = flow.sections[at(s)]
        total_m = section.closing_m
        for k in range(section.first, section.end):
            total_m += flow.standing[at(k)].piece_m
        per_metre = scaled(section.gap_v, 1.0 / total_m)
        passed_m = 0.0
        for k in range(section.first, section.end):
            passed_m += flow.standing[at(k)].piece_m
            flow.standing[at(k)].voltage_v -= scaled(per_metre, passed_m)


@inlined
def conclude(sign: float, network: Network, flow: Flow) -> Solution:
    """Status of a state without mismatch."""
    _close_gaps(flow)
    if not sign > 0.0:
        return Solution.WRONG_BRANCH
    if not voltages_are_plausible(network, flow):
        return Solution.IMPLAUSIBLE
    return Solution.SOLVED if sources_are_plausible(network, flow) else Solution.OUT_OF_STEP


@kernel
def newton(
    scale: float, start: Pass, most: int, network: Network, flow: Flow, loads: Loads
) -> tuple[int, int]:
    """Solve from the state in `flow`, damped; return a status and the number of passes.

    Parameters
    ----------
    scale : float
        Factor on all loads. [1]
    start : Pass
        `WARM`, or `FLAT` to begin with all trains' currents at base voltage, whatever the state.
    most : int
        Number of passes after which it is given up.
    """
    kind, passes, after_flat = start, 0, False
    merit, sign, size, trials = math.inf, 1.0, 1.0, 1
    while passes < most:
        if passes > 0:
            take_step(size, flow)
        mismatch, trial, chains = evaluate(scale, kind, network, flow, loads)
        passes += 1
        solved = mismatch < network.tolerance and kind != FLAT
        if kind == CHECK:
            if not solved:
                kind = WARM  # the derivatives at the same place
                continue
        # After a flat pass the merits belong to different equations.
        elif trial < merit or solved or (after_flat and math.isfinite(trial)):
            sign = chains * find_direction(network, flow)
        elif merit == math.inf or trials == MOST_HALVINGS:
            break
        else:
            size, trials = size / 2.0, trials + 1
            continue
        if solved:
            return conclude(sign, network, flow), passes
        # One step from close by is likely the solution: look, without derivatives, before going on.
        after_flat, merit = kind == FLAT, trial
        kind = CHECK if mismatch < CLOSE and kind == WARM else WARM
        size, trials = 1.0, 1
        mark_base(flow)
    return Solution.NOT_CONVERGED, passes
