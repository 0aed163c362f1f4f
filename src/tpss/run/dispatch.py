"""The order of trains at gates: who passes first, such that all come through.

Trains are let through their gates one after another, as in the simulation, but by their planned times:
each asks at its time, and of those that wait the one that asked first may pass, if the stretch and a
track at the crossing place behind it are free; for one that waits for the stretch to be left by others,
it is kept.  A train that has to wait is later from then on.  None is let in if those that are under way
could not all come to their ends from there, one after another: so trains never block each other
[Dijkstra1965]_.  Those that wait on one track go on in the order in which they stand, whichever way each
of them takes behind its gate.
"""

import heapq
import math
from functools import partial
from typing import NamedTuple

from tpss.run.under_way import OnTheWay, Passage, all_come_through


class NoOrderError(ValueError):
    """Trains cannot all come through: which ones are in each other's way."""

    def __init__(self, one: int, other: int) -> None:
        super().__init__(f"trains {one} and {other} are in each other's way")
        self.one, self.other = one, other


class Order(NamedTuple):
    """Turns of all trains at their gates; -1 at a crossing place that is none."""

    stretch: list[list[int]]
    place: list[list[int]]


class _Event(NamedTuple):
    """What a train comes to."""

    time_s: float
    train: int
    gate: int
    leaves: bool
    """Whether it leaves the stretch behind the gate; otherwise it comes to the gate."""


