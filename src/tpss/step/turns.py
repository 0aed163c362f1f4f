"""What trains hold of gates: who has been let in where, whose turn it is, what stands in the way."""

import math
from enum import IntEnum
from typing import NamedTuple

from tpss.kernel import at, inlined
from tpss.powerflow.network import Indices
from tpss.record import Record, Records
from tpss.track.gate import Gate
from tpss.vehicle.train import Train

NOBODY = -1

AT_GATE_M = 0.01
"""A train so close to a gate stands at it. [m]"""


class Obstacle(IntEnum):
    """What keeps a train from passing a gate."""

    NONE = 0
    TURN = 1
    """It is not its turn at the stretch."""
    PLACE_TURN = 2
    """It is not its turn at the crossing place."""
    KEPT = 3
    """The stretch is kept for another train."""
    ENTRY = 4
    """The train before has not passed its gate."""
    ONCOMING = 5
    PLACE = 6
    """No track is free."""
    NO_WAY = 7
    """From there not all trains could come to their ends."""


class Holding(Record):
    """What a train has been granted, and what it waits for."""

    first: int
    """First gate whose stretch it has not left."""
    next: int
    """Next gate, which it may not pass yet."""
    asked: float
    """Time at which it asked for it first; infinite: it has not. [s]"""
    stands: bool
    """Whether it stands at a gate that it may not pass yet."""
    aside: bool
    """Whether it does so on a track of its own."""
    waits_for: int
    """Train that is in its way while it stands, or -1."""
    obstacle: Obstacle
    """What keeps it from passing its gate."""
    stuck: bool
    """Whether all that it waits for wait for each other."""
    tried: bool
    """Whether it was its turn to be let in, in the present step."""
    foreseen: int
    """Crossing place to which it will come, see `all_come_through`; -1: to its end."""
    end_m: float
    """Position of the gate that it may not pass; infinite: it may go on. [m]"""
    calls: bool
    """Whether it stops before that gate or at it, and so does not ask for it yet."""
    ahead_m: float
    """End of its authority behind a train ahead, in the step before; infinite: there was none. [m]"""


class Use(Record):
    """Who uses a stretch, in the present step."""

    trains_0: int
    """Number of trains that run there in direction 0."""
    trains_1: int
    """Number of trains in direction 1."""
    enters: int
    """Train that has been let in and has not passed its gate, or -1."""
    kept_for: int
    """Train for which it is kept until others have left it, or -1."""
    turn: int
    """Turn of the train that is let in next."""


class PlaceUse(Record):
    """Who uses a crossing place, in the present step."""

    taken: int
    """Number of its tracks that are taken."""
    foreseen: int
    """Number of trains that will have come there, or not further, see `all_come_through`."""
    turn: int
    """Turn of the train that takes one next."""


class Turn(Record):
    """Turn of a train at a gate in the planned order; -1: it has none."""

    stretch: int
    place: int


class Gates(NamedTuple):
    """Gates of all routes, and the crossing places between them."""

    gates: Records[Gate]
    """Shape (routes, most gates and one more, which is infinite)."""
    tracks: Indices
    """Number of tracks of each crossing place."""


class Turns(NamedTuple):
    """What trains hold of gates."""

    turns: Records[Turn]
    """Shape (trains, most gates and one more)."""
    holdings: Records[Holding]
    uses: Records[Use]
    places: Records[PlaceUse]


def new_turns(trains: int, gates: Gates, turns: Records[Turn] | None = None) -> Turns:
    """Nothing granted yet; without turns, trains have none."""
    rows = gates.gates
    if turns is None:
        turns = no_turns(trains, gates)
    holdings = Holding.blank(trains)
    holdings["asked"] = math.inf
    holdings["waits_for"] = NOBODY
    holdings["end_m"] = holdings["ahead_m"] = math.inf
    uses = Use.blank(int(rows["stretch"].max(initial=-1)) + 1)
    return Turns(turns, holdings, uses, PlaceUse.blank(gates.tracks.size))


def no_turns(trains: int, gates: Gates) -> Records[Turn]:
    """Turns of trains that have none."""
    turns = Turn.blank(trains, gates.gates.shape[1])
    turns["stretch"] = turns["place"] = NOBODY
    return turns


@inlined
def has_track(train: Train, k: int, rules: Gates) -> bool:
    """Whether a train has a track at the crossing place behind the stretch of its `k`-th gate."""
    if rules.gates[at(train.route), at(k)].place < 0:
        return False
    beyond_m = rules.gates[at(train.route), at(k + 1)].from_m
    return train.motion.position_m <= beyond_m + AT_GATE_M
