"""What of a scenario's supply is in service, and when."""

from typing import NamedTuple

from tpss.errors import Finding, ScenarioError
from tpss.model.parting import parting_of
from tpss.model.supply import (
    NOTHING_PARTED,
    TRANSFORMER,
    SupplyPlan,
    build_supply,
    layouts_of,
    whole_network,
)
from tpss.powerflow.in_service import in_service
from tpss.powerflow.network import UNFED, Network
from tpss.run.switching import Switching
from tpss.scenario.outages import SAME_PLACE_KM, Outage
from tpss.scenario.scenario import Scenario
from tpss.scenario.supply import Supply


class Service(NamedTuple):
    """The network with which a run begins, and those that take its place, in the order of time."""

    network: Network
    switchings: tuple[Switching, ...] = ()


def service_of(scenario: Scenario, outage: Outage | None = None) -> Service:
    """Networks of a run with an outage; by default with the one that the scenario asks for, if any.

    Raises
    ------
    ScenarioError
        A part of the line is left without a feeding station, and trains move in steps.
    """
    outage = outage or scenario.outage
    laid = layout_of(scenario, outage)
    if outage is None:
        _demand_continuous_motion(laid.network, laid.plan, None, scenario)
        return Service(laid.network)
    reduced = reduced_network(laid.network, laid.plan, laid.supply, outage)
    _demand_continuous_motion(reduced, laid.plan, outage, scenario)
    if outage.is_throughout:
        return Service(reduced)
    intact = whole_network(*laid)
    ending = () if outage.to_min is None else (Switching(60.0 * outage.to_min, intact),)
    if outage.from_min == 0.0:
        return Service(reduced, ending)
    return Service(intact, (Switching(60.0 * outage.from_min, reduced), *ending))


class Laid(NamedTuple):
    """A supply with all open that an outage opens, before anything else is taken out."""

    network: Network
    plan: SupplyPlan
    supply: Supply


def layout_of(scenario: Scenario, outage: Outage | None) -> Laid:
    """Network of a scenario that is parted as an outage parts it, and its parts."""
    supply, parting = scenario.supply, NOTHING_PARTED
    if outage is not None:
        supply, parting = outage.switched(supply), parting_of(outage, supply)
    return Laid(*build_supply(supply, layouts_of(scenario.lines_by_name), parting), supply)


def reduced_network(intact: Network, plan: SupplyPlan, supply: Supply, outage: Outage) -> Network:
    """The network with all that an outage names out of service."""
    units = {
        s: station.installed - out
        for s, station in enumerate(supply.stations)
        if (out := outage.units_of(station))
    }
    opened = [
        b
        for b, (kind, branch) in enumerate(zip(plan.branch_kinds, plan.branches, strict=True))
        if kind == TRANSFORMER and _is_at(plan.node_km[branch.start_node], outage)
    ]
    return in_service(intact, units, opened)


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
