"""Where the trains of all cases stand: each case keeps its trains in the order along the line.

So the row of a train is its place in that order.  Where trains depart, arrive or pass each other, rows
of that case change places, which happens seldom.
"""

import math
from typing import Any

from tpss.lanes.compile import compiled, lane_version
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
def swap(lane: int, a: int, b: int, words: Any, numbers: Any) -> None:
    """Let two rows of a case change places."""
    for w in range(words.shape[1]):
        words[a, w, lane], words[b, w, lane] = words[b, w, lane], words[a, w, lane]
    numbers[a, 0, lane], numbers[b, 0, lane] = numbers[b, 0, lane], numbers[a, 0, lane]


@compiled(fused=False)
def put_in_order(lane: int, trains: Any, standing: Any, words: Any, numbers: Any) -> None:
    """Bring the trains on the line of one case to the front, in the order of their places."""
    count = 0
    for k in range(trains.size):
        if lane_of(select(_is_on_line(trains[lane_at(k)].motion.phase), 1, 0), lane) == 0:
            continue
        here = k
        if k > count:
            swap(lane, count, k, words, numbers)
            exchange(lane, count, k, standing)
            here = count
        count += 1
        place_m = lane_of(standing[lane_at(here)].place_m, lane)
        while here > 0:
            other_m = lane_of(standing[lane_at(here - 1)].place_m, lane)
            behind = place_m == other_m and numbers[here, 0, lane] > numbers[here - 1, 0, lane]
            if place_m > other_m or behind:
                break
            swap(lane, here, here - 1, words, numbers)
            exchange(lane, here, here - 1, standing)
            here -= 1


@compiled(fused=False)
def exchange(lane: int, a: int, b: int, standing: Any) -> None:
    """The same of two places."""
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
def place_trains(model: Any, state: Any, words: Any, numbers: Any) -> Any:
    """`step.advance.place_trains`: the number of trains on the line."""
    flow = state.flow
    count, wrong = count_in_order(state.trains, model.legs, flow.standing)
    if anyone(wrong):
        for lane in range(LANES):
            if lane_of(select(wrong, 1, 0), lane) == 1:
                put_in_order(lane, state.trains, flow.standing, words, numbers)
    state.clock[0].short_pieces = measure(count, model.network, flow)
    return count
