"""The order in which trains come through gates, from planned times that can be followed by hand.

A line of two single tracks, 0 and 1, with a crossing place 0 between them; a train takes 10 minutes for
each.  Trains up pass track 0 first, trains down track 1.
"""

import math

import pytest

from tpss.run.dispatch import Dispatcher, NoOrderError
from tpss.run.under_way import Passage

UP, DOWN = 0, 1
NONE = -1


def up(start_min: float) -> list[Passage]:
    return [
        Passage(0, UP, 0, start_min, start_min + 10.0, NONE, 0.0),
        Passage(1, UP, NONE, start_min + 10.0, start_min + 20.0, NONE, 1.0),
    ]


def down(start_min: float) -> list[Passage]:
    return [
        Passage(1, DOWN, 0, start_min, start_min + 10.0, NONE, 2.0),
        Passage(0, DOWN, NONE, start_min + 10.0, start_min + 20.0, NONE, 1.0),
    ]


def order_of(*trains: list[Passage], tracks: int = 2) -> list[list[int]]:
    return Dispatcher(list(trains), [tracks]).run().stretch


def test_trains_that_meet_at_the_crossing_place_pass_as_they_come():
    """Up is on track 0 until 10, down comes to it at 10; track 1 the other way round."""
    assert order_of(up(0.0), down(0.0)) == [[0, 1], [0, 1]]


def test_of_trains_that_would_meet_on_a_track_the_later_one_waits():
    """Down comes to track 1 at 15, where up is from 10 to 20: it waits, and is on track 0 from 30 on.

    A train up at 28 is there before it.
    """
    assert order_of(up(0.0), down(15.0), up(28.0)) == [[0, 0], [1, 2], [1, 2]]


def test_a_train_is_not_let_in_from_where_not_all_could_come_through():
    """Of two tracks, the first train up waits at the crossing place for two down, close behind.

    A second one up, due at 1, may take the second track; then neither down would find one.  It waits
    until the first one down has come through.
    """
    stays = [up(0.0)[0], Passage(1, UP, NONE, 14.0, 24.0)]
    assert order_of(stays, down(0.5), down(3.5), up(4.0))[3][0] > 1


def test_a_crossing_place_of_one_track_lets_one_train_wait():
    """A junction: up takes its only track at 0, so that down has to wait before track 1 until 20."""
    found = Dispatcher([up(0.0), down(5.0)], [1]).run()
    assert found.stretch == [[0, 0], [1, 1]]
    assert found.place == [[0, NONE], [1, NONE]]


def test_trains_that_stand_on_one_track_keep_the_order_in_which_they_are_there():
    """Both wait for down on track 0 until 20; the second one, due first by a rounding, is behind."""
    blocked = [Passage(0, DOWN, NONE, 0.0, 20.0)]
    first = [Passage(7, UP, NONE, 1.0, 1.5), Passage(0, UP, NONE, 5.0, 15.0, waits_on=0)]
    second = [Passage(7, UP, NONE, 2.0, 2.5), Passage(0, UP, NONE, 5.0 - 1e-9, 15.0, waits_on=0)]
    assert order_of(blocked, second, first) == [[0], [1, 2], [0, 1]]


def test_trains_that_wait_on_one_track_keep_their_order_whichever_way_they_go():
    """The first one waits for down on track 0 until 20.  The second one, behind it, could go on to track
    1 at 6; it does so after one down there, from 10 to 20.
    """
    blocked = [Passage(0, DOWN, NONE, 0.0, 20.0)]
    first = [Passage(7, UP, NONE, 1.0, 1.5), Passage(0, UP, NONE, 5.0, 15.0, waits_on=0)]
    second = [Passage(7, UP, NONE, 2.0, 2.5), Passage(1, UP, NONE, 6.0, 16.0, waits_on=0)]
    other = [Passage(1, DOWN, NONE, 10.0, 20.0)]
    assert order_of(blocked, first, second, other) == [[0], [0, 1], [1, 1], [0]]


