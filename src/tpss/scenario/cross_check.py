"""Checks between the parts of a scenario.

They read the document as it was written, not the validated parts, and skip what is missing or of
the wrong type, so that their faults are reported together with those of single fields.
"""

from collections.abc import Iterator, Mapping
from typing import Any

from tpss import library
from tpss.errors import Finding
from tpss.scenario.events import check_events
from tpss.scenario.feeding_points import check_feeding_points
from tpss.scenario.feeds import check_feeds
from tpss.scenario.itineraries import check_traffic
from tpss.scenario.machine import CurrentLimitation
from tpss.scenario.positions import check_positions, check_stations_named
from tpss.scenario.raw import Fault, number, table
from tpss.scenario.simulation import made_of_stepped_motion
from tpss.scenario.supply.system import DEFAULT_SYSTEM, SYSTEMS, system_named
from tpss.scenario.wiring import check_wiring

LONGEST_AGGRESSIVE_STEP_MIN = 1.0
"""Longest step with the aggressive driver, and the longest in the thesis. [min]"""


def cross_check(document: Mapping[str, Any], file: str) -> list[Finding]:
    """All faults between the parts of a document."""
    supply, simulation = table(document, "supply"), table(document, "simulation")
    findings = list(check_positions(document))
    findings += [*check_stations_named(document), *check_feeding_points(supply)]
    findings += [*check_feeds(document), *check_wiring(document)]
    findings += [*_open_step(simulation), *_driver(simulation), *_bands(document, simulation)]
    findings += [*_separation(document, simulation), *_planned_order(document, simulation)]
    findings += _neutral_sections(supply, simulation)
    findings += _feeding_back(document, simulation)
    findings += _other_systems(document, supply.get("system", DEFAULT_SYSTEM))
    findings += [*check_traffic(document), *check_events(document)]
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


def _separation(document: Mapping[str, Any], simulation: Mapping[str, Any]) -> Iterator[Fault]:
    """Trains that are kept apart, with stepped motion, which knows no authorities."""
    choices = ['motion = "stepped"'] if simulation.get("motion") == "stepped" else []
    choices += made_of_stepped_motion(simulation.get)
    wanted = table(document, "signalling").get("separation", "none")
    if choices and wanted != "none":
        problem = f"does not go with {choices[0]}"
        yield "signalling.separation", repr(wanted), problem, f"leave {choices[0]} out"


def _feeding_back(document: Mapping[str, Any], simulation: Mapping[str, Any]) -> Iterator[Fault]:
    """Trains that feed back, with stepped motion, which knows no brakes for a part of a step."""
    choices = ['motion = "stepped"'] if simulation.get("motion") == "stepped" else []
    choices += made_of_stepped_motion(simulation.get)
    for name, train in table(document, "trains").items():
        if choices and isinstance(train, Mapping) and table(train, "regeneration"):
            problem = f"does not go with {choices[0]}"
            yield f"trains.{name}.regeneration", "", problem, f"leave {choices[0]} out"


def _neutral_sections(supply: Mapping[str, Any], simulation: Mapping[str, Any]) -> Iterator[Fault]:
    """Neutral sections, with stepped motion, in which a train has power in whole steps."""
    choices = ['motion = "stepped"'] if simulation.get("motion") == "stepped" else []
    choices += made_of_stepped_motion(simulation.get)
    if choices and supply.get("neutral_sections"):
        problem = f"trains pass them for a part of a step, which {choices[0]} does not know"
        yield "supply.neutral_sections", "", problem, f"leave {choices[0]} out"


def _planned_order(document: Mapping[str, Any], simulation: Mapping[str, Any]) -> Iterator[Fault]:
    """Trains that keep a planned order, in a run of which it is not known how long it lasts."""
    rule = table(document, "signalling").get("single_track")
    if rule == "timetable-order" and "duration_min" not in simulation:
        problem = "it is missing; the order of trains is planned for as long as the run lasts"
        yield "simulation.duration_min", "", problem, "add it"


def _bands(document: Mapping[str, Any], simulation: Mapping[str, Any]) -> Iterator[Fault]:
    """Retardations that depend on the speed, with stepped motion, whose plans know a single one."""
    choices = ['motion = "stepped"'] if simulation.get("motion") == "stepped" else []
    choices += made_of_stepped_motion(simulation.get)
    for name, train in table(document, "trains").items():
        if choices and isinstance(train, Mapping) and table(train, "max_retardation_m_s2"):
            problem = f"one for each band of speeds, which {choices[0]} does not know"
            remedy = f"give a number, or leave {choices[0]} out"
            yield f"trains.{name}.max_retardation_m_s2", "", problem, remedy


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
        un_kv = number(limitation, "un_kv") or CurrentLimitation.model_fields["un_kv"].default
        if limitation and un_kv != nominal_kv:
            problem = f"not the nominal voltage of the system {system}, {nominal_kv:g} kV"
            remedy = (
                f"write un_kv = {nominal_kv:g}, and umin2_kv and max_current_a that belong to it"
            )
            yield f"trains.{name}.current_limitation.un_kv", f"{un_kv:g}", problem, remedy
