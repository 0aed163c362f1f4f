"""Legs of a route, and places on them.

The route below runs down a line from its km 30 to km 10, along another one from km 50, and turns round
at its km 65: positions -30 to -10 km, on to 5 km, and further.
"""

import math

import numpy as np
import pytest

from tpss.track.leg import Leg, along_one_line, leg_at, leg_of, place_on_line

LEGS = Leg.array(
    [
        (-math.inf, -1.0, 0.0, 0, 1, 0, 2),
        (-10e3, 1.0, 60e3, 1, 2, 2, 5),
        (5e3, -1.0, 70e3, 1, 1, 2, 5),
        (math.inf, 0.0, 0.0, 0, 0, 0, 0),  # what is left of the row
    ]
).reshape(1, -1)


@pytest.mark.parametrize(
    ("position_m", "leg", "place_m"),
    [
        (-30e3, 0, 30e3),
        (np.nextafter(-10e3, -np.inf), 0, 10e3),
        (-10e3, 1, 50e3),  # where one leg ends the next one has begun
        (0.0, 1, 60e3),
        (5e3, 2, 65e3),  # the same place, in the other direction
        (15e3, 2, 55e3),
        (1e9, 2, 70e3 - 1e9),
    ],
)
@pytest.mark.parametrize("near", [0, "known"])
def test_a_position_is_on_one_leg_and_at_one_place(as_run, position_m, leg, place_m, near):
    start = leg if near == "known" else 0
    assert as_run(leg_at)(position_m, start, 0, LEGS) == leg
    assert as_run(place_on_line)(position_m, LEGS[0, leg]) == pytest.approx(place_m, rel=1e-15)
    assert leg_of(position_m, 0, LEGS) == LEGS[0, leg]


def test_along_one_line_places_are_positions_to_the_last_bit(as_run):
    legs = along_one_line(3)
    for position_m in (0.0, 1e-300, 12_345.678, -98_765.4321):
        assert as_run(leg_at)(position_m, 0, 0, legs) == 0
        assert as_run(place_on_line)(position_m, legs[0, 0]) == position_m
