"""Phases of the grid by islands: parts of the contact line that neutral sections or breaks part.

The load flow counts the phasors of each island from the voltage without load of what feeds it, so no
island needs to know the angle of another one; that is the angle of its phases, see
`physics.three_phase`.
"""

from collections.abc import Iterator

from tpss.errors import Finding, ScenarioError
from tpss.model.supply import SupplyPlan
from tpss.scenario.scenario import Scenario
from tpss.scenario.supply import Station, Supply, TransformerStation


def phases_of(station: Station) -> str | None:
    """Phases of the grid that a station feeds; None if they are not told."""
    return station.phases if isinstance(station, TransformerStation) else None


def islands_of(plan: SupplyPlan) -> list[int]:
    """A node of the island of each node, the same one for all of it; switches count as closed."""
    first = list(range(len(plan.nodes)))

    def root(node: int) -> int:
        while first[node] != node:
            node = first[node]
        return node

    for a, b in [*plan.edges, *plan.joints, *plan.guards]:
        first[root(b)] = root(a)
    return [root(node) for node in range(len(plan.nodes))]


def phases_of_nodes(plan: SupplyPlan, supply: Supply) -> list[str]:
    """Phases of the grid that feed the island of each node; empty where no station tells them."""
    islands, told = islands_of(plan), {}
    for node, station in zip(plan.sources, supply.stations, strict=True):
        if phases := phases_of(station):
            told[islands[node]] = phases
    return [told.get(island, "") for island in islands]


def demand_one_angle(scenario: Scenario, plan: SupplyPlan) -> None:
    """Refuse stations of different phases on one part of the contact line.

    Raises
    ------
    ScenarioError
        Two stations of different phases are tied by the contact line, which would short them.
    """
    if findings := list(_findings(scenario, plan)):
        raise ScenarioError(findings)


def _findings(scenario: Scenario, plan: SupplyPlan) -> Iterator[Finding]:
    supply, islands = scenario.supply, islands_of(plan)
    first: dict[int, tuple[Station, str]] = {}
    for node, station in zip(plan.sources, supply.stations, strict=True):
        phases = phases_of(station)
        if phases is None:
            continue
        other, told = first.setdefault(islands[node], (station, phases))
        if told != phases:
            problem = (
                f"{station.name} feeds the phases {phases} into contact line that {other.name} feeds "
                f"with {told}, which is a short circuit"
            )
            remedy = (
                "add a neutral section between them to supply.neutral_sections, or give both the "
                "same phases"
            )
            key = f"supply.transformer_stations.{_number(station, supply)}.phases"
            yield Finding(scenario.given_source, key, repr(phases), problem, remedy)


def _number(station: Station, supply: Supply) -> int:
    """Place in the file of a station, or of the one of which it is a side."""
    names = [each.name for each in supply.transformer_stations]
    if station.name in names:
        return names.index(station.name)
    return names.index(station.name.rpartition(" ")[0])
