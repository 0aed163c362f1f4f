"""What is told of a line's gradients, beside calculations by hand.

Most are of 20 km: level over the first half, a rise of 6 ‰ over the second one.
"""

import math

import numpy as np
import pytest

from tpss.scenario.line import Gradient, Line, SpeedLimit, Station
from tpss.sweep.gradients import gradient_statistics


def line_of(*gradients, length_km=20.0):
    ends = (Station(name="West", position_km=0.0), Station(name="East", position_km=length_km))
    return Line(
        length_km=length_km,
        gradients=tuple(Gradient(from_km=at, permille=rise) for at, rise in gradients),
        speed_limits=(SpeedLimit(from_km=0.0, speed_kmh=80.0),),
        stations=ends,
    )


HALF_STEEP = line_of((0.0, 0.0), (10.0, 6.0))


def statistics(line=HALF_STEEP, begin_km=0.0, end_km=20.0, stations_km=(0.0, 20.0)):
    return gradient_statistics(line, begin_km, end_km, stations_km)


def test_the_starting_gradient_is_that_of_the_first_two_kilometres_of_the_way():
    """From km 9: one on the level, one at 6 ‰; from km 19 there is but one kilometre."""
    assert statistics().starting == 0.0
    assert statistics(begin_km=9.0).starting == pytest.approx(3.0)
    assert statistics(begin_km=19.0).starting == pytest.approx(6.0)


def test_the_trend_is_the_rise_of_the_line_through_the_gradients():
    """12 · 6 ‰ · ∫ (u - 1/2) du from 1/2 to 1 = 72 · 1/8 = 9 ‰; numpy fits the same."""
    assert statistics().trend == pytest.approx(9.0)
    u = (np.arange(2000) + 0.5) / 2000
    slope = np.polyfit(u, np.where(u > 0.5, 6.0, 0.0), 1)[0]
    assert statistics().trend == pytest.approx(slope, rel=1e-5)


def test_an_even_rise_has_no_trend_and_is_the_same_everywhere():
    found = statistics(line_of((0.0, 4.0)))
    assert found == pytest.approx((4.0, 0.0, 4.0, 4.0, 0.0, 0.0), abs=1e-12)


def test_the_middle_counts_by_its_way_to_the_stations():
    """8 ‰ over the second quarter: W(u) = 3u² - 2u³ is 5/32 at 1/4 and 1/2 at 1/2, so the weighted mean
    is 8 · 11/32 = 2.75 ‰, and the plain one 2 ‰.
    """
    line = line_of((0.0, 0.0), (5.0, 8.0), (10.0, 0.0))
    assert statistics(line).middle == pytest.approx(0.75)
    assert statistics().middle == pytest.approx(0.0)


def test_of_several_sections_each_counts_by_its_length():
    """Stations at 0, 8 and 16 km, 8 ‰ over the second quarter of each section and from 16 km on:
    2.75 ‰ between stations, and 8 · (2 + 2 + 4) / 20 = 3.2 ‰ over the line.
    """
    steps = ((0.0, 0.0), (2.0, 8.0), (4.0, 0.0), (10.0, 8.0), (12.0, 0.0), (16.0, 8.0))
    found = statistics(line_of(*steps), stations_km=(0.0, 8.0, 16.0))
    assert found.middle == pytest.approx(2.75 - 3.2)


def test_one_station_has_no_middle():
    assert math.isnan(statistics(stations_km=(5.0,)).middle)
