"""Where the trains of all cases stand: each case keeps its trains in the order along the line.

So the row of a train is its place in that order.  Where trains depart, arrive or pass each other, rows
of that case change places, which happens seldom.
"""

import math
from typing import Any, NamedTuple

from tpss.audit.network import sort_trains
from tpss.lanes.compile import by_hand, compiled, lane_version
from tpss.lanes.masks import (
    anyone,
    as_lane_int,
    as_lanes,
    both,
    either,
    highest,
    lane_at,
    lane_of,
    negated,
    one_lane,
    select,
)
from tpss.lanes.types import LANES
from tpss.powerflow.network import SHORTEST_PIECE_M
from tpss.vehicle.train import is_on_line


class Rows(NamedTuple):
    """What lies in the order of the trains, as words, lanes last."""

    trains: Any
    numbers: Any
    figures: Any


_is_on_line = lane_version(is_on_line)[0]


@compiled(fused=False)
def count_in_order(trains: Any, legs: Any, standing: Any) -> tuple[Any, Any]:
    """Trains on the line of each case, and the cases whose rows are not in their order."""
    count, before_m = as_lane_int(0), as_lanes(-math.inf)
    nobody = negated(before_m < 0.0)
    ended, wrong = nobody, nobody
    leg = legs[lane_at(0), lane_at(0)]
    for k in range(trains.size):
        motion = trains[lane_at(k)].motion
        on_line = _is_on_line(motion.phase)
        place_m = leg.sign * motion.position_m + leg.offset_m
        standing[lane_at(k)].place_m = place_m
        follows = both(negated(ended), before_m < place_m)
        wrong = either(wrong, both(on_line, negated(follows)))
        before_m = select(on_line, place_m, before_m)
        ended = either(ended, negated(on_line))
        count = count + select(on_line, 1, 0)
    return count, wrong


@compiled(fused=False)
def swap(lane: int, a: int, b: int, words: Any) -> None:
    """Let two rows of a case change places."""
    for w in range(words.shape[1]):
        words[a, w, lane], words[b, w, lane] = words[b, w, lane], words[a, w, lane]


@compiled(fused=False)
def put_in_order(lane: int, trains: Any, standing: Any, rows: Any) -> None:
    """Bring the trains on the line of one case to the front, in the order of their places."""
    count, numbers = 0, rows.numbers
    for k in range(trains.size):
        if lane_of(select(_is_on_line(trains[lane_at(k)].motion.phase), 1, 0), lane) == 0:
            continue
        here = k
        if k > count:
            exchange(lane, count, k, standing, rows)
            here = count
        count += 1
        place_m = lane_of(standing[lane_at(here)].place_m, lane)
        while here > 0:
            other_m = lane_of(standing[lane_at(here - 1)].place_m, lane)
            behind = place_m == other_m and numbers[here, 0, lane] > numbers[here - 1, 0, lane]
            if place_m > other_m or behind:
                break
            exchange(lane, here, here - 1, standing, rows)
            here -= 1


@compiled(fused=False)
def exchange(lane: int, a: int, b: int, standing: Any, rows: Any) -> None:
    """Let two trains of a case change places, with all that is known of them."""
    swap(lane, a, b, rows.trains)
    swap(lane, a, b, rows.figures)
    swap(lane, a, b, rows.numbers)
    here_m, there_m = standing[lane_at(a)].place_m, standing[lane_at(b)].place_m
    this = one_lane(lane)
    standing[lane_at(a)].place_m = select(this, lane_of(there_m, lane), here_m)
    standing[lane_at(b)].place_m = select(this, lane_of(here_m, lane), there_m)


@compiled(fused=False)
def measure(count: Any, network: Any, flow: Any) -> Any:
    """`powerflow.placing` of trains in their order; the number of pieces that are too short."""
    last = network.sections.size - 1
    short, first = as_lane_int(0), as_lane_int(0)
    ended_m = as_lanes(-math.inf)
    for s in range(last + 1):
        section, solution = network.sections[lane_at(s)], flow.sections[lane_at(s)]
        ends_m = section.end_m if s < last else as_lanes(math.inf)
        before_m, end = section.start_m, first
        for k in range(highest(count)):
            standing = flow.standing[lane_at(k)]
            place_m = standing.place_m
            here = both(both(k < count, ended_m <= place_m), place_m < ends_m)
            if not anyone(here):
                continue
            piece_m = place_m - before_m
            standing.section = select(here, s, standing.section)
            standing.piece_m = select(here, max(SHORTEST_PIECE_M, piece_m), standing.piece_m)
            short = short + select(both(here, piece_m < SHORTEST_PIECE_M), 1, 0)
            before_m = select(here, place_m, before_m)
            end = end + select(here, 1, 0)
        piece_m = section.end_m - before_m
        solution.first, solution.end = first, end
        solution.closing_m = max(SHORTEST_PIECE_M, piece_m)
        short = short + select(piece_m < SHORTEST_PIECE_M, 1, 0)
        first, ended_m = end, ends_m
    return short


@compiled(fused=False)
def place_trains(model: Any, state: Any, rows: Rows) -> Any:
    """`step.advance.place_trains`: the number of trains on the line."""
    flow = state.flow
    count, wrong = count_in_order(state.trains, model.legs, flow.standing)
    if anyone(wrong):
        for lane in range(LANES):
            if lane_of(select(wrong, 1, 0), lane) == 1:
                put_in_order(lane, state.trains, flow.standing, rows)
    state.clock[lane_at(0)].short_pieces = measure(count, model.network, flow)
    return count


@compiled(fused=False)
def find_places(step: int, _: Any, model: Any, recording: Any, scratch: Any) -> Any:
    """`audit.network.sort_trains` of trains that are in their order: where they stand, and how many."""
    count, last = as_lane_int(0), model.network.sections.size - 1
    leg = model.legs[lane_at(0), lane_at(0)]
    for k in range(scratch.order.size):
        on_line = recording.train_state[lane_at(step), lane_at(k)] >= 0
        if not anyone(on_line):
            break
        position_m = recording.trains[lane_at(step), lane_at(k)].route_position
        place_m, section = leg.sign * position_m + leg.offset_m, as_lane_int(0)
        for s in range(last):
            beyond = place_m >= model.network.sections[lane_at(s)].end_m
            section = section + select(beyond, 1, 0)
        scratch.place_m[lane_at(k)] = place_m
        scratch.section[lane_at(k)] = section
        count = count + select(on_line, 1, 0)
    return count


by_hand[sort_trains] = find_places, False
