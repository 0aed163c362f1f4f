"""Inputs of a case, computed from its scenario, from which an approximator can learn."""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

from tpss.scenario.fields import library_name
from tpss.scenario.scenario import Scenario
from tpss.scenario.supply import Station
from tpss.scenario.supply.transformers import transformer_positions_km
from tpss.sweep.gradients import gradient_statistics
from tpss.sweep.route import route_of


class Inputs(NamedTuple):
    """Inputs of a case.  Of the trains, those of the first traffic entry are described.

    Gradients, limits and stations between which it is steep are those of the line; of a network, or of a
    train that turns round, those of the studied train's route.
    """

    length_km: float
    """Of all lines."""
    route_km: float
    """Route of the studied train."""
    stops: int
    converter_stations: int
    station_distance_km: float
    """Mean distance between neighbouring feeding stations of a line; NaN for a single one."""
    longest_station_distance_km: float
    converters: int
    """Installed, in all stations."""
    converters_per_station: float
    converter_rating_mva: float
    """Of all installed converters."""
    catenary: str
    """Name in the library, or own."""
    catenary_r_ohm_per_km: float
    catenary_x_ohm_per_km: float
    connection_x_ohm: float
    """Between a feeding point and the line; 0 of a BT system."""
    high_voltage_line: bool
    transformers: int
    """Between the stations."""
    feeding_distance_km: float
    """Mean distance between neighbouring feeding points."""
    headway_min: float
    """NaN if departures are listed."""
    trains_per_h: float
    """Of all services with a headway."""
    listed_trains: int
    """Trains with listed departures, those of timetables among them."""
    speed_limit_kmh: float
    """Highest on the route of the studied train, by the line and the train itself."""
    mean_speed_limit_kmh: float
    train_mass_t: float
    max_motor_current_a: float
    """NaN for a train without this limit."""
    gradient_mean_permille: float
    gradient_std_permille: float
    """Standard deviation over the line."""
    steepest_permille: float
    """Steepest rise."""
    starting_gradient_permille: float
    """Mean over the first 2 km of the studied train's route."""
    gradient_trend_permille: float
    """Rise of the straight line through the gradients, from the line's beginning to its end."""
    gradient_middle_permille: float
    """How much steeper it is far from feeding stations than on average; NaN for a single one."""
    time_step_min: float
    """NaN as long as it is not chosen."""


def inputs_of(scenario: Scenario) -> Inputs:
    """Inputs of a scenario."""
    supply, first = scenario.supply, scenario.traffic[0]
    train, catenary = scenario.trains[first.train], supply.catenary
    line, begin_km, end_km, stations_km = route_of(scenario)
    transformers_km = transformer_positions_km(supply)
    converters = [station.installed for station in supply.stations]
    ratings = [station.installed * station.unit_mva for station in supply.stations]
    headways = [entry.headway_min for entry in scenario.traffic if entry.headway_min is not None]
    listed = [entry.listed_departures_min or () for entry in scenario.traffic]
    limits = [
        (end - begin, min(speed, train.max_speed_kmh))
        for begin, end, speed in line.speed_limits_between(begin_km, end_km)
    ]
    gradients = gradient_statistics(line, begin_km, end_km, stations_km)
    stations = _by_line(scenario, supply.stations)
    feeding = _by_line(scenario, supply.stations, transformers_km)
    return Inputs(
        length_km=sum(each.length_km for each in scenario.lines_by_name.values()),
        route_km=end_km - begin_km,
        stops=len(first.stops),
        converter_stations=len(supply.stations),
        station_distance_km=_mean_distance(stations),
        longest_station_distance_km=max(
            (b - a for places_km in stations for a, b in pairwise(places_km)), default=math.nan
        ),
        converters=sum(converters),
        converters_per_station=sum(converters) / len(converters),
        converter_rating_mva=math.fsum(ratings),
        catenary=library_name("catenaries", catenary),
        catenary_r_ohm_per_km=catenary.r_ohm_per_km,
        catenary_x_ohm_per_km=catenary.x_ohm_per_km,
        connection_x_ohm=catenary.connection_x_ohm,
        high_voltage_line=supply.high_voltage_line is not None,
        transformers=len(transformers_km),
        feeding_distance_km=_mean_distance(feeding),
        headway_min=_or_nan(first.headway_min),
        trains_per_h=sum(60.0 / headway for headway in headways),
        listed_trains=sum(map(len, listed)),
        speed_limit_kmh=max(speed for _, speed in limits),
        mean_speed_limit_kmh=sum(km * speed for km, speed in limits) / (end_km - begin_km),
        train_mass_t=train.mass_t,
        max_motor_current_a=_or_nan(train.max_motor_current_a),
        gradient_mean_permille=gradients.mean,
        gradient_std_permille=gradients.deviation,
        steepest_permille=gradients.steepest,
        starting_gradient_permille=gradients.starting,
        gradient_trend_permille=gradients.trend,
        gradient_middle_permille=gradients.middle,
        time_step_min=_or_nan(scenario.simulation.time_step_min),
    )


def _or_nan(value: float | None) -> float:
    return math.nan if value is None else value


def _by_line(
    scenario: Scenario, stations: Sequence[Station], transformers_km: Sequence[float] = ()
) -> list[list[float]]:
    """Positions of feeding points on each line, ascending. [km]"""
    places_km: dict[str, list[float]] = {name: [] for name in scenario.lines_by_name}
    for station in stations:
        places_km[scenario.line_of(station)].append(station.position_km)
    high_voltage = scenario.supply.high_voltage_line
    if high_voltage is not None:
        places_km[scenario.line_of(high_voltage)] += transformers_km
    return [sorted(each) for each in places_km.values()]


def _mean_distance(by_line: Sequence[Sequence[float]]) -> float:
    """Mean distance between neighbours on the same line; NaN if there are none. [km]"""
    several = [places_km for places_km in by_line if len(places_km) > 1]
    if not several:
        return math.nan
    lengths = sum(places_km[-1] - places_km[0] for places_km in several)
    return lengths / sum(len(places_km) - 1 for places_km in several)
