"""Money and time: annuities, discounting, and the stages of a plan.

All costs are real, in the plan's currency and of its price year.  Costs of a year fall due at its end,
investments at the start of the year in which they come into service.  Probabilities are kept apart
from discounting: `Stages` knows none.  Nothing else in the planner knows of interest.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from tpss.errors import PlanError

Array = npt.NDArray[np.float64]


def present_factor(rate: float, years_a: float) -> float:
    r"""What 1 at the end of each of some years is worth at their start. [a]

    .. math:: A(n) = \sum_{k=1}^n (1 + r)^{-k} = \frac{1 - (1 + r)^{-n}}{r}

    Parameters
    ----------
    rate : float
        Discount rate r a year; 0.035 is 3.5 %.
    years_a : float
        Years n.
    """
    return years_a if rate == 0.0 else -math.expm1(-years_a * math.log1p(rate)) / rate


def recovery_factor(rate: float, years_a: float) -> float:
    """Annuity of a price of 1, at the end of each of some years: the capital recovery factor. [1/a]"""
    return 1.0 / present_factor(rate, years_a)


def discount_factor(rate: float, years_a: float) -> float:
    """What 1 is worth some years earlier."""
    return math.exp(-years_a * math.log1p(rate))


def charged_share(rate: float, lifetime_a: float | None, remaining_a: float) -> float:
    r"""Share of a price whose annuities fall within the horizon.

    What is built is renewed like for like after its lifetime L, so it costs its annuity in every
    year from then to the horizon, H years later:

    .. math:: \rho = A(H) / A(L)

    For a longer lifetime this is the price less what is left of it at the horizon; for a shorter one
    it includes the renewals.  Years of service therefore cost the same whenever they are, and nothing
    is gained by building early or late in view of the horizon.

    Parameters
    ----------
    rate : float
        Discount rate a year.
    lifetime_a : float or None
        Lifetime [a]; without one the whole price is charged.
    remaining_a : float
        Years from service to the horizon. [a]

    Raises
    ------
    PlanError
        The lifetime is not positive.
    """
    if lifetime_a is None:
        return 1.0
    if not lifetime_a > 0.0:
        raise PlanError(f"a lifetime is positive, not {lifetime_a:g} years")
    return present_factor(rate, remaining_a) / present_factor(rate, lifetime_a)


@dataclass(frozen=True)
class Stages:
    """Stages of a plan, at whose starts decisions are taken.

    Raises
    ------
    PlanError
        There is no stage, one does not start before the next or the end, or the rate is negative.
    """

    start_year: tuple[float, ...]
    """First year of each stage."""
    end_year: float
    """Year until which costs are counted: the horizon, which itself is not counted."""
    rate: float
    """Discount rate a year, real."""

    def __post_init__(self) -> None:
        years = [*self.start_year, self.end_year]
        if not self.start_year or any(late <= early for early, late in itertools.pairwise(years)):
            raise PlanError(f"stages start one after the other and before the end, not {years}")
        if not 0.0 <= self.rate < math.inf:
            raise PlanError(f"a discount rate is 0 or more, not {self.rate:g}")

    def __len__(self) -> int:
        return len(self.start_year)

    @cached_property
    def length_a(self) -> Array:
        """Length of each stage, shape (stages,). [a]"""
        return np.diff([*self.start_year, self.end_year])

    @cached_property
    def remaining_a(self) -> Array:
        """Years from the start of each stage to the end, shape (stages,). [a]"""
        return self.end_year - np.asarray(self.start_year, dtype=np.float64)

    @cached_property
    def discount(self) -> Array:
        """What 1 at the start of each stage is worth at the start of the first, shape (stages,)."""
        first = self.start_year[0]
        return np.array([discount_factor(self.rate, year - first) for year in self.start_year])

    @cached_property
    def annuity(self) -> Array:
        """What 1 a year during each stage is worth at its start, shape (stages,). [a]"""
        return np.array([present_factor(self.rate, length) for length in self.length_a])

    def stage_of(self, year: float) -> int | None:
        """Stage that contains a year, if any does."""
        if not self.start_year[0] <= year < self.end_year:
            return None
        return int(np.searchsorted(self.start_year, year, side="right")) - 1

    def share(self, stage: int, lifetime_a: float | None) -> float:
        """Share of a price that is charged for what comes into service at the start of a stage."""
        return charged_share(self.rate, lifetime_a, float(self.remaining_a[stage]))

    def share_in(self, year: float, lifetime_a: float | None) -> float:
        """Share of a price that falls due in a year, as worth at the start of that year's stage."""
        start = max(each for each in self.start_year if each <= year)
        share = charged_share(self.rate, lifetime_a, self.end_year - year)
        return share * discount_factor(self.rate, year - start)


def ordered_at(stages: Stages, lead_time_a: float) -> tuple[int, ...]:
    """Stage at whose start an order is placed for what comes into service at the start of each stage.

    It is the last one that is at least the lead time earlier, and -1 if there is none: then nothing
    can have been ordered, and what is in service is what is there today.

    Parameters
    ----------
    stages : Stages
    lead_time_a : float
        Years from order to service. [a]

    Raises
    ------
    PlanError
        The lead time is negative.
    """
    if not lead_time_a >= 0.0:
        raise PlanError(f"a lead time is 0 or more, not {lead_time_a:g} years")
    return _last_starts(stages.start_year, [year - lead_time_a for year in stages.start_year])


def _last_starts(starts: Sequence[float], years: Sequence[float]) -> tuple[int, ...]:
    return tuple(int(np.searchsorted(starts, year, side="right")) - 1 for year in years)
