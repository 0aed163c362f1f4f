"""Requirements on grids and rails, held against what the scenarios of the areas tell."""

from collections.abc import Iterator, Mapping

from tpss.errors import Finding
from tpss.planning.plan import Requirements
from tpss.results.grid_and_rails import RAILS, UNBALANCE, has_own_rails, has_phases
from tpss.scenario.scenario import Scenario

GIVE_PHASES = "give phases and grid_kv of its transformer stations, or leave the requirement out"
GIVE_RAILS = "write supply.conductors, or leave the requirement out"
NO_STRAY = "leave the requirement out: rails of alternating current have none"


def not_told(
    require: Requirements, scenarios: Mapping[str, Scenario], file: str
) -> Iterator[Finding]:
    """Requirements of which the scenario of an area, by its name, tells nothing."""
    for area, today in scenarios.items():
        for name, remedy in _untold(today):
            limit = getattr(require, name)
            if limit is not None:
                problem = f"the scenario{f' of {area}' if area else ''} does not tell it"
                yield Finding(file, f"require.{name}", f"{limit:g}", problem, remedy)


def _untold(today: Scenario) -> Iterator[tuple[str, str]]:
    """Figures that runs of a scenario do not have, and how they would."""
    if not has_phases(today):
        yield from ((name, GIVE_PHASES) for name in UNBALANCE)
    if not has_own_rails(today):
        yield from ((name, GIVE_RAILS) for name in RAILS)
    elif not today.supply.is_direct:
        yield "stray_ma_per_m", NO_STRAY
