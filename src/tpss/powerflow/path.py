r"""Paths of solutions: from a state that is known to one that is wanted, by steps as small as need be.

A share t of something is raised from 0 to 1, and the solution x is followed on its way:

    `LOADS`                 the loads, t S;              at t = 0 is the state without load
    `SOURCES_UNLOADED`      how unlike the sources are, without load;
                            at t = 0 they have one voltage, which is everywhere
    `LOADS_OF_LIKE_SOURCES` the loads, while the sources are of one voltage
    `SOURCES_LOADED`        how unlike the sources are, while the loads are whole

Of sources made alike, the voltage E_s and its angle θ_s without load are those of the mean source,

    E_s(t) = E + t (E_s - E)        θ_s(t) = θ + t (θ_s - θ)

and all else of their laws, reactances and droop, stays: without load it has no effect.

A step begins on the straight line through the last two solutions,

    x(t + h) ≈ x(t) + h/k (x(t) - x(t - k))

and counts if Newton's method ends there with the sign of the determinant that belongs to the stable
branch, and close to where it began: else h is halved.  Where a demand's slope jumps, the line leads
astray in proportion to h, so a small step gets past it with linked Newton steps (`linked`), and the
next line is that of the other side.

What ends a path at t* < 1 is told by what happens there.  Beside a turn, x is x* ± c √(t* - t):
a little before it, at t, there is a second solution with the other sign of the determinant, opposite
to the first one, x' ≈ 2 x(t*) - x(t).  If Newton's method finds one from there, the branch has turned.
Where the triangle of a machine's load angle shrinks to a point, there is no solution beyond either.  A
voltage that leaves its band, or a source out of step, does not end the path: it is followed beyond, as
it may return.  Otherwise the path is lost, and nothing is known of what lies ahead.

Limits of validity: a path that turns is not followed around its turn.
"""

import math
from enum import IntEnum

from tpss.kernel import at, inlined, kernel, switch
from tpss.numerics.pairs import squared
from tpss.powerflow.bundle_points import start_bundles
from tpss.powerflow.bundle_state import (
    flat_voltage,
    keep_bundles,
    mirror_bundles,
    predict_bundles_on_path,
    set_bundles_aside,
    take_bundles_back,
)
from tpss.powerflow.chain import WARM
from tpss.powerflow.linked import newton_linked
from tpss.powerflow.network import Ending, Flow, Loads, Network
from tpss.powerflow.newton import MOST_PASSES, Solution, newton
from tpss.sources.kinds import reserve, set_unloaded, unloaded

FIRST_STEP, LARGEST_STEP, STEP_GROWTH = 0.25, 0.25, 1.5
FINEST_STEP = 1e-7
"""A path is given up where it goes on by less than this share. [1]"""

NEAR = 0.03
"""How far from its prediction the solution of a step may be. [p.u. of the base voltage]"""

NO_RESERVE = 1e-3
"""A source with less than this is at the end of the states that its law admits. [1]"""

BESIDE_THE_TURN, FURTHEST_BACK = 1e-6, 0.2
"""How far before the end of a path its second solution is looked for, from and to. [1]"""


class Way(IntEnum):
    """What is raised from nothing."""

    LOADS = 0
    SOURCES_UNLOADED = 1
    LOADS_OF_LIKE_SOURCES = 2
    SOURCES_LOADED = 3


LOADS, SOURCES_UNLOADED = switch(Way.LOADS), switch(Way.SOURCES_UNLOADED)
LOADS_OF_LIKE_SOURCES, SOURCES_LOADED = (
    switch(Way.LOADS_OF_LIKE_SOURCES),
    switch(Way.SOURCES_LOADED),
)
PLAIN, LINKED = switch(0), switch(1)
"""Newton's steps from a guess: over the nodes' voltages, or linked ones first."""

STRICT, BEYOND = switch(0), switch(1)
"""Whether a path ends where a state is implausible, or is followed beyond."""


@kernel
def set_aside(flow: Flow) -> None:
    """Put the state aside."""
    for n in range(flow.nodes.size):
        flow.nodes[at(n)].aside_v = flow.nodes[at(n)].voltage_v
    for s in range(flow.sections.size):
        flow.sections[at(s)].aside_a = flow.sections[at(s)].current_a
    set_bundles_aside(flow.bundles)


@kernel
def take_back(flow: Flow) -> None:
    """Take the state back that was put aside."""
    for n in range(flow.nodes.size):
        flow.nodes[at(n)].voltage_v = flow.nodes[at(n)].aside_v
    for s in range(flow.sections.size):
        flow.sections[at(s)].current_a = flow.sections[at(s)].aside_a
    take_bundles_back(flow.bundles)


