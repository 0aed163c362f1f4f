"""Annuities, discounting and the stages of a plan."""

import numpy as np
import pytest

from tpss.errors import PlanError
from tpss.planning.measures import Measure, make_transitions
from tpss.planning.money import (
    Stages,
    charged_share,
    discount_factor,
    ordered_at,
    present_factor,
    recovery_factor,
)


def test_an_annuity_pays_a_price_over_its_lifetime():
    """2 million at 10 % over 25 years: 2 · 0.1 / (1 - 1.1^-25) = 0.2203 million a year."""
    assert 2.0 * recovery_factor(0.10, 25) == pytest.approx(0.2203, abs=5e-5)


def test_the_capital_recovery_factor_of_7_percent_over_20_years():
    """0.07 · 1.07^20 / (1.07^20 - 1) = 0.0943929 (Switch's manual)."""
    assert recovery_factor(0.07, 20) == pytest.approx(0.0943929, abs=5e-8)


def test_the_present_worth_of_10_a_year():
    """10 a year for 20 years at 5 %: 10 · (1 - 1.05^-20) / 0.05 = 124.622."""
    assert 10.0 * present_factor(0.05, 20) == pytest.approx(124.622, abs=5e-4)


def test_without_interest_a_year_is_a_year():
    assert present_factor(0.0, 12.5) == 12.5
    assert present_factor(1e-12, 12.5) == pytest.approx(12.5, rel=1e-10)


@pytest.mark.parametrize("rate", [0.0, 0.035, 0.1])
@pytest.mark.parametrize(("lifetime", "remaining"), [(40, 55), (40, 40), (40, 15), (7, 55)])
def test_a_price_is_charged_by_annuities_within_the_horizon(rate, lifetime, remaining):
    """The annuity, paid at the end of each remaining year, whatever was renewed in between."""
    annuity = recovery_factor(rate, lifetime)
    paid = sum(annuity * discount_factor(rate, year + 1) for year in range(remaining))
    assert charged_share(rate, lifetime, remaining) == pytest.approx(paid, rel=1e-12)


@pytest.mark.parametrize("rate", [0.0, 0.035])
def test_that_is_the_price_and_a_part_of_the_first_renewal(rate):
    """After 40 of 55 years it is renewed, and 15 years of the renewal are charged."""
    renewal = discount_factor(rate, 40) * present_factor(rate, 15) / present_factor(rate, 40)
    assert charged_share(rate, 40, 55) == pytest.approx(1.0 + renewal, rel=1e-12)


def test_a_year_of_service_costs_the_same_whenever_it_is():
    """There is no end effect: built late or at once differs by the years between."""
    stages = Stages((0, 20), 60, 0.05)
    early, late = stages.share(0, 40), stages.share(1, 40) * stages.discount[1]
    assert late == pytest.approx(discount_factor(0.05, 20), rel=1e-12)
    assert early - late == pytest.approx(
        recovery_factor(0.05, 40) * present_factor(0.05, 20), rel=1e-12
    )


def test_what_is_not_paid_off_over_a_lifetime_is_charged_whole():
    assert charged_share(0.05, None, 3) == 1.0


def test_stages_of_a_plan():
    """5, 10 and 40 years from 2030 on."""
    stages = Stages((2030, 2035, 2045), 2085, 0.035)
    assert stages.length_a.tolist() == [5, 10, 40]
    assert stages.remaining_a.tolist() == [55, 50, 40]
    assert stages.discount == pytest.approx([1.0, 1.035**-5, 1.035**-15])
    assert stages.annuity[0] == pytest.approx(sum(1.035**-k for k in range(1, 6)))
    assert [stages.stage_of(year) for year in (2029, 2030, 2044, 2045, 2084, 2085)] == [
        None, 0, 1, 2, 2, None,
    ]  # fmt: skip


def test_a_stage_in_two_halves_costs_the_same():
    """1 a year for 20 years, at once or as 7 and 13 years."""
    whole, halves = Stages((2030,), 2050, 0.04), Stages((2030, 2037), 2050, 0.04)
    assert halves.discount @ halves.annuity == pytest.approx(whole.annuity[0], rel=1e-14)


def test_a_renewal_within_a_stage_is_discounted_to_its_start():
    """Due in 2040 in the stage from 2035, whole: 1.04^-5."""
    assert Stages((2030, 2035), 2050, 0.04).share_in(2040, None) == pytest.approx(1.04**-5)


@pytest.mark.parametrize(
    ("lead_time", "orders"),
    [
        (0, (0, 1, 2)),  # at once
        (5, (-1, 0, 1)),  # a stage ahead
        (7, (-1, -1, 1)),  # 2035 is too near
        (15, (-1, -1, 0)),
        (16, (-1, -1, -1)),  # never
    ],
)
def test_an_order_is_placed_at_the_last_start_that_is_early_enough(lead_time, orders):
    assert ordered_at(Stages((2030, 2035, 2045), 2085, 0.035), lead_time) == orders


def test_a_longer_horizon_charges_a_plan_that_builds_nothing_nothing():
    for end in (2040, 2100):
        stages = Stages((2030,), end, 0.03)
        built = make_transitions(stages, np.array([[0], [1]]), [Measure("B", (0.0, 100.0), 40.0)])
        assert built.cost[0, 0, 0] == 0.0


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: Stages((), 2050, 0.0), "stages start"),
        (lambda: Stages((2030, 2030), 2050, 0.0), "stages start"),
        (lambda: Stages((2030,), 2030, 0.0), "stages start"),
        (lambda: Stages((2030,), 2050, -0.01), "discount rate"),
        (lambda: Stages((2030,), 2050, np.nan), "discount rate"),
        (lambda: charged_share(0.03, 0.0, 10), "lifetime"),
        (lambda: ordered_at(Stages((2030,), 2050, 0.0), -1.0), "lead time"),
    ],
)
def test_what_makes_no_sense_is_refused(call, words):
    with pytest.raises(PlanError, match=words):
        call()
