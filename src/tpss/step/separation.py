r"""Trains that follow each other keep apart: how far each may go in a step, and how fast.

A train may go as far as the rear of the train ahead of it on its track, less a margin: the **end of its
authority**, with moving blocks.  With fixed blocks it may go as far as the block in which that rear is.
It brakes for this place as for a stop, which moves on from step to step.  Places are those at the start
of the step: the train ahead has gone on by its end, so nobody comes too near.

Not to brake and accelerate in turns behind a slower train, it is no faster than that it could stop at
the end of its authority after a reaction time t_r of going on as before:

.. math:: v t_r + \frac{v^2}{2 b} = d \;\Rightarrow\; v = -b t_r + \sqrt{b^2 t_r^2 + 2 b d},

the reaction time being a time step at least, in which the place that it aims at stays.

Trains are kept in a list for each track, so that a train looks at those on its own way only.
Trains that run towards each other on one track do not see each other: what keeps them apart are gates
(`precedence`), at which a train brakes as for a stop.  Nor is anybody's way blocked by a train that
waits at a gate at a station of several tracks, or at its origin.
"""

import math
from enum import IntEnum
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.kernel import at, inlined, kernel
from tpss.powerflow.network import Indices, Standing
from tpss.record import Record, Records
from tpss.step.deadlock import in_the_way
from tpss.step.halts import Halts, halt_ahead
from tpss.step.precedence import reach_of
from tpss.step.turns import AT_GATE_M, NOBODY, Gates, Holding, Turns
from tpss.track.gate import Precedence
from tpss.track.leg import Leg, place_on_line
from tpss.vehicle.braking import braking_distance
from tpss.vehicle.train import Motion, Phase, Train
from tpss.vehicle.train_type import TrainType

MOST_TRACKS = 8
"""Of a line."""

RESTART_M = 20.0
"""A train that stands starts again once it may go so far, or to its stop. [m]"""

ROUNDING_M = 0.001
"""A train that brakes for the end of its authority is as near to it as it may be, but for this. [m]"""

SLOWEST_M_S = 1.0
"""A train that moves is held to no less, until it brakes for the end of its authority. [m/s]"""


class Separation(IntEnum):
    """How trains that follow each other are kept apart."""

    NONE = 0
    MOVING_BLOCK = 1
    FIXED_BLOCK = 2


class Signalling(NamedTuple):
    """What keeps trains apart."""

    separation: Separation
    precedence: Precedence
    """What keeps trains apart that meet on a single track, or come together."""
    reaction_s: float
    """Time that a train goes on before it brakes. [s]"""
    margin_m: float
    """Distance that is kept from the train or block ahead. [m]"""
    block_m: float
    """Length of fixed blocks, counted from kilometre 0 of each line. [m]"""


class Occupancy(Record):
    """A part of a track that a train stands on."""

    train: int
    sign: float
    """Direction of the train there: 1.0 towards rising kilometres."""
    low_m: float
    """Where it begins on the line. [m]"""
    high_m: float
    """Where it ends. [m]"""
    stands: bool
    """Whether it waits there for others to pass."""
    aside: bool
    """Whether it does so on a track of its own."""
    tail: bool
    """Whether its head is on another leg already."""
    next: int
    """Next one on the track; -1: none."""


def tracks_of(legs: Records[Leg]) -> int:
    """Number of lists that tracks take."""
    return (int(legs["line"].max(initial=0)) + 1) * (MOST_TRACKS + 1)


@inlined
def _track(leg: Leg) -> int:
    """Number of the list of a leg's track."""
    return leg.line * (MOST_TRACKS + 1) + leg.track


@kernel
def _occupy(
    k: int, i: int, from_m: float, to_m: float, held: Holding, tail: bool, leg: Leg,
    occupancies: Records[Occupancy], first: Indices,
) -> None:  # fmt: skip
    """Note in the `k`-th entry that train `i` stands between two positions along its route. [m]"""
    entry, track = occupancies[at(k)], _track(leg)
    one_m, other_m = place_on_line(from_m, leg), place_on_line(to_m, leg)
    entry.train, entry.sign = i, leg.sign
    entry.low_m, entry.high_m, entry.aside = min(one_m, other_m), max(one_m, other_m), held.aside
    entry.tail, entry.stands = tail, held.stands
    entry.next, first[at(track)] = first[at(track)], k


