"""Faults of outages: what they name that the supply, or a line, does not have."""

from collections.abc import Iterator, Mapping, Sequence

from tpss.errors import Finding, no_such
from tpss.scenario.line import Line
from tpss.scenario.out_sections import section_faults
from tpss.scenario.outages import SAME_PLACE_KM, SWITCHES, Outage
from tpss.scenario.raw import Fault
from tpss.scenario.simulation import Simulation
from tpss.scenario.supply import Station, Supply
from tpss.scenario.supply.converter_station import ConverterStation
from tpss.scenario.supply.feeds import feeds_of, places_on
from tpss.scenario.supply.mixed_station import MixedStation
from tpss.scenario.supply.transformers import feeding_positions_km
from tpss.units import kilometres, on_line


def outage_faults(
    outages: Sequence[Outage],
    simulation: Simulation,
    supply: Supply,
    lines: Mapping[str, Line],
    file: str,
) -> list[Finding]:
    """What outages name that the supply does not have, and a choice of one that there is not.

    Whether the lines of sections are there, and the sections on them, is told with all positions.
    """
    switches = [each.name for kind in SWITCHES for each in getattr(supply, kind)]
    places = places_on(lines)
    switches += [feed.name for each in supply.stations for feed in feeds_of(each, places)]
    findings = [
        Finding(file, f"outages.{i}.{key}", value, problem, remedy)
        for i, outage in enumerate(outages)
        for faults in (_faults(outage, supply, switches), section_faults(outage, supply, lines))
        for key, value, problem, remedy in faults
    ]
    names, chosen = [outage.name for outage in outages], simulation.outage
    if chosen is not None and chosen not in names:
        problem, remedy = no_such("outage", chosen, names)
        findings.append(Finding(file, "simulation.outage", repr(chosen), problem, remedy))
    if chosen is not None and simulation.load_flow == "least-squares":
        problem = "the original program's load flow knows no outages"
        remedy = 'use load_flow = "equations", or leave simulation.outage out'
        value = repr(simulation.load_flow)
        findings.append(Finding(file, "simulation.load_flow", value, problem, remedy))
    return findings


def _faults(outage: Outage, supply: Supply, switches: Sequence[str]) -> Iterator[Fault]:
    stations = {station.name: station for station in supply.stations}
    named = [(f"stations.{i}", name) for i, name in enumerate(outage.stations)]
    for key, name in [*named, *((f"units.{name}", name) for name in outage.units)]:
        if name not in stations:
            yield key, repr(name), *no_such("station", name, list(stations))
    for i, name in enumerate(outage.opens):
        if name not in switches:
            yield f"opens.{i}", repr(name), *no_such("switch", name, switches)
    for name, count in outage.units.items():
        if name in stations:
            yield from _units(name, count, stations[name])
    stores = [store.name for store in supply.storage]
    for i, name in enumerate(outage.storage):
        if name not in stores:
            yield f"storage.{i}", repr(name), *no_such("store", name, stores)
    yield from _autotransformers(outage, supply)
    known_km = feeding_positions_km(supply)
    for i, km in enumerate(outage.transformers_km):
        if not any(abs(km - each) <= SAME_PLACE_KM for each in known_km):
            listed = ", ".join(f"{kilometres(each)} km" for each in known_km) or "none"
            problem = "the high-voltage line has no transformer there"
            yield f"transformers_km.{i}", kilometres(km), problem, f"transformers: {listed}"


def _autotransformers(outage: Outage, supply: Supply) -> Iterator[Fault]:
    """Autotransformers where none stands."""
    known = [(each.line, km) for each in supply.autotransformers for km in each.positions_km]
    for i, out in enumerate(outage.autotransformers):
        if not any(out.is_at(line, km) for line, km in known):
            listed = [on_line(line or "", f"{kilometres(km)} km") for line, km in known]
            problem = "the supply has no autotransformer there"
            remedy = f"autotransformers: {', '.join(listed) or 'none'}"
            yield f"autotransformers.{i}.position_km", kilometres(out.position_km), problem, remedy


def _units(name: str, count: int, station: Station) -> Iterator[Fault]:
    """More units out than there are, or so many that the others' motors have no voltage left."""
    key, left = f"units.{name}", station.installed - count
    if left < 0:
        problem = f"more than are installed there, {station.installed}"
        yield key, str(count), problem, f"give {station.installed} or less"
    elif left > 0 and isinstance(station, MixedStation):
        problem = f"{name} has converters of several types, of which single ones do not go out"
        yield key, str(count), problem, f"take {name} out as a station, under stations"
    elif left > 0 and isinstance(station, ConverterStation):
        reduced = station.model_copy(update={"converters": left})
        if station.grid_reactive_power_mvar <= reduced.least_reactive_mvar:
            problem = (
                f"with {left} converters, grid_reactive_power_mvar "
                f"({station.grid_reactive_power_mvar:g} Mvar) leaves the motors no voltage"
            )
            yield key, str(count), problem, "take less reactive power from the grid"
