"""Thermal states against closed forms, and a transformer against its differential equations.

Hand-worked transformer used below, ONAF at 20 °C, steady at K = 0.6:

    top oil   ((1 + 6 · 0.36) / 7)^0.8 · 52 = 27.52 K;   hot spot  0.6^1.3 · 26 = 13.38 K;   60.9 °C
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tpss.physics.thermal import (
    COOLING,
    ageing_rate,
    follow,
    hot_spot_rise,
    state_after,
    time_to_rated_s,
)

MIN = 60.0


def states(load, lasts_s, tau_s, start):
    """States of a single body under a list of loads."""
    square = np.array(load, dtype=float)[:, None] ** 2
    return follow(square, np.array(lasts_s, dtype=float), tau_s, np.array([start]))[:, 0]


def test_a_body_comes_by_an_exponential_to_the_square_of_its_load():
    """θ(t) = K² + (θ₀ - K²) e^(-t/τ): from 0.2 at K = 1.5 with 30 min, after 30 min
    2.25 - 2.05 / e = 1.4958.
    """
    found = states([1.5] * 30, [MIN] * 30, 30 * MIN, 0.2)
    times = np.arange(31) / 30.0
    np.testing.assert_allclose(found, 2.25 + (0.2 - 2.25) * np.exp(-times), rtol=1e-12)
    assert found[-1] == pytest.approx(1.4958, abs=5e-5)


def test_a_load_for_ever_ends_at_its_square():
    assert states([0.8] * 2000, [MIN] * 2000, 30 * MIN, 0.0)[-1] == pytest.approx(0.64, rel=1e-12)


@pytest.mark.parametrize("tau_s", [0.5, 30.0, 280.0, 1800.0, 1e6])
def test_states_are_those_of_one_step_after_the_other(tau_s):
    """The slow twin: one step after the other, of lengths from a tenth of a second to ten minutes."""
    random = np.random.default_rng(1)
    load, lasts = random.uniform(0.0, 2.0, 900), 10.0 ** random.uniform(-1.0, 2.8, 900)
    expected = [0.7]
    for k, h in zip(load, lasts, strict=True):
        expected.append(k * k + (expected[-1] - k * k) * math.exp(-h / tau_s))
    np.testing.assert_allclose(states(load, lasts, tau_s, 0.7), expected, rtol=1e-11)


def test_steps_of_a_second_and_of_a_minute_give_the_same():
    load = np.random.default_rng(2).uniform(0.0, 2.0, 120)
    coarse = states(load, [MIN] * 120, 282.0, 0.3)
    fine = states(np.repeat(load, 60), [1.0] * 7200, 282.0, 0.3)
    np.testing.assert_allclose(fine[::60], coarse, rtol=1e-11)


def test_no_step_leaves_the_state_where_it_begins():
    assert states([], [], 60.0, 0.4).tolist() == [0.4]


def test_bodies_side_by_side_do_not_know_each_other():
    load = np.random.default_rng(3).uniform(0.0, 2.0, (50, 2))
    both = follow(load, np.full(50, 10.0), 100.0, np.array([0.1, 2.0]))
    for i, start in enumerate((0.1, 2.0)):
        alone = follow(load[:, i : i + 1], np.full(50, 10.0), 100.0, np.array([start]))
        np.testing.assert_array_equal(both[:, i], alone[:, 0])


def test_the_short_time_current_of_a_motor_gives_its_time_constant():
    """2080 A for 6 min, 1250 A for ever: K² = 2.7689, τ = -6 / ln(1 - 1/2.7689) = 13.390 min.  With it
    a cold motor is at 100 % just then, and one that was at 100 % is at 163.9 %.
    """
    tau_s = time_to_rated_s(2080.0 / 1250.0, 6 * MIN)
    assert tau_s / MIN == pytest.approx(13.390, abs=5e-4)
    assert states([1.664] * 6, [MIN] * 6, tau_s, 0.0)[-1] == pytest.approx(1.0, rel=1e-12)
    warm = states([1.664] * 6, [MIN] * 6, tau_s, 1.0)[-1]
    assert warm == pytest.approx(state_after(1.664, 6 * MIN, tau_s), rel=1e-12)
    assert warm == pytest.approx(1.6388, abs=5e-4)


def test_a_large_transformer_overloaded_by_half():
    """K from 0.6 to 1.5 at 20 °C, ONAF: 61 °C at first, 97, 127 and 141 after 10, 30, 60 min."""
    load = np.full((60, 1), 1.5)
    rise = hot_spot_rise(load, np.full(60, MIN), np.array([0.6]), COOLING["ONAF"])[:, 0]
    np.testing.assert_allclose(20.0 + rise[[0, 10, 30, 60]], [61.0, 97.0, 127.0, 141.0], atol=0.6)


@pytest.mark.parametrize("cooling", COOLING)
def test_a_hot_spot_is_that_of_the_differential_equations(cooling):
    """Three equations of first order, integrated by another method, through three loads."""
    own = COOLING[cooling]
    loads, start = [1.5, 0.3, 1.1], 0.6

    def aims(k):
        oil = ((1.0 + own.loss_ratio * k * k) / (1.0 + own.loss_ratio)) ** own.oil_exponent
        winding = k**own.winding_exponent * own.hot_spot_rise_k
        return np.array([oil * own.oil_rise_k, own.k21 * winding, (own.k21 - 1.0) * winding])

    tau_s = np.array([own.k11 * own.oil_s, own.k22 * own.winding_s, own.oil_s / own.k22])
    state, expected = aims(start), []
    for k in loads:
        solved = solve_ivp(
            lambda _, y, k=k: (aims(k) - y) / tau_s,
            (0.0, 40 * MIN), state, rtol=1e-10, atol=1e-9, t_eval=np.arange(1, 41) * MIN,
        )  # fmt: skip
        expected += (solved.y[0] + solved.y[1] - solved.y[2]).tolist()
        state = solved.y[:, -1]
    load = np.repeat(loads, 40)[:, None]
    rise = hot_spot_rise(load, np.full(120, MIN), np.array([start]), own)
    np.testing.assert_allclose(rise[1:, 0], expected, rtol=1e-7)


@pytest.mark.parametrize("cooling", COOLING)
def test_the_rated_load_for_ever_gives_the_rated_rise(cooling):
    """52 + 26 K and 55 + 23 K: 98 °C at 20 °C, where paper ages at its normal rate."""
    own = COOLING[cooling]
    rise = hot_spot_rise(np.ones((10, 1)), np.full(10, 3600.0), np.ones(1), own)
    np.testing.assert_allclose(rise, 78.0, rtol=1e-12)
    assert own.rise_k == 78.0


def test_the_hot_spot_overshoots_only_with_fans():
    """k21 = 2: while the oil does not yet flow the winding is hotter than it will be in the end."""
    load = np.ones((600, 1))
    alone = {
        name: COOLING[name]._replace(oil_rise_k=0.0) for name in COOLING
    }  # without the oil's own rise
    fans = hot_spot_rise(load, np.full(600, MIN), np.zeros(1), alone["ONAF"])
    none = hot_spot_rise(load, np.full(600, MIN), np.zeros(1), alone["ONAN"])
    assert fans.max() > 1.3 * fans[-1]
    assert none.max() == pytest.approx(none[-1], rel=1e-12)


def test_ageing_doubles_every_six_kelvin():
    np.testing.assert_allclose(ageing_rate(np.array([92.0, 98.0, 104.0, 140.0])), [0.5, 1, 2, 128])


def test_paper_beyond_all_temperatures_ages_at_once():
    """2^1024 is beyond all numbers: from 98 °C + 1024 · 6 K = 6242 °C on, without a warning."""
    assert ageing_rate(np.array([6241.9, 6242.0, 9000.0])).tolist() == [
        pytest.approx(2.0**1023 * 2.0 ** (1.0 - 0.1 / 6.0), rel=1e-9),
        math.inf,
        math.inf,
    ]
