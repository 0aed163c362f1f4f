"""How far a train may go behind others, from closed forms.

Brakes of 0.5 m/s² at all speeds; legs as of one line, up and down.
"""

import math
from typing import Any

import numpy as np
import pytest

from tpss.step.separation import (
    RESTART_M,
    Occupancy,
    Separation,
    Signalling,
    end_of_authority,
    give_authority,
    tracks_of,
)
from tpss.track.gate import Precedence
from tpss.track.leg import Leg
from tpss.vehicle.braking import lay_out_bands
from tpss.vehicle.train import Train
from tpss.vehicle.train_type import TrainType

UP, DOWN = 1.0, -1.0
LEGS = Leg.array([(-math.inf, UP, 0.0, 0, 1, 0, 1), (-math.inf, DOWN, 0.0, 0, 1, 0, 1)])
LEGS = LEGS.reshape(2, 1)
MOVING = Signalling(Separation.MOVING_BLOCK, Precedence.FREE, 5.0, 50.0, 0.0)
FIXED = Signalling(Separation.FIXED_BLOCK, Precedence.FREE, 5.0, 0.0, 1000.0)
NOWHERE = math.inf


def train_at(position_m: float, speed_m_s: float = 0.0, route: int = 0) -> Any:
    train = Train.blank(1)[0]
    train.motion.position_m, train.motion.speed_m_s, train.route = position_m, speed_m_s, route
    return train


def kind() -> Any:
    types = TrainType.blank(1)
    types["highest_retardation_m_s2"] = 0.5
    types["braking"] = lay_out_bands([0.0], [0.5])
    return types[0]


def occupied(*parts: tuple[int, float, float, float]) -> tuple[Any, Any]:
    """Entries (train, direction, low, high) of the only track, and the list of it."""
    entries = Occupancy.array((*part, False, False, False, k - 1) for k, part in enumerate(parts))
    first = np.full(tracks_of(LEGS), -1)
    first[1] = len(parts) - 1
    return entries, first


@pytest.mark.parametrize(
    ("signalling", "route", "position_m", "part", "end_m"),
    [
        (MOVING, 0, 1000.0, (1, UP, 2600.0, 3000.0), 2550.0),  # the rear, less the margin
        (MOVING, 1, -5000.0, (1, DOWN, 2600.0, 3000.0), -3050.0),  # going down, the rear is high
        (FIXED, 0, 1000.0, (1, UP, 2600.0, 3000.0), 2000.0),  # where the block of the rear begins
        (FIXED, 1, -5000.0, (1, DOWN, 2600.0, 3200.0), -4000.0),
        (MOVING, 0, 1000.0, (1, DOWN, 2600.0, 3000.0), math.inf),  # one that comes towards it
        (MOVING, 0, 5000.0, (1, UP, 2600.0, 3000.0), math.inf),  # one that is behind
        (MOVING, 0, 1000.0, (0, UP, 600.0, 1000.0), math.inf),  # itself
    ],
)
def test_authority_ends_before_the_next_train_ahead(
    as_run, signalling, route, position_m, part, end_m
):
    train = train_at(position_m, route=route)
    found, whom = as_run(end_of_authority)(
        0, 1e5, NOWHERE, False, train, LEGS, *occupied(part), signalling
    )
    assert (found, whom) == (end_m, -1 if end_m == math.inf else part[0])


def test_of_several_trains_ahead_the_nearest_counts(as_run):
    parts = [(1, UP, 9000.0, 9100.0), (2, UP, 4000.0, 4100.0), (3, UP, 6000.0, 6100.0)]
    found = as_run(end_of_authority)(
        0, 1e5, NOWHERE, False, train_at(0.0), LEGS, *occupied(*parts), MOVING
    )
    assert found == (3950.0, 2)


def test_trains_that_wait_aside_are_in_nobodys_way(as_run):
    """Train 1 waits on a track of its own, so that only train 2 counts."""
    entries, first = occupied((1, UP, 2600.0, 3000.0), (2, UP, 4600.0, 5000.0))
    entries[0].aside = True
    found = as_run(end_of_authority)(
        0, 1e5, NOWHERE, False, train_at(0.0), LEGS, entries, first, MOVING
    )
    assert found == (4550.0, 2)


