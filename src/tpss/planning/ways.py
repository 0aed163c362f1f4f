"""Ways to bound what is not simulated: a way is a file, and a row of the table here."""

from collections.abc import Callable
from dataclasses import dataclass

from tpss.planning.approximated import bounds_by_approximator, units_to_train
from tpss.planning.cases import AreaCases
from tpss.planning.learnt import Learnt
from tpss.planning.money import Array
from tpss.planning.plan import APPROXIMATOR, BOUNDS, Evaluation
from tpss.planning.prove import Grade
from tpss.planning.strongest import bounds_by_strongest, first_units
from tpss.planning.yearly_use import Simulated


@dataclass(frozen=True)
class Way:
    """A way to bound what configurations use of a traffic."""

    grade: Grade
    """What may be claimed."""
    first: Callable[[AreaCases, Evaluation], set[tuple[int, int]]]
    """States and configurations of an area that are simulated before there are bounds."""
    bound: Callable[[Simulated, Learnt], Array]
    """Least use, without fixed cost, shape (states, configurations, components); NaN where it is not
    known, which is simulated then."""
    audit_cases: int
    """Configurations with a traffic that are drawn to test the bounds, if the plan does not say."""


WAYS = {
    BOUNDS: Way(Grade.BOUNDED, first_units, bounds_by_strongest, audit_cases=0),
    APPROXIMATOR: Way(Grade.APPROXIMATED, units_to_train, bounds_by_approximator, audit_cases=60),
}
"""By the names that `evaluate.by` has for them."""
