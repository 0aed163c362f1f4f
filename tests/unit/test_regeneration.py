"""Electric brakes: the part of a braking force that they give, and the share that the line takes."""

import numpy as np
import pytest

from tpss.kernel import plain
from tpss.vehicle.regeneration import ROUNDED_V, Regeneration, electric_force, taken_share

FIELDS = {
    "highest_force_n": 120e3, "highest_power_w": 2e6, "none_up_to_m_s": 5.0 / 3.6,
    "whole_from_m_s": 10.0 / 3.6, "whole_up_to_v": 17_250.0, "none_from_v": 18_000.0,
}  # fmt: skip
OWN = Regeneration.array([Regeneration.row(**FIELDS)])[0]


def force(braking_n: float, speed_m_s: float, rails_n: float = 1e9) -> float:
    return plain(electric_force)(braking_n, speed_m_s, rails_n, OWN)


@pytest.mark.parametrize(
    ("braking_kn", "speed_kmh", "rails_kn", "kn"),
    [
        (80.0, 36.0, 1e6, 80.0),  # all of it
        (200.0, 36.0, 1e6, 120.0),  # F_max
        (200.0, 72.0, 1e6, 100.0),  # 2 MW at 20 m/s
        (200.0, 36.0, 90.0, 90.0),  # the rails
        (80.0, 7.5, 1e6, 40.0),  # half way between 5 and 10 km/h
        (80.0, 5.0, 1e6, 0.0),
        (80.0, 0.0, 1e6, 0.0),
    ],
)
def test_the_least_of_the_limits_holds_and_fades_at_low_speed(braking_kn, speed_kmh, rails_kn, kn):
    given = force(1e3 * braking_kn, speed_kmh / 3.6, 1e3 * rails_kn)
    assert given == pytest.approx(1e3 * kn)


def test_the_line_takes_all_up_to_one_voltage_and_nothing_from_another():
    """In the middle, 17,625 V, half of it; straight between the rounded ends, by 1 over 700 V."""
    assert plain(taken_share)(15_000.0, OWN) == (1.0, 0.0)
    assert plain(taken_share)(17_250.0, OWN) == (1.0, 0.0)
    assert plain(taken_share)(18_000.0, OWN) == (0.0, 0.0)
    assert plain(taken_share)(19_000.0, OWN) == (0.0, 0.0)
    share, slope = plain(taken_share)(17_625.0, OWN)
    assert share == pytest.approx(0.5)
    assert slope == pytest.approx(-1.0 / (750.0 - ROUNDED_V))


def test_share_and_slope_have_no_jumps_and_belong_together():
    """The slope is that of the share by central differences, and changes little from place to place."""
    volts = np.linspace(17_200.0, 18_050.0, 3401)
    share, slope = np.array([plain(taken_share)(v, OWN) for v in volts]).T
    assert (np.diff(share) <= 0.0).all()
    measured = (share[2:] - share[:-2]) / (volts[2:] - volts[:-2])
    np.testing.assert_allclose(slope[1:-1], measured, atol=1e-5)
    assert np.abs(np.diff(slope)).max() < 1e-5
