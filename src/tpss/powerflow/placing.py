"""Where the trains stand under the sections of the contact line, in order, and how far apart."""

from tpss.kernel import at, inlined, kernel
from tpss.powerflow.network import SHORTEST_PIECE_M, UNFED, Flow, Network, Section, Standing
from tpss.record import Records
from tpss.track.leg import Leg, leg_at, place_on_line
from tpss.vehicle.train import Train


@inlined
def section_at(place_m: float, near: int, leg: Leg, sections: Records[Section]) -> int:
    """Section above a place on a leg; one at the end of a section is under the next, if there is one.

    The sections above a leg are in ascending order without gaps, the outer ones without end.

    Parameters
    ----------
    place_m : float
        Place on the line. [m]
    near : int
        Section from which to search.
    leg : Leg
    sections : records of Section
        All of the network.
    """
    near = min(max(near, leg.first_section), leg.end_section - 1)
    while near > leg.first_section and place_m < sections[at(near - 1)].end_m:
        near -= 1
    while near + 1 < leg.end_section and place_m >= sections[at(near)].end_m:
        near += 1
    return near


@inlined
def stands_behind(section: int, place_m: float, train: int, other: Standing) -> bool:
    """Whether a train stands behind another; at one place that of the greater number does."""
    if section != other.section:
        return section > other.section
    return place_m > other.place_m or (place_m == other.place_m and train > other.train)


@inlined
def locate_trains(
    count: int, trains: Records[Train], legs: Records[Leg], network: Network, flow: Flow
) -> None:
    """Find section and place of the first `count` trains of `flow.standing`, and sort them by these.

    The order is that of the step before, and trains hardly ever pass each other: of an insertion sort
    hardly more is left than to compare each train with the one before it.
    """
    section = 0
    for k in range(count):
        standing = flow.standing[at(k)]
        i = standing.train
        train = trains[at(i)]
        train.leg = leg_at(train.motion.position_m, train.leg, train.route, legs)
        leg = legs[at(train.route), at(train.leg)]
        place_m = place_on_line(train.motion.position_m, leg)
        section = section_at(place_m, section, leg, network.sections)
        standing.section = section
        standing.place_m = place_m
        if k > 0 and not stands_behind(section, place_m, i, flow.standing[at(k - 1)]):
            _move_forward(k, flow.standing)


@kernel
def _move_forward(k: int, standing: Records[Standing]) -> None:
    """Move the `k`-th train to its place among those before it, which are in order."""
    train, section, place_m = (
        standing[at(k)].train,
        standing[at(k)].section,
        standing[at(k)].place_m,
    )
    while k > 0 and not stands_behind(section, place_m, train, standing[at(k - 1)]):
        before, here = standing[at(k - 1)], standing[at(k)]
        here.train, here.section, here.place_m = before.train, before.section, before.place_m
        k -= 1
    here = standing[at(k)]
    here.train, here.section, here.place_m = train, section, place_m


@inlined
def is_unfed(section: int, network: Network) -> bool:
    """Whether no source reaches a section."""
    node = network.sections[at(section)].start_node
    return network.source_of_node[at(node)] == UNFED


@inlined
def set_unfed_aside(network: Network, flow: Flow) -> int:
    """Leave the sections that no source reaches without their trains; return the number of these.

    Their chains are line only then, on which nothing flows.
    """
    count = 0
    for s in range(network.sections.size):
        if is_unfed(s, network):
            section, solution = network.sections[at(s)], flow.sections[at(s)]
            for k in range(solution.first, solution.end):
                flow.standing[at(k)].voltage_v = 0.0
            count += solution.end - solution.first
            solution.first = solution.end
            solution.closing_m = max(SHORTEST_PIECE_M, section.end_m - section.start_m)
    return count


@inlined
def measure_pieces(count: int, network: Network, flow: Flow) -> int:
    """Measure the line between neighbours under each section; count the pieces that are too short.

    Parameters
    ----------
    count : int
        Number of trains in `flow.standing`, located.
    """
    short = 0
    k = 0
    for s in range(network.sections.size):
        section, solution = network.sections[at(s)], flow.sections[at(s)]
        before_m = section.start_m
        solution.first = k
        while k < count and flow.standing[at(k)].section == s:
            standing = flow.standing[at(k)]
            standing.piece_m = max(SHORTEST_PIECE_M, standing.place_m - before_m)
            short += standing.place_m - before_m < SHORTEST_PIECE_M
            before_m = standing.place_m
            k += 1
        solution.end = k
        solution.closing_m = max(SHORTEST_PIECE_M, section.end_m - before_m)
        short += section.end_m - before_m < SHORTEST_PIECE_M
    return short
