"""What a plan does not count, in words, for whoever reads its figures."""

from collections.abc import Iterator, Sequence

from tpss.planning.lazily import ALL
from tpss.planning.solve import Model
from tpss.planning.yearly_use import POWERS, gives_back
from tpss.scenario.supply import ConverterType

GENERAL = (
    "Traffic is as asked for in each future: none is added because the supply is better.",
    "Costs are those of building, of energy, of minutes and of trains not run; maintenance only where "
    "fixed_per_year is given, and nothing outside the hours in which the traffic runs.",
    "Each year of a stage is like its first, and the steady state of its timetable: no disturbances, "
    "and no outage but those required, which cost nothing while their requirements hold.",
)
"""What no plan counts."""


def uncounted(model: Model) -> Iterator[str]:
    """What a plan does not count: of any plan, and of this one."""
    yield from GENERAL
    yield from _converter_losses(_converters(model))
    if not gives_back(model.table.astype(POWERS)).any():
        yield "No energy is given back to the grid."
    if model.plan.file.budget is None:
        yield "There is no budget."


def estimated(model: Model) -> Iterator[str]:
    """What a plan counts by figures that are estimates."""
    types = _converters(model)
    if any(each.losses is not None and each.losses.origin == "estimate" for each in types):
        yield (
            "What converters lose is counted by an estimate, not by figures that were measured or "
            "guaranteed."
        )


def _converters(model: Model) -> list[ConverterType]:
    """Types of converters of today, and those that come with each measure at each of its levels."""
    cases = {(case.area, case.configuration): case for case in model.case_list.cases}
    found: list[ConverterType] = []
    for number, area in enumerate(model.areas):
        seen: set[tuple[int, int]] = set()
        for k, configuration in enumerate(area.configurations):
            built = {each for each in enumerate(configuration.levels) if each[1]}
            if k == 0 or built - seen:
                supply = model.case_list.scenario(cases[number, k]).supply
                found += supply.converters_in_use
            seen |= built
    return found


def _converter_losses(types: Sequence[ConverterType]) -> Iterator[str]:
    """Which losses of converters are not counted."""
    known = [kind.losses for kind in types if kind.losses is not None]
    if len(known) < len(types):
        which = "some converters" if known else "converters"
        whose = "their energy" if known else "energy"
        yield (
            f"Losses of {which} are not described in the scenarios, so {whose} is what stations "
            "give to the railway."
        )
    if known:
        yield "Outside the hours in which the traffic runs converters are taken to be off."


def unknown(model: Model) -> Iterator[str]:
    """What a plan that is proved by bounds leaves open, and what would tell it."""
    if model.has_bounds:
        yield (
            "What costs at least so much was not simulated as a whole, and may cost more. Where the "
            "first decision turns is not known, nor regrets and further plans that take more cases: "
            f"{ALL} simulates them all."
        )
