"""Faults between the parts of a plan file, each named with its remedy."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from tpss.errors import Finding, no_such
from tpss.planning.money import Stages, ordered_at
from tpss.planning.plan import PlanFile, PlannedMeasure, PlannedRenewal
from tpss.planning.price_fields import Price
from tpss.scenario.scenario import Scenario

SUM_TOLERANCE = 1e-9
"""Probabilities that add up to 1 within this do. [1]"""

PRICES = "economics"
"""First key of the values of a future that are prices."""


def plan_faults(file: PlanFile, source: str) -> list[Finding]:
    """Faults of a plan file that need no scenario to be seen."""
    each = (_of_probabilities, _of_values, _of_years, _of_dates, _of_names, _of_leads, _of_budget)
    return [
        Finding(source, key, value, problem, remedy)
        for faults in each
        for key, value, problem, remedy in faults(file)
    ]


_Fault = tuple[str, str, str, str]
"""Key, value, problem and remedy."""


def _of_probabilities(file: PlanFile) -> Iterator[_Fault]:
    if not file.scenarios:
        return
    total = math.fsum(future.probability for future in file.scenarios.values())
    if abs(total - 1.0) > SUM_TOLERANCE:
        values = ", ".join(f"{each.probability:g}" for each in file.scenarios.values())
        remedy = f"change them by {1.0 - total:+.6g} in all, or add the scenario that is missing"
        yield "scenarios", values, f"the probabilities add up to {total:.9g}, not to 1", remedy


def _of_values(file: PlanFile) -> Iterator[_Fault]:
    """Values of futures: one for each stage, at places of an area."""
    count = len(file.stages.start)
    for name, future in file.scenarios.items():
        for path, value in future.values.items():
            key = f"scenarios.{name}.{path}"
            if isinstance(value, list | tuple) and len(value) != count:
                missing = ", ".join(map(str, file.stages.start[len(value) :]))
                problem = f"{len(value)} values for {count} stages"
                remedy = f"add one for {missing}" if missing else f"leave {count}, one a stage"
                yield key, repr(value), problem, remedy
            if path.split(".")[0] == PRICES:
                yield from _of_priced_value(file, key, path, value)
            elif file.areas and path.split(".")[0] not in file.areas:
                problem = "it does not say of which area it is"
                yield key, "", problem, f"put one of {', '.join(file.areas)} before it"


def _of_priced_value(file: PlanFile, key: str, path: str, value: Any) -> Iterator[_Fault]:
    """A price that a future changes is one that the plan has, and stays a number."""
    known = prices_of(file)
    place = path.removeprefix(f"{PRICES}.")
    if place not in known:
        problem, remedy = no_such("price", place, list(known))
        yield key, "", problem, remedy
    for each in value if isinstance(value, list | tuple) else [value]:
        is_number = isinstance(each, int | float) and not isinstance(each, bool)
        if not is_number or not math.isfinite(each) or each < 0.0:
            problem = "not a price of 0 or more"
            yield key, repr(each), problem, "write numbers in the plan's currency"


def prices_of(file: PlanFile) -> dict[str, Price]:
    """All prices of operation by key path below ``economics``, such as ``late_minute.freight``."""
    found: dict[str, Price] = {}
    for name in type(file.economics).model_fields:
        value = getattr(file.economics, name)
        if isinstance(value, Price):
            found[name] = value
        elif isinstance(value, Mapping):
            found |= {f"{name}.{of}": price for of, price in value.items()}
    return found


def _of_years(file: PlanFile) -> Iterator[_Fault]:
    """Prices of another year than the plan's."""
    given = {f"{PRICES}.{key}": each.price_year for key, each in prices_of(file).items()}
    given |= {f"measures.{name}": each.price_year for name, each in file.measures.items()}
    given |= {f"renewals.{name}": each.price_year for name, each in file.renewals.items()}
    year = file.economics.price_year
    for key, of in given.items():
        if of is not None and of != year:
            problem = f"a price of another year than the plan's, {year}"
            remedy = (
                f"convert it to prices of {year}, and write price_year = {year} or leave it out"
            )
            yield f"{key}.price_year", str(of), problem, remedy


def _of_dates(file: PlanFile) -> Iterator[_Fault]:
    start, end = file.stages.start, file.stages.end
    for name, measure in file.measures.items():
        first, last = measure.earliest or start[0], measure.latest or start[-1]
        if not any(first <= year <= last for year in start):
            problem = f"no stage begins from {first} to {last}"
            remedy = f"stages begin in {', '.join(map(str, start))}; change earliest or latest"
            yield f"measures.{name}", "", problem, remedy
    for name, renewal in file.renewals.items():
        if not start[0] <= renewal.year < end:
            problem = f"not within the years that count, from {start[0]} until {end}"
            yield f"renewals.{name}.year", str(renewal.year), problem, "change it, or leave it out"


