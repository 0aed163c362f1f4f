"""The square that takes the place of the speed's own where the retardation depends on the speed."""

import pytest

import tpss.scenario.machine
from tpss.vehicle.braking import MOST_BANDS, BrakingBands, braking_square, lay_out_bands


def bands(from_m_s, retardation_m_s2):
    return BrakingBands.array([lay_out_bands(from_m_s, retardation_m_s2)])[0]


@pytest.mark.parametrize(
    ("speed_m_s", "distance_m"),
    [(0.0, 0.0), (10.0, 50.0), (20.0, 200.0), (40.0, 1400.0), (50.0, 3200.0)],
)
def test_it_gives_the_braking_distance_by_hand(as_run, speed_m_s, distance_m):
    """1 m/s² up to 20 m/s, 0.5 up to 40, 0.25 above: v²/2, 200 + v² - 400, 1400 + 2 (v² - 1600)."""
    square = as_run(braking_square)(speed_m_s, 1.0, bands([0.0, 20.0, 40.0], [1.0, 0.5, 0.25]))
    assert square / (2.0 * 1.0) == pytest.approx(distance_m, rel=1e-14)


def test_with_one_band_it_is_the_square_of_the_speed(as_run):
    assert as_run(braking_square)(33.3, 0.7, bands([0.0], [0.7])) == 33.3 * 33.3


def test_a_scenario_may_have_as_many_bands_as_a_record_has_places():
    assert tpss.scenario.machine.MOST_BANDS == MOST_BANDS
