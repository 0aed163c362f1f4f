"""Phases of the grid by islands: parts of the contact line that neutral sections or breaks part.

The load flow counts the phasors of each island from the voltage without load of what feeds it, so no
island needs to know the angle of another one; that is the angle of its phases, see
`physics.three_phase`.
"""

from collections.abc import Iterator

from tpss.errors import Finding, ScenarioError
from tpss.model.conductors import KIND_OF
from tpss.model.supply_plan import SupplyPlan
from tpss.scenario.scenario import Scenario
from tpss.scenario.supply import Station, Supply, TransformerStation

SHORTED = "contact line that {} feeds with {}, which is a short circuit"
PART_THEM = (
    "add a neutral section between them to supply.neutral_sections, or give both the same phases"
)
BY_CONDUCTORS = "a line whose rails, which are conductors here, go on to those of {} at {}"
ONE_ANGLE = (
    "leave supply.conductors out, or phases: rails know currents of one angle only, not those of two "
    "pairs of phases"
)
"""Of stations tied by the contact line, or by other conductors: what is wrong, and the remedy."""


def phases_of(station: Station) -> str | None:
    """Phases of the grid that a station feeds; None if they are not told."""
    return station.phases if isinstance(station, TransformerStation) else None


def islands_of(plan: SupplyPlan, by_conductors: bool = False) -> list[int]:
    """A node of the island of each node, the same one for all of it; switches count as closed.

    Rails and feeders that are conductors, which go on where neutral sections part the contact line, tie
    islands only if asked for.
    """
    beside = () if by_conductors else KIND_OF.values()
    apart = {node for node, kind in enumerate(plan.node_kinds) if kind in beside}
    first = list(range(len(plan.nodes)))

    def root(node: int) -> int:
        while first[node] != node:
            node = first[node]
        return node

    for a, b in [*plan.edges, *plan.joints, *plan.guards]:
        if a not in apart and b not in apart:
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
        Two stations of different phases are tied by the contact line, which would short them; or by
        rails or feeders that are conductors, in which the currents of both have no angle in common.
    """
    if all(phases_of(station) is None for station in scenario.supply.stations):
        return
    shorted = list(_findings(scenario, plan, islands_of(plan), SHORTED, PART_THEM))
    if findings := shorted or list(
        _findings(scenario, plan, islands_of(plan, by_conductors=True), BY_CONDUCTORS, ONE_ANGLE)
    ):
        raise ScenarioError(findings)


def _findings(
    scenario: Scenario, plan: SupplyPlan, islands: list[int], words: str, remedy: str
) -> Iterator[Finding]:
    supply = scenario.supply
    first: dict[int, tuple[Station, str]] = {}
    for node, station in zip(plan.sources, supply.stations, strict=True):
        phases = phases_of(station)
        if phases is None:
            continue
        other, told = first.setdefault(islands[node], (station, phases))
        if told != phases:
            problem = f"{station.name} feeds the phases {phases} into {words}".format(
                other.name, told
            )
            key = f"supply.transformer_stations.{_number(station, supply)}.phases"
            yield Finding(scenario.given_source, key, repr(phases), problem, remedy)


def _number(station: Station, supply: Supply) -> int:
    """Place in the file of a station, or of the one of which it is a side."""
    names = [each.name for each in supply.transformer_stations]
    if station.name in names:
        return names.index(station.name)
    return names.index(station.name.rpartition(" ")[0])
