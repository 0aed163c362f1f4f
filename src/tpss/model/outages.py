"""What of a scenario's supply is in service, and when."""

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from tpss.errors import Finding, ScenarioError
from tpss.kept import Kept
from tpss.model.parting import Joint, parting_of
from tpss.model.supply import build_supply, joined_network, layouts_of
from tpss.model.supply_plan import TRANSFORMER, SupplyPlan
from tpss.powerflow.following import following
from tpss.powerflow.in_service import in_service
from tpss.powerflow.network import UNFED, Network
from tpss.run.relays import Protected, Trip
from tpss.run.switching import Switching
from tpss.scenario.outages import SAME_PLACE_KM, Outage
from tpss.scenario.scenario import Scenario
from tpss.scenario.supply import Supply


class Service(NamedTuple):
    """The network with which a run begins, and those that take its place, in the order of time."""

    network: Network
    switchings: tuple[Switching, ...] = ()


def service_of(
    scenario: Scenario, outage: Outage | None = None, trips: Sequence[Trip] = ()
) -> Service:
    """Networks of a run with an outage; by default with the one that the scenario asks for, if any.

    Parameters
    ----------
    scenario : Scenario
    outage : Outage, optional
    trips : sequence of Trip, optional
        What trips during the run, in the order of time.

    Raises
    ------
    ScenarioError
        A part of the line is left without a feeding station, and trains move in steps.
    """
    outage = outage or scenario.outage
    laid = layout_of(scenario, outage)
    begins_s, ends_s = _times_s(outage)
    is_out = begins_s <= 0.0 < ends_s
    first = laid.network_with(outage if is_out else None)
    with_outage = first if is_out or outage is None else laid.network_with(outage)
    _demand_continuous_motion(with_outage, laid.plan, outage, scenario)
    times_s = {trip.time_s for trip in trips} | {begins_s, ends_s}
    later = [
        Switching(
            time_s,
            laid.network_with(
                outage if begins_s <= time_s < ends_s else None,
                [trip.protected for trip in trips if trip.time_s <= time_s],
            ),
        )
        for time_s in sorted(times_s)
        if 0.0 < time_s < math.inf
    ]
    return Service(first, tuple(later))


def _times_s(outage: Outage | None) -> tuple[float, float]:
    """When an outage begins and ends; one that there is not begins never. [s]"""
    if outage is None:
        return math.inf, math.inf
    return 60.0 * outage.from_min, math.inf if outage.to_min is None else 60.0 * outage.to_min


@dataclass(frozen=True, eq=False)
class Laid:
    """A supply with all open that an outage opens, before anything else is taken out.

    There is one of each such supply, which cases share: it equals itself only.
    """

    network: Network
    plan: SupplyPlan
    supply: Supply

    def network_with(self, outage: Outage | None, out: Collection[Protected] = ()) -> Network:
        """The network with all that an outage names out of service, if there is one, and all trips."""
        plan = self.plan
        apart = {
            node
            for each in out
            if each.section >= 0
            for node in (
                plan.sections[each.section].start_node,
                plan.sections[each.section].end_node,
            )
        }
        joints = [] if outage is not None else plan.joints
        joints = [*joints, *(joint for joint in plan.guards if joint[1] not in apart)]
        if outage is None and not out:
            return self._shared(joints, None)
        units = {} if outage is None else _units_left(outage, self.supply)
        units |= {each.station: 0 for each in out if each.station >= 0}
        opened = [] if outage is None else _transformers_out(outage, plan)
        opened += [each.transformer for each in out if each.transformer >= 0]
        links = {} if outage is None else dict.fromkeys(_autotransformers_out(outage, plan), 0.0)
        for s, count in units.items():
            share = count / self.supply.stations[s].installed
            links |= dict.fromkeys(plan.station_links.get(s, ()), share)
        stores = [] if outage is None else _stores_out(outage, self.supply)
        left = _Left(tuple(units.items()), tuple(opened), tuple(links.items()), tuple(stores))
        if out:  # a run tells by its network whether something has tripped: each is one of its own
            return _network_of(self, joints, left)
        return self._shared(joints, left)

    def _shared(self, joints: Sequence[Joint], left: "_Left | None") -> Network:
        """The network with pairs of nodes joined and what is left in service, which cases share."""
        key = self, tuple(joints), left
        return _networks.of(key, lambda: _network_of(self, joints, left))