class Dispatcher:
    """Lets trains pass; see the module.

    Parameters
    ----------
    passages : list of lists of Passage
        Of each train, in its order.
    tracks : list of int
        Number of tracks of the crossing places.
    """

    def __init__(self, passages: list[list[Passage]], tracks: list[int]) -> None:
        self.trains = [OnTheWay(each) for each in passages]
        self.tracks = tracks
        self.users: dict[int, set[int]] = {}
        """Trains on each stretch."""
        self.taken: dict[int, set[int]] = {}
        """Trains that have a track at each crossing place."""
        self.under_way: set[int] = set()
        """Trains on any stretch, at a crossing place, or where others wait behind them."""
        self.queues: dict[tuple[int, int], list[int]] = {}
        """Trains on a stretch in a direction, in the order in which they leave it."""
        self.coming: dict[int, list[int]] = {}
        """Trains on their way to a place where they wait on one track, in their order."""
        self.behind: dict[tuple[int, int], list[_Event]] = {}
        """What trains come to once those before them have left a stretch in their direction."""
        self.turns: dict[tuple[str, int], int] = {}
        self.order = Order([[] for _ in passages], [[] for _ in passages])
        self.waiting: list[tuple[float, int]] = []
        """Trains at their gates, by the time at which they asked."""
        self.events: list[_Event] = []

    def run(self) -> Order:
        """The order in which trains come through.

        Raises
        ------
        NoOrderError
            Trains that are on their way at the start cannot all come through.
        """
        for i in range(len(self.trains)):
            self._place(i)
        for i in sorted(self.under_way):
            self._demand_no_opponent(i)
        for (stretch, _), queue in self.queues.items():
            queue.sort(key=partial(self._leaves_s, stretch))
        while self.events:
            event = heapq.heappop(self.events)
            if self._is_later(event) or self._follows_another(event):
                continue
            if event.leaves:
                self._leave(event)
            else:
                self._come(event.train)
                heapq.heappush(self.waiting, (event.time_s, event.train))
            self._let_pass(event.time_s)
        if self.waiting:
            blocked = [i for _, i in self.waiting]
            raise NoOrderError(blocked[0], self._opponent_of(blocked[0]))
        return self.order

    def _leaves_s(self, stretch: int, i: int) -> float:
        """When a train leaves a stretch on which it is. [s]"""
        train = self.trains[i]
        clear_s = [train.passages[k].clear_s for k, other in train.on.items() if other == stretch]
        return min(clear_s) + train.late_s

    def _place(self, i: int) -> None:
        """Let a train be where it stands at the start, and come to its next gate."""
        train = self.trains[i]
        while train.next < len(train.passages) and train.passages[train.next].ready_s == -math.inf:
            self._enter(i, -math.inf)
        self._plan_next(i)

    def _line_up(self, i: int, gate: int) -> None:
        """Let a train come to a stretch behind those before it: at one place they keep their order."""
        here = self.trains[i].passages[gate]
        queue = self.queues.setdefault((here.stretch, here.direction), [])
        leaves_s = self._leaves_s(here.stretch, i)
        k = len(queue)
        while k > 0 and self._leaves_s(here.stretch, queue[k - 1]) > leaves_s:
            others = self.trains[queue[k - 1]]
            entries = [p.entry_m for g, p in enumerate(others.passages) if g in others.on]
            if here.entry_m in entries:
                break
            k -= 1
        queue.insert(k, i)

    def _come(self, i: int) -> None:
        """Let a train come to a gate where it cannot pass others: behind those that left its last
        stretch before it, otherwise by their times.
        """
        train = self.trains[i]
        if train.waits_on(train.next) < 0 or train.lined_up:
            return
        train.lined_up = True
        self._note(i)
        here = train.passages[train.next]
        queue = self.coming.setdefault(here.waits_on, [])
        k = len(queue)
        while k > 0:
            other = self.trains[queue[k - 1]]
            if other.last_gate == train.last_gate or (
                other.passages[other.next].ready_s + other.late_s <= here.ready_s + train.late_s
            ):
                break
            k -= 1
        queue.insert(k, i)

    def _plan_next(self, i: int) -> None:
        train = self.trains[i]
        if train.next < len(train.passages):
            at_s = train.passages[train.next].ready_s + train.late_s
            heapq.heappush(self.events, _Event(at_s, i, train.next, leaves=False))

    def _enter(self, i: int, now_s: float) -> None:
        """Let a train pass its next gate at a time, and plan when it leaves the stretch. [s]"""
        train = self.trains[i]
        number, here = train.next, train.passages[train.next]
        self._leave_place(i)
        if train.lined_up:
            self.coming[here.waits_on].remove(i)
            train.lined_up = False
        train.next += 1
        self.order.stretch[i].append(self._turn("stretch", here.stretch))
        self.order.place[i].append(self._turn("place", here.place) if here.place >= 0 else -1)
        if here.place >= 0:
            train.place = here.place
            self.taken.setdefault(here.place, set()).add(i)
        self._note(i)
        if here.clear_s == -math.inf:  # it has left it before the start
            return
        train.on[number] = here.stretch
        self.users.setdefault(here.stretch, set()).add(i)
        self._note(i)
        if now_s > -math.inf:
            train.late_s = max(train.late_s, now_s - here.ready_s)
        self._line_up(i, number)
        self._plan_leaving(i)

    def _plan_leaving(self, i: int) -> None:
        """Plan when a train leaves stretches, of those that it leaves before it comes to a gate."""
        train = self.trains[i]
        gate_s = math.inf
        if train.next < len(train.passages):
            gate_s = train.passages[train.next].ready_s
        for number in train.on:
            clear_s = train.passages[number].clear_s
            if clear_s <= gate_s and number not in train.leaves:
                train.leaves.add(number)
                event = _Event(clear_s + train.late_s, i, number, leaves=True)
                heapq.heappush(self.events, event)

    def _is_later(self, event: _Event) -> bool:
        """Put what a train comes to off that has become later since that was planned."""
        train = self.trains[event.train]
        here = train.passages[event.gate]
        time_s = (here.clear_s if event.leaves else here.ready_s) + train.late_s
        if time_s <= event.time_s:
            return False
        heapq.heappush(self.events, event._replace(time_s=time_s))
        return True

    def _follows_another(self, event: _Event) -> bool:
        """Keep what a train comes to on a stretch until those before it have left that."""
        train = self.trains[event.train]
        for number, stretch in train.on.items():
            if event.leaves and number != event.gate:
                continue
            queue = stretch, train.passages[number].direction
            if self.queues[queue][0] != event.train:
                self.behind.setdefault(queue, []).append(event)
                return True
        return False

    def _turn(self, kind: str, index: int) -> int:
        turn = self.turns.get((kind, index), 0)
        self.turns[kind, index] = turn + 1
        return turn

    def _leave(self, event: _Event) -> None:
        """Let a train leave the stretch behind a gate, and those behind it come on."""
        i, train = event.train, self.trains[event.train]
        train.late_s = max(train.late_s, event.time_s - train.passages[event.gate].clear_s)
        stretch = train.on.pop(event.gate)
        if stretch not in train.on.values():
            self.users[stretch].discard(i)
        queue = stretch, train.passages[event.gate].direction
        self.queues[queue].remove(i)
        if not train.on:
            self._come(i)
        for kept in self.behind.pop(queue, []):
            heapq.heappush(self.events, kept._replace(time_s=max(kept.time_s, event.time_s)))
        self._note(i)

    def _note(self, i: int) -> None:
        """Note whether a train is under way."""
        train = self.trains[i]
        is_let_on = train.lined_up or (train.next > 0 and train.waits_on(train.next) >= 0)
        if train.on or train.place >= 0 or is_let_on:
            self.under_way.add(i)
        else:
            self.under_way.discard(i)

    def _leave_place(self, i: int) -> None:
        train = self.trains[i]
        if train.place >= 0:
            self.taken[train.place].discard(i)
            train.place = -1

    def _let_pass(self, now_s: float) -> None:
        """Let trains that wait pass, those first that asked first, until none can."""
        passed = True
        while passed:
            passed = False
            kept = set[int]()  # stretches for trains that pass once the others have left them
            for entry in sorted(self.waiting):
                i = entry[1]
                here = self.trains[i].passages[self.trains[i].next]
                if here.waits_on >= 0 and self.coming[here.waits_on][0] != i:
                    continue
                if self._is_against_others(i, here):
                    kept.add(here.stretch)
                elif here.stretch not in kept and self._has_room(i, here):
                    self.waiting.remove(entry)
                    self._enter(i, now_s)
                    self._plan_next(i)
                    passed = True
                    break

    def _is_against_others(self, i: int, here: Passage) -> bool:
        """Whether others run on a stretch in the other direction."""
        others = self.users.get(here.stretch, set()) - {i}
        return any(self._runs_against(j, here) for j in others)

    def _has_room(self, i: int, here: Passage) -> bool:
        """Whether a track is free behind a stretch, such that all come through."""
        if here.place >= 0 and len(self.taken.get(here.place, ())) >= self.tracks[here.place]:
            return False
        return all_come_through(i, self.under_way, self.trains, self.coming, self.tracks)

    def _runs_against(self, j: int, here: Passage) -> bool:
        """Whether a train is on a stretch in the other direction."""
        other = self.trains[j]
        return any(
            stretch == here.stretch and other.passages[gate].direction != here.direction
            for gate, stretch in other.on.items()
        )

    def _demand_no_opponent(self, i: int) -> None:
        """Refuse trains that stand on a stretch head to head."""
        train = self.trains[i]
        for gate, stretch in train.on.items():
            for j in self.users[stretch] - {i}:
                if self._runs_against(j, train.passages[gate]):
                    raise NoOrderError(i, j)

    def _opponent_of(self, i: int) -> int:
        """A train that is in the way of one at its gate."""
        here = self.trains[i].passages[self.trains[i].next]
        others = self.users.get(here.stretch, set()) | self.taken.get(here.place, set())
        return next(iter(sorted(others - {i})), i)
