"""The traffic of a scenario as services."""

from collections.abc import Sequence
from typing import Any

from tpss.driving.data import Braking, Driver, MotionModel, Options, Profile
from tpss.driving.manners import stopping_distance
from tpss.driving.speed_limits import UNIFORM, can_meet_limit
from tpss.errors import Finding, ScenarioError
from tpss.kernel import plain
from tpss.model.gates import crossing_places
from tpss.model.neutral import is_in_neutral
from tpss.model.routes import Route, index_of, routes_of, running_trains
from tpss.model.two_way_tracks import two_way_tracks
from tpss.numerics.staircase import index_at
from tpss.run.delays import Delays
from tpss.run.services import Service
from tpss.scenario.scenario import Scenario
from tpss.scenario.traffic import Traffic
from tpss.step.model import Model
from tpss.units import si
from tpss.vehicle.braking import braking_distance, braking_square
from tpss.vehicle.train_type import TrainType


def build_services(scenario: Scenario, model: Model) -> list[Service]:
    """Services in the order of the traffic entries.

    Raises
    ------
    ScenarioError
        A train placed on the line is faster than its limit, or cannot stop or slow down in time; a train
        is longer than the tracks on which it may have to wait for others to cross.
    """
    routes, services = routes_of(scenario), []
    running = running_trains(scenario, routes)
    for number, (entry, route) in enumerate(zip(scenario.traffic, routes, strict=True)):
        services.append(
            Service(
                name=entry.name,
                train_type=index_of(entry, route, running),
                route=number,
                start_m=route.start_m,
                stops_m=route.stops_m,
                initial=tuple(
                    (route.position_m(scenario.line_of(t), t.position_km), si(t, "speed_kmh"))
                    for t in entry.initial_trains
                ),
                already_running=entry.already_running,
                delays=_delays(entry),
                origin=entry.origin,
                starts_apart_s=scenario.signalling.starts_apart_s,
                **_departures(entry),
            )
        )
    findings = [
        finding
        for service, route in zip(services, routes, strict=True)
        for i in range(len(service.initial))
        for finding in _check_placed(service, route, i, model, scenario.given_source)
    ]
    if scenario.supply.neutral_sections:
        findings += _stops_without_power(scenario, services, routes, model)
    if scenario.signalling.has_gates:
        findings += _too_long(scenario, routes)
    if findings:
        raise ScenarioError(findings)
    return services


def _too_long(scenario: Scenario, routes: Sequence[Route]) -> list[Finding]:
    """Trains that are longer than the tracks on which they may have to wait."""
    found: dict[tuple[str, str], Finding] = {}
    lines = scenario.lines_by_name
    two_way = two_way_tracks(routes, lines)
    for entry, route in zip(scenario.traffic, routes, strict=True):
        length_m = scenario.trains[entry.train].length_m
        for station in crossing_places(route, two_way, lines):
            room_m = station.track_length_m
            if room_m is None or length_m <= room_m:
                continue
            problem = (
                f"longer than the tracks of {station.name}, {room_m:g} m, where {entry.name} may have "
                "to wait for others to cross"
            )
            remedy = f"shorten the train, or let nobody cross at {station.name}: tracks = 1"
            key = f"trains.{entry.train}.length_m"
            finding = Finding(scenario.given_source, key, f"{length_m:g}", problem, remedy)
            found.setdefault((entry.train, station.name), finding)
    return list(found.values())


def _stops_without_power(
    scenario: Scenario, services: Sequence[Service], routes: Sequence[Route], model: Model
) -> list[Finding]:
    """Stops in neutral sections, from which no train could start."""
    found = []
    for number, (service, route) in enumerate(zip(services, routes, strict=True)):
        kind, entry = model.types[service.train_type], scenario.traffic[number]
        keys = ["from", *(f"stops.{k}.station" for k in range(len(entry.stops)))]
        names = [entry.origin, *(stop.station for stop in entry.stops)]
        for key, name, m in zip(keys, names, (route.start_m, *route.stops_m), strict=False):
            if is_in_neutral(m, kind, model):
                problem = "in a neutral section, where no train can start"
                remedy = "let its trains pass there, or correct supply.neutral_sections"
                key = f"traffic.{number}.{key}"
                found.append(Finding(scenario.given_source, key, repr(name), problem, remedy))
    return found


def _delays(entry: Traffic) -> Delays | None:
    given = entry.delays
    return None if given is None else Delays(si(given, "mean_min"), given.share, given.seed)


def _departures(entry: Traffic) -> dict[str, Any]:
    if (listed := entry.listed_departures_min) is not None:
        departures_s = tuple(60.0 * minute for minute in listed)
        return {"departures_s": departures_s, "is_one_train": entry.departure_min is not None}
    return {"headway_s": si(entry, "headway_min"), "first_s": si(entry, "first_departure_min")}


def _check_placed(service: Service, route: Route, i: int, model: Model, file: str) -> list[Finding]:
    """Faults of the `i`-th train that a service places on the line."""
    position_m, speed = service.initial[i]
    key = f"traffic.{service.route}.initial_trains.{i}.speed_kmh"
    kind = model.types[service.train_type]
    limits = Profile(*(values[kind.profile] for values in model.limits))
    here = plain(index_at)(position_m, limits.from_m)
    limit = min(limits.value[here], kind.highest_speed_m_s)
    stop_m = min(m for m in service.stops_m if m > position_m)
    problem = ""
    if speed > limit and model.options.driver != Driver.AGGRESSIVE:
        problem = f"faster than the limit here, {limit * 3.6:g} km/h"
    elif _stopping_distance(speed, kind, model.options) > stop_m - position_m:
        problem = f"too fast to stop at {route.post(stop_m)} km"
        problem += " in whole time steps" if model.options.braking == Braking.WHOLE_STEPS else ""
    else:
        for j in range(here + 1, limits.from_m.size):
            lower = limits.value[j] < limits.value[j - 1]
            distance_m = limits.from_m[j] - position_m
            if lower and not _meets(speed, distance_m, limits.value[j], kind, model.options):
                problem = f"too fast to meet the limit at {route.post(limits.from_m[j])} km"
    if not problem:
        return []
    remedy = "lower the speed, or place the train earlier"
    return [Finding(file, key, f"{speed * 3.6:g}", problem, remedy)]


def _stopping_distance(speed_m_s: float, kind: TrainType, options: Options) -> float:
    """Shortest distance in which a train stops. [m]"""
    retardation_m_s2 = kind.highest_retardation_m_s2
    if options.motion == MotionModel.CONTINUOUS:
        return plain(braking_distance)(speed_m_s, retardation_m_s2, kind.braking)
    return plain(stopping_distance)(speed_m_s, retardation_m_s2, options)


def _meets(
    speed_m_s: float, distance_m: float, limit_m_s: float, kind: TrainType, options: Options
) -> bool:
    """Whether a train that brakes with all it may is slow enough at a limit ahead."""
    retardation_m_s2 = kind.highest_retardation_m_s2
    if options.motion == MotionModel.CONTINUOUS:
        excess = plain(braking_square)(speed_m_s, retardation_m_s2, kind.braking)
        excess -= plain(braking_square)(limit_m_s, retardation_m_s2, kind.braking)
        return excess <= 2.0 * retardation_m_s2 * distance_m
    slowest = max(0.0, speed_m_s - retardation_m_s2 * options.step_s)
    return can_meet_limit(
        speed_m_s, slowest, distance_m, limit_m_s, retardation_m_s2, options.step_s, UNIFORM
    )
