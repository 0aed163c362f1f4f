"""Stores of energy of a scenario in SI units; their voltages held against those of line and trains."""

from collections.abc import Iterator, Sequence
from typing import Any

from tpss.errors import Finding, ScenarioError
from tpss.record import Records
from tpss.scenario.scenario import Scenario
from tpss.scenario.standards import limits_of_system
from tpss.scenario.storage import EnergyStore
from tpss.scenario.supply import Storage
from tpss.storage.store import Store
from tpss.storage.wayside import StoreLaw
from tpss.units import si


def store_of(given: EnergyStore) -> Any:
    """Row of the record of a store."""
    charge, discharge = given.efficiencies
    capacitor = {}
    if given.capacitance_f is not None and given.min_voltage_v is not None:
        capacitor = {
            "capacitance_f": si(given, "capacitance_f"),
            "empty_j": given.capacitance_f / 2.0 * given.min_voltage_v**2,
            "highest_current_a": si(given, "max_current_a"),
        }
    return Store.row(
        capacity_j=given.capacity_j,
        charge_power_w=si(given, "power_kw"),
        discharge_power_w=si(given, "power_kw"),
        charge_efficiency=charge,
        discharge_efficiency=discharge,
        standby_w=si(given, "standby_kw"),
        **capacitor,
    )


def build_stores(nodes: Sequence[int], stores: Sequence[Storage]) -> Records[StoreLaw]:
    """Stores at their nodes, in the order of the scenario."""
    return StoreLaw.array(
        StoreLaw.row(
            node=node,
            store=store_of(each),
            start_j=each.soc_start * each.capacity_j,
            charges_above_v=si(each, "charges_above_kv"),
            discharges_below_v=si(each, "discharges_below_kv"),
            charge_w_per_v=si(each, "charge_kw_per_v"),
            discharge_w_per_v=si(each, "discharge_kw_per_v"),
        )
        for node, each in zip(nodes, stores, strict=True)
    )


def demand_thresholds_in_order(scenario: Scenario) -> None:
    """Refuse stores that would charge from stations, or too late to take what trains feed back.

    Raises
    ------
    ScenarioError
        A store discharges at a voltage of a station without load, charges at one, or charges only where
        the line already takes less of what trains feed back.
    """
    if findings := list(_findings(scenario)):
        raise ScenarioError(findings)


def _findings(scenario: Scenario) -> Iterator[Finding]:
    if not scenario.supply.storage:
        return
    stations, file = scenario.supply.stations, scenario.given_source
    low = min(stations, key=lambda each: each.no_load_voltage_kv)
    high = max(stations, key=lambda each: each.no_load_voltage_kv)
    umax1_kv = limits_of_system(scenario.supply.system).umax1_kv
    taken_kv = {
        name: train.regeneration.full_until_kv or umax1_kv
        for name, train in scenario.trains.items()
        if train.regeneration is not None
    }
    first = min(taken_kv, key=lambda name: taken_kv[name], default="")
    for i, store in enumerate(scenario.supply.storage):
        key, above, below = f"supply.storage.{i}", store.charges_above_kv, store.discharges_below_kv
        if below >= low.no_load_voltage_kv:
            problem = _held_against("not below", low.name, low.no_load_voltage_kv)
            remedy = "lower it: the store would discharge where nobody draws power"
            yield Finding(file, f"{key}.discharges_below_kv", f"{below:g}", problem, remedy)
        if above <= high.no_load_voltage_kv:
            problem = _held_against("not above", high.name, high.no_load_voltage_kv)
            remedy = "raise it: the store would charge where nobody feeds back"
            yield Finding(file, f"{key}.charges_above_kv", f"{above:g}", problem, remedy)
        elif first and above >= taken_kv[first]:
            problem = (
                f"not below the voltage up to which the line takes all that {first} feeds back, "
                f"{taken_kv[first]:g} kV"
            )
            remedy = "lower it: braking energy would be refused before the store takes it"
            yield Finding(file, f"{key}.charges_above_kv", f"{above:g}", problem, remedy)


def _held_against(how: str, station: str, unloaded_kv: float) -> str:
    return f"{how} the voltage of {station} without load, {unloaded_kv:g} kV"
