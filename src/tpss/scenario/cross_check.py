"""Checks between the parts of a scenario.

They read the document as it was written, not the validated parts, and skip what is missing or of
the wrong type, so that their faults are reported together with those of single fields.
"""

from collections.abc import Iterator, Mapping
from typing import Any

from tpss import library
from tpss.errors import Finding
from tpss.scenario.busbars import check_busbars
from tpss.scenario.direct_current import check_direct_current
from tpss.scenario.events import check_events
from tpss.scenario.feeding_points import check_feeding_points
from tpss.scenario.feeds import check_feeds
from tpss.scenario.itineraries import check_traffic
from tpss.scenario.of_the_system import check_systems, under_its_system
from tpss.scenario.positions import check_positions, check_stations_named
from tpss.scenario.raw import Fault, number, table
from tpss.scenario.stepped_motion import check_stepped_motion
from tpss.scenario.storage_faults import check_storage
from tpss.scenario.supply.system import DEFAULT_SYSTEM, SYSTEMS, system_named
from tpss.scenario.wiring import check_wiring

LONGEST_AGGRESSIVE_STEP_MIN = 1.0
"""Longest step with the aggressive driver, and the longest in the thesis. [min]"""

USING_SPARE_TIME = ("spare_time", "supplement_percent", "supplement_min_per_100km")
"""Keys of a service whose trains hold speeds, or coast, to use time."""


def cross_check(document: Mapping[str, Any], file: str) -> list[Finding]:
    """All faults between the parts of a document."""
    supply, simulation = table(document, "supply"), table(document, "simulation")
    findings = [*check_systems(document), *check_positions(document)]
    document = under_its_system(dict(document))
    findings += [*check_stations_named(document), *check_feeding_points(supply)]
    findings += [*check_feeds(document), *check_wiring(document), *check_busbars(document)]
    findings += [*_open_step(simulation), *_driver(simulation), *check_stepped_motion(document)]
    findings += [*_own_drivers(document), *_planned_order(document, simulation)]
    findings += _other_systems(document, supply.get("system", DEFAULT_SYSTEM))
    findings += [*check_traffic(document), *check_events(document)]
    findings += [*check_direct_current(document), *check_storage(document)]
    return [Finding(file, *finding) for finding in findings]


def _open_step(simulation: Mapping[str, Any]) -> Iterator[Fault]:
    """Least squares without a step: the runs that choose one would take too long."""
    if simulation.get("load_flow") == "least-squares" and "time_step_min" not in simulation:
        problem = "it is missing; least squares take too long for a step to be chosen"
        yield "simulation.time_step_min", "", problem, "add it"


def _driver(simulation: Mapping[str, Any]) -> Iterator[Fault]:
    step_min = number(simulation, "time_step_min")
    if simulation.get("driver") != "aggressive" or step_min is None:
        return
    if step_min > LONGEST_AGGRESSIVE_STEP_MIN:
        problem = "too long for the aggressive driver, who checks the speed only once per step"
        remedy = f'use {LONGEST_AGGRESSIVE_STEP_MIN:g} min or less, or driver = "regulated"'
        yield "simulation.time_step_min", f"{step_min:g}", problem, remedy


def _own_drivers(document: Mapping[str, Any]) -> Iterator[Fault]:
    """Trains with time to spare, and a driver by a law of his own: each would use it in his own way."""
    entries, trains = document.get("traffic"), table(document, "trains")
    for place, entry in enumerate(entries if isinstance(entries, list) else ()):
        if not isinstance(entry, Mapping) or not isinstance(entry.get("train"), str):
            continue
        if not table(table(trains, entry["train"]), "driver"):
            continue
        for key in USING_SPARE_TIME:
            if entry.get(key):
                problem = f"the driver of {entry['train']} follows a law of his own, not this"
                yield f"traffic.{place}.{key}", repr(entry[key]), problem, f"leave {key} out"


def _planned_order(document: Mapping[str, Any], simulation: Mapping[str, Any]) -> Iterator[Fault]:
    """Trains that keep a planned order, in a run of which it is not known how long it lasts."""
    rule = table(document, "signalling").get("single_track")
    if rule == "timetable-order" and "duration_min" not in simulation:
        problem = "it is missing; the order of trains is planned for as long as the run lasts"
        yield "simulation.duration_min", "", problem, "add it"


def _other_systems(document: Mapping[str, Any], system: object) -> Iterator[Fault]:
    """Limits of another system than that of the supply."""
    if not isinstance(system, str) or system not in library.entries(SYSTEMS):
        return  # a fault of its own
    limits = table(table(document, "standards"), "voltage_limits")
    named = limits.get("system", system)
    if isinstance(named, str) and named != system and named in library.entries("voltage_limits"):
        problem = f"the limits of another system than that of the supply, {system}"
        remedy = "leave it out, or choose supply.system; single limits can be overridden next to it"
        yield "standards.voltage_limits.system", repr(named), problem, remedy
    nominal_kv = system_named(system).nominal_kv
    for name, train in table(document, "trains").items():
        limitation = table(train, "current_limitation") if isinstance(train, Mapping) else {}
        un_kv = number(limitation, "un_kv")
        if un_kv is not None and un_kv != nominal_kv:
            problem = f"not the nominal voltage of the system {system}, {nominal_kv:g} kV"
            remedy = (
                "leave un_kv, umin2_kv and knee_factor out: they are those of the system; and give "
                "the max_current_a that belongs to it"
            )
            yield f"trains.{name}.current_limitation.un_kv", f"{un_kv:g}", problem, remedy
