"""Run the cases and compare: one outcome for each quantity in each run and variant."""

from dataclasses import dataclass
from functools import cache

import tpss

from cases import Case, Miss, Quantity
from measures import MEASURES


@dataclass(frozen=True)
class Outcome:
    """A published value beside ours."""

    case: Case
    quantity: Quantity
    run: str
    variant: str
    published: float
    ours: float
    miss: Miss | None

    @property
    def difference(self) -> float:
        """Ours less published, in percent or in the quantity's unit."""
        return self.quantity.difference(self.published, self.ours)

    @property
    def agrees(self) -> bool | None:
        """Whether ours agrees; None for what is only shown."""
        return self.quantity.agrees(self.published, self.ours)


@cache
def simulated(scenario: tpss.Scenario) -> tpss.Result:
    """Result of a scenario that must run to its end, computed once."""
    result = tpss.simulate(scenario)
    assert result.status == "finished", result.summary["problem"]
    assert result.audit["passed"], result.audit["failures"]
    return result


def result_of(case: Case, run: str, variant: str) -> tpss.Result:
    """Result of a run of a case."""
    return simulated(case.scenario(run, variant))


def compare(case: Case, quantity: Quantity, run: str, variant: str) -> Outcome:
    """Outcome of a quantity in a run and variant."""
    against = [] if quantity.against is None else [result_of(case, quantity.against, variant)]
    measure = MEASURES[quantity.measure]
    ours = measure(result_of(case, run, variant), *against, **quantity.arguments)
    published = quantity.published[run]
    miss = case.miss(quantity, run, variant)
    return Outcome(case, quantity, run, variant, published, ours, miss)


def compare_all(case: Case) -> list[Outcome]:
    """Outcomes of a case, in the order of its quantities."""
    return [compare(case, *check) for check in case.checks()]
