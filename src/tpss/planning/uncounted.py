"""What a plan does not count, in words, for whoever reads its figures."""

from collections.abc import Iterator

from tpss.planning.solve import Model

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
    lossless = [
        each.area.name or model.plan.file.name
        for each in model.areas
        if each.area.today.supply.converter_stations and not _loses(model, each.area.today.name)
    ]
    if lossless:
        yield (
            "Losses of converters are not described in the scenarios, so energy is what stations "
            "give to the railway."
        )
    if not (model.table["fed_back_to_grid_mw"].fillna(0.0) > 0.0).any():
        yield "No energy is given back to the grid."
    if model.plan.file.budget is None:
        yield "There is no budget."


def _loses(model: Model, scenario: str) -> bool:
    """Whether stations of a scenario lose some of what they take from the grid."""
    table = model.table[model.table.scenario.str.startswith(scenario)]
    columns = [name for name in table if str(name).endswith("station_losses_mw")]
    return bool((table[columns].fillna(0.0) > 0.0).any(axis=None))
