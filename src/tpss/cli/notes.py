"""What is not a fault of a scenario, but may not be what its author intended."""

import math
from collections.abc import Iterator

import numpy as np

from tpss.kernel import plain
from tpss.model.effort_curve import adhesion
from tpss.physics.running_resistance import gradient_force
from tpss.scenario import Scenario
from tpss.scenario.line import Line
from tpss.scenario.rolling_stock import Train
from tpss.scenario.traffic import Traffic
from tpss.units import si

WHOLE = 1e-6
"""A time this close to a whole number of steps, in steps, is one."""


def notes(scenario: Scenario) -> list[str]:
    """Remarks in the order of the file."""
    return [
        *_profile(scenario.line),
        *_supply(scenario),
        *_voltage_limits(scenario),
        *_trains(scenario),
        *(note for i, entry in enumerate(scenario.traffic) for note in _times(scenario, i, entry)),
        *(note for i, entry in enumerate(scenario.traffic) for note in _climb(scenario, i, entry)),
    ]


def _profile(line: Line) -> Iterator[str]:
    first, last = line.gradients[0].from_km, line.gradients[-1].from_km
    if first > 0.0:
        yield f"line.gradients begins at {first:g} km; its first gradient applies from 0 km on"
    if last > line.length_km:
        yield f"line.gradients continues to {last:g} km, but the line ends at {line.length_km:g} km"
    for i, limit in enumerate(line.speed_limits):
        if limit.from_km >= line.length_km:
            yield (
                f"line.speed_limits.{i} begins at {limit.from_km:g} km, where the line has ended "
                f"({line.length_km:g} km)"
            )


def _supply(scenario: Scenario) -> Iterator[str]:
    for i, station in enumerate(scenario.supply.converter_stations):
        if station.control == "loading" and station.converters == 1:
            yield (
                f'supply.converter_stations.{i}: control = "loading" has nothing to switch with one '
                "converter, which always runs"
            )


def _voltage_limits(scenario: Scenario) -> Iterator[str]:
    limits = scenario.standards.voltage_limits
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
    slowest = min(limit.speed_kmh for limit in scenario.line.speed_limits)
    for name, train in scenario.trains.items():
        if name not in used:
            yield f"trains.{name} is used by no traffic entry"
        if train.max_speed_kmh < slowest:
            yield (
                f"trains.{name}: its max_speed_kmh of {train.max_speed_kmh:g} is below every speed "
                f"limit of the line (the lowest is {slowest:g} km/h)"
            )


def _times(scenario: Scenario, i: int, entry: Traffic) -> Iterator[str]:
    step, duration = scenario.simulation.time_step_min, scenario.simulation.duration_min
    departures = entry.departures_min or (entry.first_departure_min,)
    key = f"traffic.{i} ({entry.name})"
    if duration is not None and departures[0] >= duration:
        yield (
            f"{key}: its first departure, at {departures[0]:g} min, is not before the end of the "
            f"run, at {duration:g} min"
        )
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


def _climb(scenario: Scenario, i: int, entry: Traffic) -> Iterator[str]:
    """The steepest place of a service's route, if its train could not start there."""
    position_km = {station.name: station.position_km for station in scenario.line.stations}
    ends_km = position_km[entry.origin], position_km[entry.destination]
    route = scenario.line.gradients_between(*ends_km)
    start_km, end_km, permille = max(route, key=lambda piece: piece[2])
    train = scenario.trains[entry.train]
    needed_kn = _starting_force_n(train, permille) / 1e3
    available_kn = float(adhesion(train, np.zeros(1), scenario.simulation)[0]) / 1e3
    if needed_kn > available_kn:
        yield (
            f"traffic.{i} ({entry.name}): between {start_km:g} and {end_km:g} km the gradient is "
            f"{permille:g} ‰, on which {entry.train} needs {needed_kn:.0f} kN to start; "
            f"{_rails(train, scenario)} allow {available_kn:.0f} kN"
        )


def _rails(train: Train, scenario: Scenario) -> str:
    return f"{scenario.simulation.rail} rails" if train.adhesion is None else "the rails"


def _starting_force_n(train: Train, permille: float) -> float:
    """Rolling resistance at standstill, and gravity."""
    return si(train, "resistance_a_n") + plain(gradient_force)(si(train, "mass_t"), permille * 1e-3)