@inlined
def note_places(
    count: int, standing: Records[Standing], trains: Records[Train], types: Records[TrainType],
    legs: Records[Leg], holdings: Records[Holding], occupancies: Records[Occupancy],
    first: Indices,
) -> None:  # fmt: skip
    """List what the first `count` trains of `standing` stand on, by tracks."""
    first[:] = -1
    for n in range(count):
        i = standing[at(n)].train
        train = trains[at(i)]
        head_m, held, number = train.motion.position_m, holdings[at(i)], train.leg
        rear_m = head_m - types[at(train.train_type)].length_m
        if held.stands and number > 0:  # it has not come to the leg that begins at its gate
            number -= legs[at(train.route), at(number)].from_m >= head_m - AT_GATE_M
        leg = legs[at(train.route), at(number)]
        _occupy(2 * n, i, max(rear_m, leg.from_m), head_m, held, False, leg, occupancies, first)
        if rear_m < leg.from_m and number > 0:
            before = legs[at(train.route), at(number - 1)]
            rear_m = max(rear_m, before.from_m)
            _occupy(2 * n + 1, i, rear_m, leg.from_m, held, True, before, occupancies, first)


@inlined
def _head(entry: Occupancy, leg: Leg) -> float:
    """Where an occupied part of a track ends, along the route of a train behind it. [m]"""
    return leg.sign * ((entry.high_m if leg.sign > 0.0 else entry.low_m) - leg.offset_m)


@inlined
def _rear(entry: Occupancy, leg: Leg) -> float:
    """Where an occupied part of a track begins, along the route of a train behind it. [m]"""
    return leg.sign * ((entry.low_m if leg.sign > 0.0 else entry.high_m) - leg.offset_m)


@inlined
def _end_before(entry: Occupancy, leg: Leg, signalling: Signalling) -> float:
    """End of authority before an occupied part of a track, along the route of a train behind it. [m]"""
    if signalling.separation == Separation.MOVING_BLOCK:
        return _rear(entry, leg) - signalling.margin_m
    if leg.sign > 0.0:
        rear_m = math.floor(entry.low_m / signalling.block_m) * signalling.block_m
    else:
        rear_m = math.ceil(entry.high_m / signalling.block_m) * signalling.block_m
    return leg.sign * (rear_m - leg.offset_m) - signalling.margin_m


@inlined
def _is_ahead(entry: Occupancy, i: int, position_m: float, own: bool, leg: Leg) -> bool:
    """Whether a part of a track is ahead of train `i`, on the leg where it is (its own) or later."""
    if entry.train == i or entry.sign != leg.sign:
        return False
    head_m = _head(entry, leg)
    if entry.stands and head_m <= (position_m if own else leg.from_m) + AT_GATE_M:
        return False  # beside it, it waits for others to pass
    if not own:  # a tail that ends where the leg begins has come from elsewhere, and left it there
        return head_m > leg.from_m + ROUNDING_M if entry.tail else head_m >= leg.from_m
    return head_m > position_m or (head_m == position_m and entry.train < i)


@kernel
def end_of_authority(
    i: int, reach_m: float, gate_m: float, aside: bool, train: Train, legs: Records[Leg],
    occupancies: Records[Occupancy], first: Indices, signalling: Signalling,
) -> tuple[float, int]:  # fmt: skip
    """Position that train `i` may not pass because of another one, and which; infinite: there is none
    within its reach. [m]

    Trains beyond a gate that it may not pass are not in its way, nor those that wait aside; if it would
    wait `aside` there too, nor those whose head is beyond it.
    """
    end_m, whom, position_m = math.inf, NOBODY, train.motion.position_m
    for n in range(train.leg, legs.shape[1]):
        leg = legs[at(train.route), at(n)]
        if leg.from_m > position_m + reach_m or end_m < leg.from_m or gate_m <= leg.from_m:
            break
        until_m = math.inf
        if n + 1 < legs.shape[1]:
            until_m = legs[at(train.route), at(n + 1)].from_m
        k = first[at(_track(leg))]
        while k >= 0:
            entry = occupancies[at(k)]
            if not entry.aside and _is_ahead(entry, i, position_m, n == train.leg, leg):
                before_m = _end_before(entry, leg, signalling)
                begins_m = _head(entry, leg) if aside else _rear(entry, leg)
                begins_m += -AT_GATE_M if entry.stands and not aside else AT_GATE_M
                if before_m < until_m and before_m < end_m and begins_m < gate_m:
                    end_m, whom = before_m, entry.train
            k = entry.next
    return end_m, whom


