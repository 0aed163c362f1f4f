"""What is not a fault of a scenario, but may not be what its author intended."""

import math
from collections.abc import Iterator

import numpy as np

from tpss import library
from tpss.cli.implausible import implausible, rows_of
from tpss.kernel import plain
from tpss.model.effort_curve import adhesion, level_resistance
from tpss.model.neutral import strands
from tpss.model.routes import Route, index_of, routes_of, running_trains
from tpss.model.unfed import bare_in_words, unfed_in_words
from tpss.physics.running_resistance import gradient_force
from tpss.scenario import Scenario
from tpss.scenario.fields import LINE
from tpss.scenario.line import DECIMALS, Line
from tpss.scenario.machine import EffortTable
from tpss.scenario.own_laws import laws_of
from tpss.scenario.rolling_stock import Train
from tpss.scenario.supply.system import system_named
from tpss.scenario.traffic import Traffic
from tpss.step.model import Model
from tpss.units import kilometres, on_line, si

WHOLE = 1e-6
"""A time this close to a whole number of steps, in steps, is one."""


DEAD_STRETCH_KM, DEAD_SHARE = 50.0, 0.5
"""A stretch beyond the outermost station that is longer than both, the share being of the line, is
noted: it was hardly meant. [km], [1]"""


def notes(scenario: Scenario) -> list[str]:
    """Remarks in the order of the file."""
    return [
        *(
            note
            for each in _lines(scenario)
            for note in (*_profile(*each), *_dead_stretches(*each))
        ),
        *_supply(scenario),
        *(f"not an equation of TPSS: {law}" for law in laws_of(scenario)),
        *filter(None, [unfed_in_words(scenario), bare_in_words(scenario)]),
        *_voltage_limits(scenario),
        *_trains(scenario),
        *(note for i, entry in enumerate(scenario.traffic) for note in _times(scenario, i, entry)),
        *_single_trains(scenario),
        *(note for each in _routes(scenario) for note in _climb(scenario, *each)),
    ]


def stuck(scenario: Scenario, model: Model) -> Iterator[str]:
    """Trains that no speed carries through a neutral section; where several do, the first service."""
    running = running_trains(scenario, routes_of(scenario))
    for i, entry, route in _routes(scenario):
        kind = model.types[index_of(entry, route, running)]
        for begin_m, speed_m_s, stands_m in strands(kind, (route.start_m, *route.stops_m), model):
            yield (
                f"traffic.{i}: {entry.name} cannot coast through the neutral section at "
                f"{route.post(begin_m)} km: even at {3.6 * speed_m_s:.0f} km/h, the most that it may "
                f"have there, it comes to stand near {route.post(stands_m)} km, without power to start"
            )


def _routes(scenario: Scenario) -> list[tuple[int, Traffic, Route]]:
    """The first service of each route and train."""
    first: dict[tuple[object, ...], tuple[int, Traffic, Route]] = {}
    for i, (entry, route) in enumerate(zip(scenario.traffic, routes_of(scenario), strict=True)):
        way = entry.train, entry.origin, entry.destination, entry.via
        first.setdefault(way, (i, entry, route))
    return list(first.values())


def _lines(scenario: Scenario) -> list[tuple[str, Line]]:
    """Key paths of the lines, and the lines."""
    named = [(f"lines.{name}", line) for name, line in scenario.lines.items()]
    return named if scenario.line is None else [(LINE, scenario.line), *named]


def _profile(at: str, line: Line) -> Iterator[str]:
    begin, end = kilometres(line.begins_at_km), kilometres(line.end_km)
    first, last = line.gradients[0].from_km, line.gradients[-1].from_km
    if first > line.begins_at_km:
        yield (
            f"{at}.gradients begins at {kilometres(first)} km; its first gradient applies from "
            f"{begin} km on"
        )
    if first < line.begins_at_km and len(line.gradients) > 1:
        yield (
            f"{at}.gradients begins at {kilometres(first)} km, but the line at {begin} km; what lies "
            "before it is left out"
        )
    if last > line.end_km:
        yield f"{at}.gradients continues to {kilometres(last)} km, but the line ends at {end} km"
    limits = (("speed_limits", line.speed_limits), ("speed_limits_down", line.speed_limits_down))
    beyond = (
        (f"{at}.{key}.{i}", limit.from_km)
        for key, profile in limits
        for i, limit in enumerate(profile)
        if limit.from_km >= line.end_km
    )
    for key, from_km in beyond:
        yield f"{key} begins at {kilometres(from_km)} km, where the line has ended ({end} km)"


