"""Voltages between which the line stops taking what trains feed back, held against what feeds it."""

from collections.abc import Iterator

from tpss.errors import Finding, ScenarioError
from tpss.scenario.scenario import Scenario
from tpss.scenario.standards import limits_of_system


def demand_room_to_feed_back(scenario: Scenario) -> None:
    """Refuse trains that could not feed back even where nobody draws power.

    Raises
    ------
    ScenarioError
        The voltage up to which the line takes all of it is not below that from which it takes none, or
        lies below the voltage of a station without load.
    """
    if findings := list(_findings(scenario)):
        raise ScenarioError(findings)


def _findings(scenario: Scenario) -> Iterator[Finding]:
    limits = limits_of_system(scenario.supply.system)
    station = max(scenario.supply.stations, key=lambda each: each.no_load_voltage_kv)
    for name, train in scenario.trains.items():
        own = train.regeneration
        if own is None:
            continue
        full_kv = limits.umax1_kv if own.full_until_kv is None else own.full_until_kv
        zero_kv = limits.umax2_kv if own.zero_from_kv is None else own.zero_from_kv
        key, file = f"trains.{name}.regeneration", scenario.given_source
        if zero_kv <= full_kv:
            problem = f"not below zero_from_kv, {zero_kv:g} kV"
            remedy = (
                "what is fed back falls as the voltage rises: give the higher one as zero_from_kv"
            )
            yield Finding(file, f"{key}.full_until_kv", f"{full_kv:g}", problem, remedy)
        elif full_kv < station.no_load_voltage_kv:
            unloaded_kv = station.no_load_voltage_kv
            problem = f"below the voltage of {station.name} without load, {unloaded_kv:g} kV"
            remedy = (
                "raise it: where nobody draws power the line would not take what trains feed back"
            )
            yield Finding(file, f"{key}.full_until_kv", f"{full_kv:g}", problem, remedy)