class _Left(NamedTuple):
    """What is left of a supply in service."""

    units: tuple[tuple[int, int], ...]
    """Numbers of stations, and units that they have left."""
    opened: tuple[int, ...]
    """Numbers of the branches that are out."""
    links: tuple[tuple[int, float], ...]
    """Numbers of links, and the share of each that is left."""
    stores: tuple[int, ...]
    """Numbers of the stores that are out."""


def _network_of(laid: Laid, joints: Sequence[Joint], left: _Left | None) -> Network:
    """The network of a supply with pairs of nodes joined, and what is left in service; None: all."""
    network, leaders = joined_network(laid.network, laid.plan, laid.supply, joints)
    if left is not None:
        network = in_service(network, dict(left.units), left.opened, dict(left.links), left.stores)
    return following(network, leaders) if leaders else network


_networks, _laid = Kept[Network](128), Kept[Laid](64)


def layout_of(scenario: Scenario, outage: Outage | None) -> Laid:
    """Network of a scenario that is parted as an outage parts it, and its parts."""
    parting = parting_of(outage, scenario.supply, scenario.protection.trip)
    supply = scenario.supply if outage is None else outage.switched(scenario.supply)
    key = (supply, layouts_of(scenario.lines_by_name), parting)
    return _laid.of(key, lambda: Laid(*build_supply(*key), supply))


def _units_left(outage: Outage, supply: Supply) -> dict[int, int]:
    """Units in service of the stations of which an outage takes some out."""
    return {
        s: station.installed - out
        for s, station in enumerate(supply.stations)
        if (out := outage.units_of(station))
    }


def _transformers_out(outage: Outage, plan: SupplyPlan) -> list[int]:
    """Numbers of the branches of transformers that an outage takes out."""
    return [
        b
        for b, (kind, branch) in enumerate(zip(plan.branch_kinds, plan.branches, strict=True))
        if kind == TRANSFORMER and _is_at(plan.node_km[branch.start_node], outage)
    ]


def _autotransformers_out(outage: Outage, plan: SupplyPlan) -> list[int]:
    """Numbers of the links of autotransformers that an outage takes out."""
    return [
        k
        for (line, km), links in plan.autotransformer_links.items()
        if any(each.is_at(line, km) for each in outage.autotransformers)
        for k in links
    ]


def _stores_out(outage: Outage, supply: Supply) -> list[int]:
    """Numbers of the stores of energy at the line that an outage takes out."""
    return [m for m, store in enumerate(supply.storage) if store.name in outage.storage]


def _is_at(position_km: float, outage: Outage) -> bool:
    """Whether a transformer stands where the outage says one is out."""
    return any(abs(position_km - km) <= SAME_PLACE_KM for km in outage.transformers_km)


def _demand_continuous_motion(
    network: Network, plan: SupplyPlan, outage: Outage | None, scenario: Scenario
) -> None:
    """Refuse to leave contact line without a feeding station where trains move in steps.

    A train without power comes to stand anywhere within a step, which stepped motion does not know.
    """
    begins = network.sections["start_node"]
    unfed = begins[network.source_of_node[begins] == UNFED]
    if unfed.size == 0 or scenario.simulation.how_trains_move == "continuous":
        return
    names = [each.name for each in scenario.outages]
    key = "supply" if outage is None else "outages"
    if outage is not None and outage.name in names:
        key = f"outages.{names.index(outage.name)}"
    problem = (
        f"no feeding station reaches {plan.nodes[unfed[0]]}, which stepped motion does not know"
    )
    remedy = 'use motion = "continuous", or let a station or a transformer feed it'
    value = "" if outage is None else repr(outage.name)
    raise ScenarioError([Finding(scenario.given_source, key, value, problem, remedy)])
