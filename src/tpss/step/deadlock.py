"""Whether trains would come to wait for each other, who is in the way of one that stands, and whether
trains wait in a circle.

A train that stands because of others waits for one of them: the train ahead, or at a gate that which
has the turn, runs against it, or has to pass the gate first.  It waits for as long as that one does; for
a track at a crossing place it waits as long as all that have one there, and for a way to be left to all
as long as all others.  Trains that wait for none but each other will do so for ever.
"""

from tpss.kernel import at, inlined, kernel
from tpss.powerflow.network import Standing
from tpss.record import Records
from tpss.step.turns import NOBODY, Gates, Holding, Obstacle, Turns, has_track
from tpss.track.gate import Gate
from tpss.vehicle.train import Train


@inlined
def _foresee(i: int, count: int, standing: Records[Standing], trains: Records[Train], rules: Gates,
             turns: Turns) -> int:  # fmt: skip
    """Let trains come as far as they have been let, and train `i` past its next gate; return the number
    of those that are at a crossing place then.
    """
    for p in range(turns.places.size):
        turns.places[at(p)].foreseen = 0
    there = 0
    for n in range(count):
        j = standing[at(n)].train
        held, k = turns.holdings[at(j)], turns.holdings[at(j)].next - (j != i)
        held.foreseen = NOBODY
        if k >= 0 and has_track(trains[at(j)], k, rules):
            held.foreseen = rules.gates[at(trains[at(j)].route), at(k)].place
            turns.places[at(held.foreseen)].foreseen += 1
            there += 1
    return there


@inlined
def _finds_tracks(first: int, route: int, rules: Gates, turns: Turns) -> bool:
    """Whether a track is free at all crossing places behind the gates of a route from one on."""
    for k in range(first, rules.gates.shape[1] - 1):
        p = rules.gates[at(route), at(k)].place
        if p >= 0 and turns.places[at(p)].foreseen >= rules.tracks[at(p)]:
            return False
    return True


@kernel
def all_come_through(
    i: int, count: int, standing: Records[Standing], trains: Records[Train], rules: Gates,
    turns: Turns,
) -> bool:  # fmt: skip
    """Whether all trains could come to their ends after train `i` has passed its next gate."""
    left = _foresee(i, count, standing, trains, rules, turns)
    found = True
    while left > 0 and found:
        found = False
        for n in range(count):
            j = standing[at(n)].train
            held, route = turns.holdings[at(j)], trains[at(j)].route
            if held.foreseen == NOBODY:
                continue
            place = turns.places[at(held.foreseen)]
            place.foreseen -= 1
            if _finds_tracks(held.next + (j == i), route, rules, turns):
                held.foreseen = NOBODY
                left -= 1
                found = True
            else:
                place.foreseen += 1
    return left == 0


@kernel
def whose_turn(
    gate: Gate, at_place: bool, trains: Records[Train], rules: Gates, turns: Turns
) -> int:
    """Train that has the turn at a stretch, or at the crossing place at its end; -1: nobody."""
    wanted = turns.places[at(gate.place)].turn if at_place else turns.uses[at(gate.stretch)].turn
    for i in range(trains.size):
        for k in range(turns.holdings[at(i)].next, rules.gates.shape[1] - 1):
            other, turn = rules.gates[at(trains[at(i)].route), at(k)], turns.turns[at(i), at(k)]
            if at_place and other.place == gate.place and turn.place == wanted:
                return i
            if not at_place and other.stretch == gate.stretch and turn.stretch == wanted:
                return i
    return NOBODY


@inlined
def _runs_against(gate: Gate, train: Train, held: Holding, rules: Gates) -> bool:
    """Whether a train runs on the stretch behind a gate in the other direction."""
    for k in range(held.first, held.next):
        other = rules.gates[at(train.route), at(k)]
        if other.stretch == gate.stretch and other.direction != gate.direction:
            return True
    return False


@inlined
def _has_place(place: int, train: Train, held: Holding, rules: Gates) -> bool:
    """Whether a train has a track at a crossing place."""
    for k in range(max(held.first - 1, 0), held.next):
        if rules.gates[at(train.route), at(k)].place == place and has_track(train, k, rules):
            return True
    return False


@kernel
def in_the_way(
    i: int, count: int, standing: Records[Standing], trains: Records[Train], rules: Gates,
    turns: Turns,
) -> int:  # fmt: skip
    """Train for which train `i` waits at its gate, one of the first `count` of `standing`, or one that
    has not departed; -1: none is known.
    """
    held = turns.holdings[at(i)]
    gate = rules.gates[at(trains[at(i)].route), at(held.next)]
    obstacle = held.obstacle
    if obstacle == Obstacle.KEPT:
        return turns.uses[at(gate.stretch)].kept_for
    if obstacle == Obstacle.TURN or obstacle == Obstacle.PLACE_TURN:
        return whose_turn(gate, obstacle == Obstacle.PLACE_TURN, trains, rules, turns)
    if obstacle == Obstacle.ENTRY:
        return turns.uses[at(gate.stretch)].enters
    for n in range(count):
        j = standing[at(n)].train
        train, other = trains[at(j)], turns.holdings[at(j)]
        if j == i:
            continue
        if obstacle == Obstacle.ONCOMING and _runs_against(gate, train, other, rules):
            return j
        if obstacle == Obstacle.PLACE and _has_place(gate.place, train, other, rules):
            return j
        if obstacle == Obstacle.NO_WAY and other.foreseen != NOBODY:
            return j
    return NOBODY


@inlined
def _all_are_stuck(
    i: int, count: int, standing: Records[Standing], trains: Records[Train], rules: Gates,
    turns: Turns,
) -> bool:  # fmt: skip
    """Whether all trains are stuck of which one would do if it went on: those that have a track at the
    crossing place that train `i` waits for, or all others.
    """
    held = turns.holdings[at(i)]
    place = rules.gates[at(trains[at(i)].route), at(held.next)].place
    for n in range(count):
        j = standing[at(n)].train
        other = turns.holdings[at(j)]
        if j == i or other.stuck:
            continue
        if held.obstacle == Obstacle.NO_WAY or _has_place(place, trains[at(j)], other, rules):
            return False
    return True


@kernel
def find_deadlock(
    count: int, standing: Records[Standing], trains: Records[Train], rules: Gates, turns: Turns
) -> int:
    """A train of the first `count` of `standing` that waits in a circle; -1: there is none."""
    # 1. All that wait may be stuck; whoever waits for nobody, or is not on the line, is not.
    waiting = 0
    for n in range(count):
        held = turns.holdings[at(standing[at(n)].train)]
        held.stuck = held.waits_for != NOBODY
        waiting += held.stuck
    # 2. Nor is, again and again, who waits for one that is not.
    found = waiting > 0
    while found:
        found = False
        for n in range(count):
            i = standing[at(n)].train
            held = turns.holdings[at(i)]
            if not held.stuck:
                continue
            stuck = turns.holdings[at(held.waits_for)].stuck
            if held.obstacle in (Obstacle.PLACE, Obstacle.NO_WAY):
                stuck = _all_are_stuck(i, count, standing, trains, rules, turns)
            if not stuck:
                held.stuck = False
                found = True
    # 3. The others wait for each other.
    for n in range(count):
        if turns.holdings[at(standing[at(n)].train)].stuck:
            return standing[at(n)].train
    return NOBODY