def test_a_train_is_not_let_behind_one_that_waits_for_others_that_it_would_block():
    """Places 0 and 1 have one track each.  One train waits on track 0 of a junction for place 1, where
    another one is, which wants place 0.  A third one, whose way from place 0 leads behind the first,
    may not come there before the other one has gone on.
    """
    before = -math.inf
    waits = [Passage(5, UP, NONE, before, before), Passage(1, UP, 1, 5.0, 15.0, waits_on=0),
             Passage(2, UP, NONE, 15.0, 25.0)]  # fmt: skip
    other = [Passage(2, DOWN, 1, before, before), Passage(3, UP, 0, 12.0, 22.0),
             Passage(4, UP, NONE, 22.0, 32.0)]  # fmt: skip
    third = [Passage(6, UP, 0, 1.0, 11.0), Passage(7, UP, NONE, 11.0, 12.0),
             Passage(8, UP, NONE, 13.0, 20.0, waits_on=0)]  # fmt: skip
    found = Dispatcher([waits, other, third], [1, 1]).run()
    assert found.place[1][1] < found.place[2][0]


def test_a_train_that_had_to_wait_lines_up_by_when_it_goes():
    """One enters track 0 half-way, due at 5, but waits until 26 for a place: it is out at 31.  Another
    one, in from the begin of the track at 20.5, is out before it, at 30.5, and goes on first.
    """
    half = [Passage(0, UP, 0, 5.0, 10.0, NONE, 50.0), Passage(1, UP, NONE, 10.0, 20.0)]
    whole = [Passage(0, UP, NONE, 20.5, 30.5), Passage(1, UP, NONE, 30.5, 40.0)]
    holds_the_place = [Passage(9, UP, 0, 0.0, 1.0), Passage(8, UP, NONE, 26.0, 30.0)]
    assert order_of(half, whole, holds_the_place, tracks=1)[:2] == [[1, 1], [0, 0]]


def test_a_train_that_enters_on_the_way_is_ahead_of_one_that_has_not_come_there():
    """Of track 0 the second train takes the last half only, from 5 on: it leaves it first, at 10."""
    slow = [Passage(0, UP, 0, 0.0, 30.0), Passage(1, UP, NONE, 30.0, 40.0)]
    enters = [Passage(0, UP, 0, 5.0, 10.0, NONE, 50.0), Passage(1, UP, NONE, 10.0, 20.0)]
    assert order_of(slow, enters) == [[0, 1], [1, 0]]


def test_trains_head_to_head_at_the_start_have_no_order():
    before = -math.inf
    one = [Passage(0, UP, NONE, before, 5.0)]
    other = [Passage(0, DOWN, NONE, before, 5.0)]
    with pytest.raises(NoOrderError) as caught:
        order_of(one, other)
    assert {caught.value.one, caught.value.other} == {0, 1}


def test_two_full_crossing_places_that_want_each_others_tracks_have_no_order():
    """Two trains up stand at place 0 and two down at place 1, with track 1 between."""
    before = -math.inf
    ups = [
        Passage(0, UP, 0, before, before),
        Passage(1, UP, 1, 1.0, 11.0),
        Passage(2, UP, NONE, 11.0, 21.0),
    ]
    downs = [
        Passage(2, DOWN, 1, before, before),
        Passage(1, DOWN, 0, 1.0, 11.0),
        Passage(0, DOWN, NONE, 11.0, 21.0),
    ]
    with pytest.raises(NoOrderError):
        Dispatcher([ups, ups, downs, downs], [2, 2]).run()
    assert Dispatcher([ups, ups, downs, downs], [3, 2]).run()


def test_who_stands_on_the_only_track_between_goes_before_one_that_waits_for_that_track():
    """One turns from track 0 to track 2 by way of place 0, of one track; the other one the other way.

    The other one, which comes to track 2 first, wants the place that this one has: it lets it go on.
    """
    one = [Passage(0, UP, 0, 0.0, 10.0, NONE, 0.0), Passage(2, UP, NONE, 12.0, 20.0, 0, 1.0)]
    other = [
        Passage(2, UP, 0, 11.0, 30.0, 1, 5.0),
        Passage(0, DOWN, NONE, 30.0, 40.0, NONE, 1.0),
    ]
    found = Dispatcher([one, other], [1]).run()
    assert found.stretch == [[0, 0], [1, 1]]
