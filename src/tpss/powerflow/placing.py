"""Where the trains stand under the sections of the contact line, in order, and how far apart."""

from tpss.kernel import at, inlined
from tpss.powerflow.network import SHORTEST_PIECE_M, Flow, Network, Section, Standing
from tpss.record import Records
from tpss.vehicle.train import Train


@inlined
def section_at(position_m: float, near: int, sections: Records[Section]) -> int:
    """Section under a position; one at the end of a section is under the next, if there is one.

    The sections are those of one line, in ascending order without gaps, the outer ones without end:
    nothing else assumes that.

    Parameters
    ----------
    position_m : float
        Position on the line. [m]
    near : int
        Section from which to search.
    """
    while near > 0 and position_m < sections[at(near - 1)].end_m:
        near -= 1
    while near + 1 < sections.size and position_m >= sections[at(near)].end_m:
        near += 1
    return near


@inlined
def stands_behind(section: int, place_m: float, train: int, other: Standing) -> bool:
    """Whether a train stands behind another; at one place that of the greater number does."""
    if section != other.section:
        return section > other.section
    return place_m > other.place_m or (place_m == other.place_m and train > other.train)


@inlined
def locate_trains(count: int, trains: Records[Train], network: Network, flow: Flow) -> None:
    """Find section and place of the first `count` trains of `flow.standing`, and sort them by these.

    The order is that of the step before, and trains hardly ever pass each other: an insertion sort
    visits each of them once.
    """
    section = 0
    for k in range(count):
        train = flow.standing[at(k)].train
        place_m = trains[at(train)].motion.position_m
        section = section_at(place_m, section, network.sections)
        place = k
        while place > 0:
            other = flow.standing[at(place - 1)]
            if stands_behind(section, place_m, train, other):
                break
            flow.standing[at(place)].train = other.train
            flow.standing[at(place)].section = other.section
            flow.standing[at(place)].place_m = other.place_m
            place -= 1
        flow.standing[at(place)].train = train
        flow.standing[at(place)].section = section
        flow.standing[at(place)].place_m = place_m


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