def _dead_stretches(at: str, line: Line) -> Iterator[str]:
    """Much line beyond the outermost stations: a contact line without trains draws charging current."""
    begin_km, end_km = line.begins_at_km, line.end_km
    places_km = [station.position_km for station in line.stations]
    first_km, last_km = min(places_km), max(places_km)
    least_km = max(DEAD_STRETCH_KM, DEAD_SHARE * line.length_km)
    first, length = f"{first_km:.12g}", f"{round(end_km - first_km, DECIMALS):.12g}"
    beginning = f"begins_at_km = {first} and length_km = {length}"
    ending = f"length_km = {round(last_km - begin_km, DECIMALS):.12g}"
    for start_km, stop_km, end, remedy in (
        (begin_km, first_km, "before its first", beginning),
        (last_km, end_km, "behind its last", ending),
    ):
        if stop_km - start_km > least_km:
            yield (
                f"{at}: {kilometres(stop_km - start_km)} km of contact line {end} station, from "
                f"{kilometres(start_km)} to {kilometres(stop_km)} km, have no train; if there is no "
                f"such line, give {remedy}"
            )


def _supply(scenario: Scenario) -> Iterator[str]:
    for i, station in enumerate(scenario.supply.converter_stations):
        if station.control == "loading" and station.converters == 1:
            yield (
                f'supply.converter_stations.{i}: control = "loading" has nothing to switch with one '
                "converter, which always runs"
            )


def _voltage_limits(scenario: Scenario) -> Iterator[str]:
    limits, system = scenario.standards.voltage_limits, scenario.supply.system
    nominal_kv = system_named(system).nominal_kv
    if limits.un_kv != nominal_kv:
        unjudged = (
            ""
            if limits.mean_useful_kv
            else ("; mean useful voltages are not judged, as mean_useful_kv is not given for it")
        )
        yield (
            f"standards.voltage_limits: its un_kv of {limits.un_kv:g} kV is not the {nominal_kv:g} kV "
            f"of the supply's system ({system}){unjudged}"
        )
    for station in scenario.supply.stations:
        without_load_kv = station.no_load_voltage_kv
        if not limits.umin1_kv <= without_load_kv <= limits.umax1_kv:
            yield (
                f"supply: {station.name} feeds {without_load_kv:g} kV without load, outside "
                f"of the {limits.umin1_kv:g} to {limits.umax1_kv:g} kV of standards.voltage_limits "
                f"({limits.system})"
            )


def _trains(scenario: Scenario) -> Iterator[str]:
    used = {entry.train for entry in scenario.traffic}
    lines = scenario.lines_by_name.values()
    slowest = min(speed for line in lines for speed in line.speeds_kmh)
    for name, train in scenario.trains.items():
        if name not in used:
            yield f"trains.{name} is used by no traffic entry"
        if train.max_speed_kmh < slowest:
            yield (
                f"trains.{name}: its max_speed_kmh of {train.max_speed_kmh:g} is below every speed "
                f"limit of the line (the lowest is {slowest:g} km/h)"
            )
        yield from _idle_current(name, train)
        yield from implausible(name, train)
        fastest = max(speed for line in lines for speed in line.speeds_kmh)
        yield from _early_end(name, train, fastest)


def _early_end(name: str, train: Train, line_kmh: float) -> Iterator[str]:
    """A table of tractive effort that ends below the speeds at which its train runs."""
    effort = train.tractive_effort
    if not isinstance(effort, EffortTable):
        return
    last_kmh = effort.speed_kmh[-1]
    fastest_kmh = min(train.max_speed_kmh, line_kmh)
    force_kn = max(row[-1] for row in rows_of(effort))
    if fastest_kmh > last_kmh and force_kn > 0.0:
        yield (
            f"trains.{name}: its table of tractive effort ends at {last_kmh:g} km/h, and the train runs "
            f"up to {fastest_kmh:g} km/h (max_speed_kmh = {train.max_speed_kmh:g}): beyond its end "
            f"the force of {force_kn:g} kN holds, so that {force_kn * last_kmh / 3.6:.0f} kW grow to "
            f"{force_kn * fastest_kmh / 3.6:.0f} kW; extend the table"
        )


