"""Hand-worked locomotive used below: 79 t on driven axles, weight 79 000 · 9.81 = 774 990 N.

    dry, standing        774 990 · (0.161 + 7.5/44)        = 256 874 N
    dry, 60 km/h         774 990 · (0.161 + 7.5/(44 + 60)) = 180 662 N
    wet, standing        774 990 · 3.78/23.6               = 124 130 N
    wet, 60 km/h         774 990 · 3.78/(23.6 + 16.667)    =  72 752 N

The thesis prints v in km/h where the formula already converts from m/s.  Read so, at 60 km/h:

    dry, 60 "km/h"       774 990 · (0.161 + 7.5/(44 + 216)) = 147 129 N
"""

import pytest

from tpss.physics.adhesion import Rail, adhesion_limit

V_60 = 60 / 3.6


@pytest.mark.parametrize(
    ("speed", "rail", "limit_n"),
    [
        (0.0, Rail.DRY, 256_874),
        (V_60, Rail.DRY, 180_662),
        (0.0, Rail.WET, 124_130),
        (V_60, Rail.WET, 72_752),
    ],
)
def test_adhesion_carries_what_the_hand_calculation_says(as_run, speed, rail, limit_n):
    assert as_run(adhesion_limit)(79_000.0, speed, rail) == pytest.approx(limit_n, abs=1.0)


def test_kilometres_an_hour_as_printed_convert_twice_and_cost_a_fifth(as_run):
    assert as_run(adhesion_limit)(79_000.0, 60.0, Rail.DRY) == pytest.approx(147_129, abs=1.0)


def test_dry_law_is_that_of_curtius_and_kniffler_in_kilometres_an_hour(as_run):
    """µ = 7.5/(V + 44) + 0.161 at V = 100 km/h: 7.5/144 + 0.161 = 0.213083."""
    friction = as_run(adhesion_limit)(1000.0, 100 / 3.6, Rail.DRY) / 9810.0
    assert friction == pytest.approx(0.213083, abs=1e-6)


def test_wet_law_is_close_to_13_6_over_85_plus_v(as_run):
    """At V = 100 km/h: 13.6/185 = 0.07351; 3.78 and 23.6 are rounded from 3.778 and 23.61."""
    friction = as_run(adhesion_limit)(1000.0, 100 / 3.6, Rail.WET) / 9810.0
    assert friction == pytest.approx(13.6 / 185, rel=1e-3)


@pytest.mark.parametrize("rail", [Rail.DRY, Rail.WET])
def test_adhesion_falls_with_speed(as_run, rail):
    limits = [as_run(adhesion_limit)(79_000.0, float(speed), rail) for speed in range(0, 60, 5)]
    assert limits == sorted(limits, reverse=True)
