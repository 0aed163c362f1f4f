"""The equipment of a scenario that has a rating, and the load of each over a run."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from tpss.model.contact_line import LineLayout
from tpss.model.feeding import feedings_of
from tpss.model.outages import layout_of
from tpss.model.rated import rated_sections, rated_transformers
from tpss.model.supply import NOTHING_PARTED, layouts_of
from tpss.model.supply_plan import CONTACT_LINE, TRANSFORMER, SupplyPlan
from tpss.physics.motor import MOTORS_OF_LOCOMOTIVE
from tpss.results.grid_side import characteristic_of, powers_of_types
from tpss.results.standards.windows import Floats
from tpss.results.thermal.body import Body, body_of
from tpss.scenario.rating import Rating
from tpss.scenario.scenario import Scenario
from tpss.scenario.supply import (
    ConverterStation,
    MixedStation,
    RectifierStation,
    Supply,
    TransformerStation,
)
from tpss.scenario.supply.transformers import feeding_positions_km
from tpss.units import si

CONVERTER, RECTIFIER, MOTORS = "converter", "rectifier", "motors"
KINDS = (CONTACT_LINE, TRANSFORMER, CONVERTER, RECTIFIER, MOTORS)
"""Kinds of equipment."""


@dataclass(frozen=True)
class Readings:
    """What is recorded of a run.

    Attributes
    ----------
    of : callable
        Gives what is recorded by its name, shape (steps, whatever there is one of), NaN of trains that
        are not on the line.
    trains : sequence of (str, str)
        Names of the trains, and of their services.
    """

    of: Callable[[str], Floats]
    trains: Sequence[tuple[str, str]]


class Reach(NamedTuple):
    """A part of a line, or of one of its tracks, whose trains load a piece of equipment."""

    line: int
    from_m: float
    to_m: float
    track: int | None = None
    """None: all of them."""


@dataclass(frozen=True)
class Element:
    """A piece of equipment with a rating.

    Attributes
    ----------
    name, kind : str
    line : int
        Index of its line; -1: it is on a train.
    position_km : float
        NaN: it is on a train.
    body : Body
    reach : tuple of Reach
        Where the trains are that load it.
    train : int
        Index of the train that it is on; -1: none.
    """

    name: str
    kind: str
    line: int
    position_km: float
    body: Body
    reach: tuple[Reach, ...] = ()
    train: int = -1


Loaded = tuple[Element, Floats]
"""A piece of equipment, and its load in each step, NaN where it is not there. [1]"""

RATED_STATIONS: dict[type, tuple[str, Callable[[Any], Any]]] = {
    ConverterStation: (CONVERTER, lambda station: station.type.rating),
    TransformerStation: (TRANSFORMER, lambda station: station.transformer.rating),
    RectifierStation: (RECTIFIER, lambda station: station.type.rating),
}
"""What a station's units are, and where their rating stands, if it has units of one type."""


def has_ratings(scenario: Scenario) -> bool:
    """Whether anything in a scenario has a rating."""
    supply = scenario.supply
    high_voltage = supply.high_voltage_line
    given: list[Any] = [supply.catenary.rating]
    given += [each.catenary.rating for each in supply.contact_lines if each.catenary is not None]
    given += [_rating_of_station(station) for station in supply.stations]
    given += [kind.rating for kind in supply.converters_in_use]
    given += [train.motor_rating for train in scenario.trains.values()]
    if high_voltage is not None:
        given += [high_voltage.line_transformer.rating, high_voltage.station_transformer.rating]
    return any(each is not None for each in given)


def rated_elements(readings: Readings, scenario: Scenario) -> list[Loaded]:
    """Everything in a run that has a rating, with its load in each step."""
    laid = layout_of(scenario, scenario.outage)
    where = _Feeding.of(laid.supply, layouts_of(scenario.lines_by_name))
    current_a = np.nan_to_num(readings.of("branch_current"))
    return [
        *_stations(readings, scenario, where),
        *_transformers(current_a, laid.plan, where),
        *_contact_lines(current_a, laid.plan, where),
        *_motors(readings, scenario),
    ]


class _Feeding(NamedTuple):
    """A supply with the places where it feeds the lines."""

    supply: Supply
    lines: tuple[LineLayout, ...]
    stations_km: list[dict[str, float]]
    """Of each line: its feeding stations and their places on it."""
    feeds_km: list[list[float]]
    """Of each line: places where it is fed, and its ends, in order."""

    @classmethod
    def of(cls, supply: Supply, lines: tuple[LineLayout, ...]) -> "_Feeding":
        feedings = feedings_of(supply, lines, NOTHING_PARTED)
        stations = [
            {f.station.name: f.places_km[line.name] for f in feedings if line.name in f.places_km}
            for line in lines
        ]
        high_voltage = supply.high_voltage_line
        feeds_km = []
        for line, own in zip(lines, stations, strict=True):
            places = {line.begin_km, line.end_km, *own.values()}
            if high_voltage is not None and line.holds(high_voltage.line):
                places.update(feeding_positions_km(supply))
            feeds_km.append(sorted(places))
        return cls(supply, lines, stations, feeds_km)

    def around(self, line: int, from_km: float, to_km: float, track: int | None = None) -> Reach:
        """What lies between the feeding points that are next to a part of a line, or at its ends."""
        places = self.feeds_km[line]
        touching = [
            (one, other) for one, other in pairwise(places) if one <= from_km and to_km <= other
        ]
        begin_km = min((one for one, _ in touching), default=from_km)
        end_km = max((other for _, other in touching), default=to_km)
        return Reach(line, begin_km * 1e3, end_km * 1e3, track)