@inlined
def _brake_for(end_m: float, least_m: float, motion: Motion, kind: TrainType) -> tuple[float, bool]:
    """Let a train go no further than a position, if it can brake for that; return how far it may go
    now, and whether it is too near.  One that stands does not start for less than `least_m`. [m]
    """
    room_m, v, b = end_m - motion.position_m, motion.speed_m_s, kind.highest_retardation_m_s2
    if v <= 0.0:
        at_end = room_m < least_m
        motion.authority_m = min(motion.authority_m, motion.position_m if at_end else end_m)
        return room_m, False
    braking_m = braking_distance(v, b, kind.braking)
    too_near = room_m < braking_m - ROUNDING_M
    if too_near:
        room_m, end_m = braking_m, motion.position_m + braking_m
    motion.authority_m = min(motion.authority_m, end_m)
    return room_m, too_near


@inlined
def give_authority(
    end_m: float,
    gate_m: float,
    least_m: float,
    step_s: float,
    train: Train,
    kind: TrainType,
    signalling: Signalling,
) -> bool:
    """Set how far and how fast a train may go; return whether it is nearer than it can brake for.

    Parameters
    ----------
    end_m : float
        Position that it may not pass because of the train ahead. [m]
    gate_m : float
        Position of a gate that it may not pass, for which it brakes as for a stop. [m]
    least_m : float
        Distance to the gate for which a train that stands starts. [m]
    """
    motion, too_near = train.motion, False
    motion.authority_m, motion.ceiling_m_s = math.inf, math.inf
    if gate_m < math.inf:
        _, too_near = _brake_for(gate_m, least_m, motion, kind)
    if end_m == math.inf:
        return too_near
    room_m, ahead_too_near = _brake_for(end_m, RESTART_M, motion, kind)
    if motion.speed_m_s > 0.0:
        b, reach_s = kind.highest_retardation_m_s2, max(signalling.reaction_s, step_s)
        calm = math.sqrt((b * reach_s) ** 2 + 2.0 * b * max(0.0, room_m)) - b * reach_s
        motion.ceiling_m_s = max(SLOWEST_M_S, calm)
    return too_near or ahead_too_near


@inlined
def _is_held(motion: Motion) -> bool:
    """Whether a train stands where it may not go on."""
    held = motion.authority_m <= motion.position_m and motion.speed_m_s <= 0.0
    return held and motion.phase == Phase.DRIVING


@kernel
def keep_apart(
    count: int, step_s: float, standing: Records[Standing], trains: Records[Train],
    types: Records[TrainType], legs: Records[Leg], rules: Gates, turns: Turns,
    occupancies: Records[Occupancy], first: Indices, signalling: Signalling,
    now_s: float, halts: Halts, waits_for: npt.NDArray[np.int32],
) -> int:  # fmt: skip
    """Give the first `count` trains of `standing` their authorities in a step; note whom they wait for.

    Returns
    -------
    int
        Number of trains that are nearer to another one, or to a gate, than they can brake for.
    """
    note_places(count, standing, trains, types, legs, turns.holdings, occupancies, first)
    too_near = 0
    for n in range(count):
        i = standing[at(n)].train
        train, held = trains[at(i)], turns.holdings[at(i)]
        kind = types[at(train.train_type)]
        reach_m = reach_of(kind, signalling.reaction_s, step_s)
        reach_m += signalling.margin_m + signalling.block_m
        gate = rules.gates[at(train.route), at(held.next)]
        end_m, whom = end_of_authority(
            i, reach_m, held.end_m, gate.aside, train, legs, occupancies, first, signalling
        )
        held.ahead_m = end_m
        stop_m = held.end_m
        if halts.times_s.size > 0:
            stop_m = min(stop_m, halt_ahead(now_s, train, kind, halts))
        # Where it stops before the gate, it comes no further by waiting for more room.
        least_m = 0.0 if held.calls and stop_m == held.end_m else RESTART_M
        too_near += give_authority(end_m, stop_m, least_m, step_s, train, kind, signalling)
        held.waits_for = NOBODY
        if _is_held(train.motion):
            near_m = train.motion.position_m + RESTART_M
            if held.end_m < near_m:
                held.waits_for = in_the_way(i, count, standing, trains, rules, turns)
            elif end_m < near_m:
                held.waits_for = whom
            waits_for[at(i)] = held.waits_for
    return too_near