def _idle_current(name: str, train: Train) -> Iterator[str]:
    """A current limit of the motors that the description of the machine does not ask for."""
    effort, current_a = train.tractive_effort, train.max_motor_current_a
    usual = library.entries("locomotives").get(train.model or "", {}).get("max_motor_current_a")
    if current_a is None or current_a == usual or effort == "Rc4":
        return
    if isinstance(effort, EffortTable) and effort.motor_current_a is not None:
        return
    kind = (
        "a table without motor_current_a" if isinstance(effort, EffortTable) else "force and power"
    )
    yield (
        f"trains.{name}: max_motor_current_a does nothing for a machine that is described by {kind}"
    )


def _single_trains(scenario: Scenario) -> Iterator[str]:
    """Times of single trains, of which a timetable may have many."""
    duration = scenario.simulation.duration_min
    times = {e.name: e.departure_min for e in scenario.traffic if e.departure_min is not None}
    later = [name for name, minute in times.items() if duration is not None and minute >= duration]
    if later:
        yield (
            f"{len(later)} of {len(times)} single trains, first {later[0]}, do not depart before the "
            f"end of the run, at {duration:g} min"
        )
    step = scenario.simulation.time_step_min
    if step is None or scenario.simulation.how_trains_move == "continuous":
        return
    between = [name for name, minute in times.items() if not _is_whole(minute / step)]
    if between:
        yield (
            f"{len(between)} of {len(times)} single trains, first {between[0]}, do not depart at whole "
            f"time steps of {step:g} min, but at the first step after their time"
        )


def _times(scenario: Scenario, i: int, entry: Traffic) -> Iterator[str]:
    if entry.departure_min is not None:
        return
    step, duration = scenario.simulation.time_step_min, scenario.simulation.duration_min
    departures = entry.listed_departures_min or (entry.first_departure_min,)
    key = f"traffic.{i} ({entry.name})"
    if duration is not None and departures[0] >= duration:
        yield (
            f"{key}: its first departure, at {departures[0]:g} min, is not before the end of the "
            f"run, at {duration:g} min"
        )
    if step is None or scenario.simulation.how_trains_move == "continuous":
        return  # it will be chosen, or does not matter
    if not all(_is_whole(time / step) for time in (*departures, entry.headway_min or 0.0)):
        yield (
            f"{key}: its departures are not all at whole time steps of {step:g} min; a train departs "
            "at the first step at or after its time"
        )
    for stop in entry.stops:
        steps = stop.dwell_min / step
        if not _is_whole(steps):
            yield (
                f"{key}: the stop of {stop.dwell_min:g} min at {stop.station} takes whole time steps, "
                f"{math.ceil(steps) * step:g} min"
            )


def _is_whole(steps: float) -> bool:
    return abs(steps - round(steps)) < WHOLE


def _climb(scenario: Scenario, i: int, entry: Traffic, route: Route) -> Iterator[str]:
    """The steepest place of a service's route, if its train could not start there."""
    lines = scenario.lines_by_name
    pieces = [
        (hop.sign * permille, hop.line, start_km, end_km)
        for hop in route.way.stretches
        for start_km, end_km, permille in lines[hop.line].gradients_between(
            *sorted((hop.begin_km, hop.end_km))
        )
    ]
    permille, line, start_km, end_km = max(pieces, key=lambda piece: piece[0])
    place = f"{kilometres(start_km)} and {kilometres(end_km)} km"
    train = scenario.trains[entry.train]
    needed_kn = _starting_force_n(train, permille) / 1e3
    available_kn = float(adhesion(train, np.zeros(1), scenario.simulation)[0]) / 1e3
    if needed_kn > available_kn:
        yield (
            f"traffic.{i} ({entry.name}): between {on_line(line if len(lines) > 1 else '', place)} "
            f"the gradient is {permille:g} ‰, on which {entry.train} needs {needed_kn:.0f} kN to start; "
            f"{_rails(train, scenario)} allow {available_kn:.0f} kN"
        )


def _rails(train: Train, scenario: Scenario) -> str:
    return f"{scenario.simulation.rail} rails" if train.adhesion is None else "the rails"


def _starting_force_n(train: Train, permille: float) -> float:
    """Rolling resistance at standstill, and gravity."""
    at_rest_n = float(level_resistance(train, np.zeros(1))[0])
    return at_rest_n + plain(gradient_force)(si(train, "mass_t"), permille * 1e-3)