def _rating_of_station(station: Any) -> Any:
    """Rating of the units of a station; None where they have none."""
    _, rating = RATED_STATIONS.get(type(station), ("", lambda _: None))
    return rating(station)


def _stations(readings: Readings, scenario: Scenario, where: _Feeding) -> Iterator[Loaded]:
    """Units of feeding stations: those that run share the load, and one that runs is judged."""
    loading = np.nan_to_num(readings.of("converter_loading"))
    for s, station in enumerate(scenario.supply.stations):
        home = next(line.number for line in where.lines if line.holds(station.line))
        reach = tuple(
            where.around(line, own[station.name], own[station.name])
            for line, own in enumerate(where.stations_km)
            if station.name in own
        )
        if isinstance(station, MixedStation):
            found = _types(readings, s, station)
        else:
            kind, _ = RATED_STATIONS.get(type(station), ("", None))
            load = loading[:, s]
            if isinstance(station, RectifierStation):
                load = _of_rectifiers(readings, s, station)
            found = [(f"{kind} of {station.name}", _rating_of_station(station), load)]
        for name, rating, load in found:
            kind = name.partition(" ")[0]
            if rating is not None:
                body, km = body_of(rating), station.position_km
                yield Element(name, kind, home, km, body, reach), load


def _of_rectifiers(readings: Readings, s: int, station: RectifierStation) -> Floats:
    """Current of each group that runs, over its rated one. [1]"""
    power_w, running = (
        np.nan_to_num(readings.of(name)[:, s])
        for name in ("station_active_power", "active_converters")
    )
    group = characteristic_of(station.type, station.type.rated_current_a)
    return np.where(running > 0.0, group.loading(power_w / np.maximum(running, 1.0)), 0.0)


def _types(
    readings: Readings, s: int, station: MixedStation
) -> list[tuple[str, Rating | None, Floats]]:
    """Name, rating and load of one converter of each type of a station."""
    powers_va = readings.of("station_active_power") + 1j * readings.of("station_reactive_power")
    shared = powers_of_types(np.nan_to_num(powers_va[:, s]), station)
    return [
        (
            f"{CONVERTER} of {station.name}, type {i}",
            units.type.rating,
            np.abs(own) / (units.converters * si(units.type, "rating_mva")),
        )
        for i, (units, own) in enumerate(zip(station.units, shared, strict=False), 1)
    ]


def _transformers(current_a: Floats, plan: SupplyPlan, where: _Feeding) -> Iterator[Loaded]:
    """Transformers of the high-voltage line, whose rated current is at the system's base voltage."""
    for each in rated_transformers(plan, where.supply):
        line, km = each.line, each.position_km
        reach, body = (where.around(line, km, km),), body_of(each.rating)
        element = Element(plan.branch_names[each.branch], TRANSFORMER, line, km, body, reach)
        yield element, current_a[:, each.branch] / each.rated_a


def _contact_lines(current_a: Floats, plan: SupplyPlan, where: _Feeding) -> Iterator[Loaded]:
    """Both ends of each section of contact line: there the currents of all its trains add up."""
    first = len(plan.branches)
    for each in rated_sections(plan, where.supply, where.lines):
        name, body = plan.section_names[each.section], body_of(each.rating)
        reach = (where.around(each.line, *each.ends_km, each.track),)
        for k, (km, end) in enumerate(zip(each.ends_km, ("start", "end"), strict=True)):
            element = Element(f"{name}, {end}", CONTACT_LINE, each.line, km, body, reach)
            yield element, current_a[:, first + 2 * each.section + k] / each.rated_a


def _motors(readings: Readings, scenario: Scenario) -> Iterator[Loaded]:
    """Motors of each train: all of them alike, of which one is judged."""
    trains = scenario.trains_by_service()
    if all(train.motor_rating is None for train in scenario.trains.values()):
        return
    current_a = np.ascontiguousarray(readings.of("motor_current").T)  # a train is read at a time
    known = [bool(np.isfinite(own).any()) for own in current_a]
    for i, (name, service) in enumerate(readings.trains):
        train = trains[service]
        if train.motor_rating is None or not known[i]:
            continue
        motors = MOTORS_OF_LOCOMOTIVE if train.motor_current == "former" else 1.0
        body = body_of(train.motor_rating)
        element = Element(f"{MOTORS} of {name}", MOTORS, -1, float("nan"), body, train=i)
        yield element, current_a[i] / (motors * train.motor_rating.continuous_a)