@kernel
def keep(flow: Flow) -> None:
    """Keep the state as the last good one of a path; that before stays for the straight line."""
    for n in range(flow.nodes.size):
        node = flow.nodes[at(n)]
        node.passed_v, node.good_v = node.good_v, node.voltage_v
    for s in range(flow.sections.size):
        section = flow.sections[at(s)]
        section.passed_a, section.good_a = section.good_a, section.current_a
        for k in range(section.first, section.end):
            place = flow.standing[at(k)]
            place.passed_v, place.good_v = place.good_v, place.voltage_v
    keep_bundles(flow.bundles)


@kernel
def predict_on_path(ahead: float, flow: Flow) -> None:
    """Put the state onto the straight line through the last two points, so many of their distances
    ahead; 0 is the last good one.
    """
    for n in range(flow.nodes.size):
        node = flow.nodes[at(n)]
        node.voltage_v = node.good_v + ahead * (node.good_v - node.passed_v)
    for s in range(flow.sections.size):
        section = flow.sections[at(s)]
        section.current_a = section.good_a + ahead * (section.good_a - section.passed_a)
        for k in range(section.first, section.end):
            place = flow.standing[at(k)]
            place.voltage_v = place.good_v + ahead * (place.good_v - place.passed_v)
    predict_bundles_on_path(flow.bundles, ahead)


@kernel
def mirror_on_path(flow: Flow) -> None:
    """Put the state to the other side of the last good one."""
    for n in range(flow.nodes.size):
        node = flow.nodes[at(n)]
        node.voltage_v = 2.0 * node.good_v - node.voltage_v
    for s in range(flow.sections.size):
        section = flow.sections[at(s)]
        section.current_a = 2.0 * section.good_a - section.current_a
        for k in range(section.first, section.end):
            place = flow.standing[at(k)]
            place.voltage_v = 2.0 * place.good_v - place.voltage_v
    mirror_bundles(flow.bundles)


@kernel
def distance(ahead: float, flow: Flow) -> float:
    """Largest distance of a voltage, at nodes and trains, from the straight line. [V]"""
    largest = 0.0
    for n in range(flow.nodes.size):
        node = flow.nodes[at(n)]
        line = node.good_v + ahead * (node.good_v - node.passed_v)
        largest = max(largest, squared(node.voltage_v - line))
    for s in range(flow.sections.size):
        for k in range(flow.sections[at(s)].first, flow.sections[at(s)].end):
            place = flow.standing[at(k)]
            line = place.good_v + ahead * (place.good_v - place.passed_v)
            largest = max(largest, squared(place.voltage_v - line))
    return math.sqrt(largest)


@kernel
def mean_unloaded(network: Network) -> tuple[float, float]:
    """Mean magnitude of the sources' voltages without load, and the angle of their sum. [V], [rad]"""
    total_v, real, imaginary, count = 0.0, 0.0, 0.0, 0
    for s in range(network.sources.size):
        if network.sources[at(s)].installed == 0:
            continue
        count += 1
        magnitude_v, angle = unloaded(network.sources[at(s)])
        total_v += magnitude_v
        real += math.cos(angle)
        imaginary += math.sin(angle)
    return total_v / count, math.atan2(imaginary, real)


@kernel
def bring_apart(share: float, network: Network, flow: Flow) -> None:
    """Write into `flow.laws` sources that are unlike by a share of what those of the network are."""
    mean_v, mean_angle = mean_unloaded(network)
    for s in range(network.sources.size):
        magnitude_v, angle = unloaded(network.sources[at(s)])
        apart = angle - mean_angle
        apart -= 2.0 * math.pi * math.floor(apart / (2.0 * math.pi) + 0.5)
        set_unloaded(
            mean_v + share * (magnitude_v - mean_v), mean_angle + share * apart, flow.laws[at(s)]
        )


@kernel
def start_alike(network: Network, flow: Flow) -> None:
    """Set the state of like sources without load."""
    mean_v, mean_angle = mean_unloaded(network)
    for n in range(flow.nodes.size):
        alike_v = complex(mean_v * math.cos(mean_angle), mean_v * math.sin(mean_angle))
        flow.nodes[at(n)].voltage_v = flat_voltage(network.bundles, n, alike_v)
    for s in range(flow.sections.size):
        flow.sections[at(s)].current_a = 0.0
    start_bundles(network.bundles, network, flow)