def area_of(name: str, file: PlanFile) -> str:
    """Area of a measure or renewal by its name; empty where there is one only."""
    area, _, _ = name.partition(".")
    return area if area in file.areas else ""


def measures_of(area: str, file: PlanFile) -> dict[str, PlannedMeasure]:
    """Measures of an area by the names that they have within it."""
    return {
        name.removeprefix(f"{area}."): measure
        for name, measure in file.measures.items()
        if area_of(name, file) == area
    }


def renewals_of(area: str, file: PlanFile) -> dict[str, PlannedRenewal]:
    """Renewals of an area by the names that they have within it."""
    return {
        name.removeprefix(f"{area}."): renewal
        for name, renewal in file.renewals.items()
        if area_of(name, file) == area
    }


def _of_names(file: PlanFile) -> Iterator[_Fault]:
    """Names of measures and areas that there are not."""
    for kind, given in (("measures", file.measures), ("renewals", file.renewals)):
        for name in given if file.areas else ():
            if not area_of(name, file):
                problem = "it does not say of which area it is"
                remedy = f"write [{kind}.AREA.{name}] with one of {', '.join(file.areas)}"
                yield f"{kind}.{name}", "", problem, remedy
    for name, measure in file.measures.items():
        known = list(measures_of(area_of(name, file), file))
        for key in ("excludes", "needs"):
            yield from _unknown(f"measures.{name}.{key}", getattr(measure, key), known)
        own = name.removeprefix(f"{area_of(name, file)}.")
        for key in ("excludes", "needs"):
            if own in getattr(measure, key):
                yield f"measures.{name}.{key}", repr(own), "it names itself", "leave it out"
        for other in set(measure.excludes) & set(measure.needs):
            problem = "it excludes what it needs"
            yield f"measures.{name}.excludes", repr(other), problem, "leave it out of one of both"
    for name, renewal in file.renewals.items():
        known = list(measures_of(area_of(name, file), file))
        yield from _unknown(f"renewals.{name}.unless", renewal.unless, known)


def _unknown(key: str, names: Sequence[str], known: Sequence[str]) -> Iterator[_Fault]:
    for name in names:
        if name not in known:
            problem, remedy = no_such("measure", name, known)
            yield key, repr(name), problem, remedy


def _of_leads(file: PlanFile) -> Iterator[_Fault]:
    """Lead times: measures of an area are ordered the same number of stages ahead."""
    economics, start = file.economics, tuple(float(year) for year in file.stages.start)
    stages = Stages(start, float(file.stages.end), economics.discount_rate)
    for area in file.areas or ("",):
        orders: dict[tuple[int, ...], list[str]] = {}
        for name, measure in measures_of(area, file).items():
            orders.setdefault(ordered_at(stages, measure.lead_time_years), []).append(name)
        before = f"measures.{area}" if area else "measures"
        if len(orders) > 1:
            groups = " and ".join(", ".join(names) for names in orders.values())
            problem = f"lead times that lie in different stages: of {groups}"
            remedy = (
                "let them be ordered the same number of stages ahead: lengthen the shorter ones"
            )
            yield f"{before}.*.lead_time_years", "", problem, remedy
        for order, names in orders.items():
            if max(order) < 0:
                problem = "nothing is in service before the last stage has begun"
                remedy = "shorten the lead time, or let a later stage begin"
                shown = f"{file.measures[_full(area, names[0])].lead_time_years:g}"
                yield f"{before}.{names[0]}.lead_time_years", shown, problem, remedy


def _full(area: str, name: str) -> str:
    return f"{area}.{name}" if area else name


def _of_budget(file: PlanFile) -> Iterator[_Fault]:
    if file.budget is None:
        return
    given, count = file.budget.per_stage, len(file.stages.start)
    if len(given) != count:
        problem, remedy = f"{len(given)} values for {count} stages", "give one for each stage"
        yield "budget.per_stage", repr(list(given)), problem, remedy


def price_faults(file: PlanFile, scenario: Scenario, source: str) -> list[Finding]:
    """Prices that a plan lacks for the trains of a scenario.

    Every type of train that runs has a value of a train not run, and one of a minute: late where its
    arrivals are scheduled, lost where they are not.
    """
    economics = file.economics
    wanted: dict[tuple[str, str], str] = {}
    for entry in scenario.traffic:
        minute = "lost_minute" if entry.arrive_after_min is None else "late_minute"
        for key in ("train_not_run", minute):
            wanted.setdefault((key, entry.train), entry.name)
    return [
        Finding(
            source,
            f"{PRICES}.{key}.{train}",
            "",
            f"the price is missing; {service} runs with this type of train",
            "add it, with its source; 0 only if it is worth nothing",
        )
        for (key, train), service in wanted.items()
        if train not in getattr(economics, key)
    ]