def test_of_trains_at_one_place_the_one_that_departed_first_is_ahead(as_run):
    parts = [(0, UP, 0.0, 0.0), (1, UP, 0.0, 0.0)]
    ends = [
        as_run(end_of_authority)(
            i, 1e5, NOWHERE, False, train_at(0.0), LEGS, *occupied(*parts), MOVING
        )
        for i in (0, 1)
    ]
    assert ends == [(math.inf, -1), (-50.0, 0)]


def test_a_train_is_as_fast_as_lets_it_stop_after_its_reaction(as_run):
    """v t + v²/2b = d: at 20 m/s, 5 s and 0.5 m/s², d = 100 + 400 m."""
    train = train_at(0.0, 10.0)
    assert not as_run(give_authority)(500.0, NOWHERE, RESTART_M, 1.0, train, kind(), MOVING)
    assert train.motion.authority_m == 500.0
    assert train.motion.ceiling_m_s == pytest.approx(20.0)


def test_a_step_longer_than_the_reaction_takes_its_place(as_run):
    """With steps of 20 s: 20 m/s take 400 + 400 m."""
    train = train_at(0.0, 10.0)
    as_run(give_authority)(800.0, NOWHERE, RESTART_M, 20.0, train, kind(), MOVING)
    assert train.motion.ceiling_m_s == pytest.approx(20.0)


def test_a_train_that_stands_waits_until_it_has_room(as_run):
    train = train_at(100.0)
    as_run(give_authority)(110.0, NOWHERE, RESTART_M, 1.0, train, kind(), MOVING)
    assert train.motion.authority_m == 100.0
    as_run(give_authority)(125.0, NOWHERE, RESTART_M, 1.0, train, kind(), MOVING)
    assert train.motion.authority_m == 125.0


def test_to_its_stop_at_a_gate_a_train_starts_however_near_it_is(as_run):
    train = train_at(100.0)
    as_run(give_authority)(math.inf, 110.0, 0.0, 1.0, train, kind(), MOVING)
    assert train.motion.authority_m == 110.0


def test_a_train_that_is_too_near_brakes_as_hard_as_it_may(as_run):
    """From 20 m/s it needs 400 m, and has 300."""
    train = train_at(0.0, 20.0)
    assert as_run(give_authority)(300.0, NOWHERE, RESTART_M, 1.0, train, kind(), MOVING)
    assert train.motion.authority_m == pytest.approx(400.0)


def test_nobody_ahead_leaves_a_train_alone(as_run):
    train = train_at(0.0, 20.0)
    assert not as_run(give_authority)(math.inf, NOWHERE, RESTART_M, 1.0, train, kind(), MOVING)
    assert train.motion.authority_m == train.motion.ceiling_m_s == math.inf


def test_for_a_gate_a_train_brakes_as_for_a_stop_and_is_no_slower_before(as_run):
    train = train_at(0.0, 20.0)
    assert not as_run(give_authority)(math.inf, 500.0, RESTART_M, 1.0, train, kind(), MOVING)
    assert train.motion.authority_m == 500.0
    assert train.motion.ceiling_m_s == math.inf


def test_of_a_gate_and_a_train_ahead_the_nearer_counts(as_run):
    for end_m, gate_m in ((700.0, 900.0), (900.0, 700.0)):
        train = train_at(0.0, 20.0)
        as_run(give_authority)(end_m, gate_m, RESTART_M, 1.0, train, kind(), MOVING)
        assert train.motion.authority_m == 700.0


def test_trains_beyond_a_gate_that_a_train_may_not_pass_do_not_matter(as_run):
    """The rear of one is at 2600 m; for a train before a gate at 2500 m it is not in the way."""
    parts = occupied((1, UP, 2600.0, 3000.0))
    ends = [
        as_run(end_of_authority)(0, 1e5, gate_m, False, train_at(0.0), LEGS, *parts, MOVING)[0]
        for gate_m in (2500.0, 2700.0)
    ]
    assert ends == [math.inf, 2550.0]


def test_nor_does_one_whose_head_is_beyond_a_gate_where_a_train_has_a_track_of_its_own(as_run):
    parts = occupied((1, UP, 2300.0, 2700.0))
    ends = [
        as_run(end_of_authority)(0, 1e5, 2500.0, aside, train_at(0.0), LEGS, *parts, MOVING)[0]
        for aside in (False, True)
    ]
    assert ends == [2250.0, math.inf]