@kernel
def solve_on_way(
    share: float, steps: int, way: Way, network: Network, flow: Flow, loads: Loads
) -> tuple[int, int]:
    """`newton`, or `newton_linked`, for a share of what a way raises."""
    scale, apart = share, 1.0
    if way == SOURCES_UNLOADED:
        scale, apart = 0.0, share
    elif way == LOADS_OF_LIKE_SOURCES:
        apart = 0.0
    elif way == SOURCES_LOADED:
        scale, apart = 1.0, share
    bring_apart(apart, network, flow)
    between = Network(
        network.system,
        network.sections,
        network.branches,
        flow.laws if apart < 1.0 else network.sources,
        network.source_of_node,
        network.pattern,
        network.admittance_s,
        network.tolerance,
        network.groups,
        network.links,
        network.bundles,
        network.shared,
        network.stores,
    )
    if steps == LINKED:
        return newton_linked(scale, between, flow, loads)
    return newton(scale, WARM, MOST_PASSES, between, flow, loads)


@inlined
def counts(status: int, beyond: int) -> bool:
    """Whether a solution is a point of a path."""
    implausible = status == Solution.IMPLAUSIBLE or status == Solution.OUT_OF_STEP
    return status == Solution.SOLVED or (beyond == BEYOND and implausible)


@kernel
def follow(
    share: float, way: Way, beyond: int, network: Network, flow: Flow, loads: Loads
) -> tuple[float, int, int]:
    """Follow a path from the state in `flow`, which is about the solution for a share.

    Returns
    -------
    share : float
        Where the path ends; the state is that there.
    status : int
        The `Solution` of the last step: where the path ends before 1, of what did not go on.
    passes : int
    """
    # 1. Where it begins.
    status, passes = solve_on_way(share, PLAIN, way, network, flow, loads)
    if not counts(status, beyond):
        return share, status, passes
    keep(flow)
    keep(flow)  # both points: there is no line yet
    # 2. Steps.
    near_v = NEAR * network.system.base_voltage_v
    step, length = FIRST_STEP, math.inf  # from a single point the line goes nowhere
    while share < 1.0 and step >= FINEST_STEP:
        target = min(1.0, share + step)
        ahead = (target - share) / length
        predict_on_path(ahead, flow)
        status, more = solve_on_way(target, LINKED, way, network, flow, loads)
        passes += more
        if counts(status, beyond) and distance(ahead, flow) <= near_v:
            keep(flow)
            share, length = target, target - share
            step = min(LARGEST_STEP, STEP_GROWTH * step)
        else:
            step /= 2.0
    if share < 1.0:
        predict_on_path(0.0, flow)
    return share, status, passes


@inlined
def has_turned(
    share: float, way: Way, network: Network, flow: Flow, loads: Loads
) -> tuple[bool, int]:
    """Whether a path turns at its end, the last good point: whether there is a second solution."""
    near_v = NEAR * network.system.base_voltage_v
    back, passes, turned = BESIDE_THE_TURN, 0, False
    while not turned and back < min(share, FURTHEST_BACK):
        # From beside the turning point Newton's method may come to either solution.
        predict_on_path(0.0, flow)
        for steps in (PLAIN, LINKED):
            if not turned:
                status, more = solve_on_way(share - back, steps, way, network, flow, loads)
                passes += more
                turned = status == Solution.WRONG_BRANCH and distance(0.0, flow) <= 3.0 * near_v
                mirror_on_path(flow)
        back *= 10.0
    predict_on_path(0.0, flow)
    return turned, passes


@inlined
def is_out_of_reserve(way: Way, share: float, network: Network, flow: Flow, loads: Loads) -> bool:
    """Whether a source ends a path at the last good point, at a share of what the way raises."""
    solve_on_way(share, LINKED, way, network, flow, loads)
    for s in range(network.sources.size):
        # The law that holds there, as sources that differ less are on a way.
        source, running = flow.laws[at(s)], flow.sources[at(s)].running
        node = flow.nodes[at(source.node)]
        if running == 0.0:
            continue
        if reserve(node.voltage_v, node.leaving_current_a, running, source) < NO_RESERVE:
            return True
    return False


@inlined
def note_ending(share: float, way: Way, network: Network, flow: Flow, loads: Loads) -> int:
    """Note in `flow.search` why a path ends at its last good point, to which the state returns.

    Return the passes.
    """
    turned, passes = has_turned(share, way, network, flow, loads)
    outcome = flow.search[0]
    outcome.ending = Ending.TURNED
    if not turned:
        spent = is_out_of_reserve(way, share, network, flow, loads)
        outcome.ending = Ending.OUT_OF_STEP if spent else Ending.LOST
        predict_on_path(0.0, flow)
    return passes
