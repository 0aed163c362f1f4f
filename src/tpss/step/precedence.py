"""Trains wait at gates until it is their turn: on single tracks, and where routes come together.

At the start of each step it is found out who is on which stretch, and who wants to pass a gate within
its braking distance.  A train may pass

1. in timetable order, if it is the next one of the planned order at the stretch, and at the crossing
   place at its end; otherwise if the stretch is not kept for one that asked before,
2. if the train that was let in before it has passed its gate with its rear, and the margin,
3. if nobody runs on the stretch in the other direction,
4. if a track is free at the crossing place at its end, for trains that stand there or come there,
5. where there is no planned order, if all that are under way can come to their ends from there, one
   after another, as in `run.dispatch`.

Those that asked first are let in first; a stretch is kept for one that has to wait for 2 or 3 only.

What a train has been granted it keeps until its head, or its rear, has left the stretch.  It does not
ask for what lies behind its next stop, nor at a stop before the step in which it may leave, nor behind
another train that is still before the gate.
"""

import math

from tpss.driving.data import Stop
from tpss.kernel import at, inlined, kernel
from tpss.powerflow.network import Standing
from tpss.record import Records
from tpss.step.deadlock import all_come_through
from tpss.step.turns import (
    AT_GATE_M,
    NOBODY,
    Gates,
    Holding,
    Obstacle,
    Turn,
    Turns,
    Use,
    has_track,
)
from tpss.track.gate import Gate
from tpss.vehicle.braking import braking_distance
from tpss.vehicle.train import Phase, Train
from tpss.vehicle.train_type import TrainType


@inlined
def reach_of(kind: TrainType, reaction_s: float, step_s: float) -> float:
    """Distance within which a train that runs as fast as it can has to know what it may do. [m]"""
    b, fastest = kind.highest_retardation_m_s2, kind.highest_speed_m_s
    return braking_distance(fastest, b, kind.braking) + fastest * (reaction_s + 2.0 * step_s)


@inlined
def _take_turn(gate: Gate, turn: Turn, turns: Turns) -> None:
    """Let the turn go on to the next train, at a stretch and the crossing place at its end."""
    use = turns.uses[at(gate.stretch)]
    use.turn = max(use.turn, turn.stretch + 1)
    if gate.place >= 0:
        place = turns.places[at(gate.place)]
        place.turn = max(place.turn, turn.place + 1)


@inlined
def _add_train(gate: Gate, use: Use) -> None:
    if gate.direction == 0:
        use.trains_0 += 1
    else:
        use.trains_1 += 1


@inlined
def _let_in(i: int, gate: Gate, turns: Turns) -> None:
    """Grant train `i` its next gate."""
    held, use = turns.holdings[at(i)], turns.uses[at(gate.stretch)]
    _take_turn(gate, turns.turns[at(i), at(held.next)], turns)
    _add_train(gate, use)
    use.enters = i
    if gate.place >= 0:
        turns.places[at(gate.place)].taken += 1
    held.next += 1
    held.asked = math.inf


@kernel
def note_use(
    i: int, train: Train, length_m: float, margin_m: float, rules: Gates, turns: Turns
) -> None:
    """Note which stretches and crossing places train `i` uses as a step begins."""
    held, head_m, route = turns.holdings[at(i)], train.motion.position_m, train.route
    # 1. A train that was placed on the line behind gates has not asked for them.
    while rules.gates[at(route), at(held.next)].from_m < head_m - AT_GATE_M:
        gate = rules.gates[at(route), at(held.next)]
        _take_turn(gate, turns.turns[at(i), at(held.next)], turns)
        held.next += 1
    # 2. Stretches that it has left.
    while held.first < held.next:
        gate = rules.gates[at(route), at(held.first)]
        if head_m < gate.until_m + length_m * gate.clears_whole - AT_GATE_M:
            break
        held.first += 1
    # 3. Those that it has not, and the tracks at their ends, until it has passed the next gate.
    for k in range(max(held.first - 1, 0), held.next):
        gate = rules.gates[at(route), at(k)]
        if has_track(train, k, rules):
            turns.places[at(gate.place)].taken += 1
        if k >= held.first:
            use = turns.uses[at(gate.stretch)]
            _add_train(gate, use)
            if head_m - length_m - margin_m <= gate.from_m:
                use.enters = i


@inlined
def calls_before(train: Train, gate: Gate, step_s: float, stops: Records[Stop]) -> bool:
    """Whether a train stops before its next gate, or for a step and more at it."""
    stop = stops[at(train.route), at(train.motion.next_stop)]
    if stop.position_m > gate.from_m + AT_GATE_M:
        return False
    return stop.position_m < gate.from_m - AT_GATE_M or stop.dwell_s >= step_s


@inlined
def asks(train: Train, gate: Gate, reach_m: float, calls: bool, step_s: float) -> bool:
    """Whether a train wants to pass its next gate, which lies within its reach or not."""
    motion, room_m = train.motion, gate.from_m - train.motion.position_m
    leaves = motion.phase != Phase.DWELLING or motion.wait_s < step_s
    return room_m <= reach_m and leaves and not calls


@inlined
def _run_against(gate: Gate, use: Use, held: Holding, train: Train, rules: Gates) -> int:
    """Number of other trains that run on a stretch in the other direction."""
    against = use.trains_1 if gate.direction == 0 else use.trains_0
    for k in range(held.first, held.next):  # a train that turns round on it
        own = rules.gates[at(train.route), at(k)]
        if own.stretch == gate.stretch and own.direction != gate.direction:
            against -= 1
    return against


@kernel
def obstacle_at(i: int, train: Train, rules: Gates, turns: Turns) -> Obstacle:
    """What keeps train `i` from passing its next gate."""
    held = turns.holdings[at(i)]
    gate, turn = rules.gates[at(train.route), at(held.next)], turns.turns[at(i), at(held.next)]
    use = turns.uses[at(gate.stretch)]
    if turn.stretch >= 0:
        if use.turn != turn.stretch:
            return Obstacle.TURN
    elif use.kept_for != NOBODY:
        return Obstacle.KEPT
    if use.enters != NOBODY:
        return Obstacle.ENTRY
    if _run_against(gate, use, held, train, rules) > 0:
        return Obstacle.ONCOMING
    if gate.place >= 0:
        place = turns.places[at(gate.place)]
        if turn.place >= 0 and place.turn != turn.place:
            return Obstacle.PLACE_TURN
        if place.taken >= rules.tracks[at(gate.place)]:
            return Obstacle.PLACE
    return Obstacle.NONE


@inlined
def _blank(turns: Turns) -> None:
    """Nobody uses anything, before trains are asked."""
    for s in range(turns.uses.size):
        use = turns.uses[at(s)]
        use.trains_0 = use.trains_1 = 0
        use.enters = use.kept_for = NOBODY
    for p in range(turns.places.size):
        turns.places[at(p)].taken = 0


@inlined
def _ask(
    now_s: float, step_s: float, reaction_s: float, train: Train, kind: TrainType, held: Holding,
    stops: Records[Stop], rules: Gates,
) -> None:  # fmt: skip
    """Let a train ask for its next gate, if it comes to it."""
    gate, reach_m = rules.gates[at(train.route), at(held.next)], reach_of(kind, reaction_s, step_s)
    within = gate.from_m - train.motion.position_m <= reach_m
    held.end_m = gate.from_m if within else math.inf
    held.tried, held.obstacle = False, Obstacle.NONE
    held.calls = calls_before(train, gate, step_s, stops)
    wants = held.ahead_m >= gate.from_m and asks(train, gate, reach_m, held.calls, step_s)
    held.asked = min(held.asked, now_s) if wants else math.inf


@inlined
def _try_again(count: int, standing: Records[Standing], turns: Turns) -> None:
    """Let trains try again whose turn may have come."""
    for n in range(count):
        held = turns.holdings[at(standing[at(n)].train)]
        if held.obstacle == Obstacle.TURN or held.obstacle == Obstacle.PLACE_TURN:
            held.tried = False


@inlined
def _next_to_try(count: int, standing: Records[Standing], turns: Turns) -> int:
    """Train that asked first among those that ask and were not tried; -1: there is none."""
    found, asked_s = NOBODY, math.inf
    for n in range(count):
        i = standing[at(n)].train
        held = turns.holdings[at(i)]
        if held.tried or held.asked == math.inf:
            continue
        if held.asked < asked_s or (held.asked == asked_s and i < found):
            found, asked_s = i, held.asked
    return found


@inlined
def _note_standing(train: Train, held: Holding, rules: Gates) -> None:
    """Note whether a train stands before a gate that it may not pass yet."""
    gate = rules.gates[at(train.route), at(held.next)]
    there = abs(gate.from_m - train.motion.position_m) <= AT_GATE_M
    held.stands = there and train.motion.speed_m_s <= 0.0
    held.aside = held.stands and gate.aside


@kernel
def let_pass(
    count: int, now_s: float, step_s: float, reaction_s: float, margin_m: float,
    standing: Records[Standing], trains: Records[Train], types: Records[TrainType],
    stops: Records[Stop], rules: Gates, turns: Turns,
) -> None:  # fmt: skip
    """Find which gates the first `count` trains of `standing` may pass in a step. [s]"""
    _blank(turns)
    for n in range(count):
        i = standing[at(n)].train
        train = trains[at(i)]
        note_use(i, train, types[at(train.train_type)].length_m, margin_m, rules, turns)
    for n in range(count):
        i = standing[at(n)].train
        train, held = trains[at(i)], turns.holdings[at(i)]
        _ask(now_s, step_s, reaction_s, train, types[at(train.train_type)], held, stops, rules)
    while True:
        i = _next_to_try(count, standing, turns)
        if i == NOBODY:
            break
        train, held = trains[at(i)], turns.holdings[at(i)]
        gate = rules.gates[at(train.route), at(held.next)]
        held.obstacle = obstacle_at(i, train, rules, turns)
        planned = turns.turns[at(i), at(held.next)].stretch >= 0
        if held.obstacle == Obstacle.NONE and not (
            planned or all_come_through(i, count, standing, trains, rules, turns)
        ):
            held.obstacle = Obstacle.NO_WAY
        if held.obstacle == Obstacle.NONE:
            _let_in(i, gate, turns)
            _try_again(count, standing, turns)
            _ask(now_s, step_s, reaction_s, train, types[at(train.train_type)], held, stops, rules)
        else:
            held.tried = True
            if not planned and held.obstacle in (Obstacle.ENTRY, Obstacle.ONCOMING):
                turns.uses[at(gate.stretch)].kept_for = i
    for n in range(count):
        i = standing[at(n)].train
        _note_standing(trains[at(i)], turns.holdings[at(i)], rules)
