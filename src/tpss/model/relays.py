"""Relays of a scenario's supply: the overloads that stations, transformers and contact lines bear."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from tpss.errors import Finding, ScenarioError
from tpss.model.outages import Laid, layout_of, service_of
from tpss.model.rated import rated_sections, rated_transformers
from tpss.model.supply import layouts_of
from tpss.run.relays import Protected, Relay, Trip
from tpss.run.start import Start
from tpss.run.switching import Switching
from tpss.scenario.outages import Outage
from tpss.scenario.rating import Rating, TransformerRating
from tpss.scenario.scenario import Scenario
from tpss.scenario.supply import (
    ConverterStation,
    MixedStation,
    RectifierStation,
    TransformerStation,
)
from tpss.units import si


def with_relays(start: Start, scenario: Scenario, outage: Outage | None) -> Start:
    """The start of a run with an outage, or none, in which what passes its overloads trips if asked.

    Raises
    ------
    ScenarioError
        Equipment is to trip, and none has overloads in its rating.
    """
    if not scenario.protection.trip:
        return start
    laid = layout_of(scenario, outage)
    relays = (*station_relays(scenario), *_transformers(laid), *_sections(laid, scenario))
    if not relays:
        problem = "nothing of the supply has a rating with overloads, so nothing trips"
        remedy = (
            "give rating.overloads of a type of converters or rectifiers, of a transformer or catenary, "
            "or leave it out"
        )
        raise ScenarioError(
            [Finding(scenario.given_source, "protection.trip", "true", problem, remedy)]
        )

    def cut(trips: Sequence[Trip]) -> tuple[Switching, ...]:
        return service_of(scenario, outage, trips).switchings

    return replace(start, relays=relays, cut=cut)


def station_relays(scenario: Scenario) -> Iterator[Relay]:
    """Relays of feeding stations, which trip as a whole."""
    for number, station in enumerate(scenario.supply.stations):
        protected = Protected(station.name, station=number)
        if isinstance(station, MixedStation):
            for i, units in enumerate(station.units):
                rated_va = units.converters * si(units.type, "rating_mva")
                yield from (
                    relay._replace(type_number=i, rated_va=rated_va)
                    for relay in _relays(protected, units.type.rating)
                )
        elif isinstance(station, ConverterStation):
            yield from _relays(protected, station.type.rating)
        elif isinstance(station, TransformerStation):
            yield from _relays(protected, station.transformer.rating)
        elif isinstance(station, RectifierStation):
            current_a, voltage_kv = zip(*station.type.points, strict=True)
            yield from (
                relay._replace(
                    rated_a=station.type.rated_current_a,
                    group_current_a=current_a,
                    group_voltage_v=tuple(kv * 1e3 for kv in voltage_kv),
                )
                for relay in _relays(protected, station.type.rating)
            )


def _transformers(laid: Laid) -> Iterator[Relay]:
    """Relays of the transformers of the high-voltage line."""
    for each in rated_transformers(laid.plan, laid.supply):
        protected = Protected(laid.plan.branch_names[each.branch], transformer=each.branch)
        yield from (
            relay._replace(current=each.branch, rated_a=each.rated_a)
            for relay in _relays(protected, each.rating)
        )


def _sections(laid: Laid, scenario: Scenario) -> Iterator[Relay]:
    """Relays at both ends of each section of contact line."""
    plan, lines = laid.plan, layouts_of(scenario.lines_by_name)
    for each in rated_sections(plan, laid.supply, lines):
        protected = Protected(plan.section_names[each.section], section=each.section)
        first = len(plan.branches) + 2 * each.section
        yield from (
            relay._replace(current=first + end, rated_a=each.rated_a)
            for relay in _relays(protected, each.rating)
            for end in (0, 1)
        )


def _relays(protected: Protected, rating: Rating | TransformerRating | None) -> Iterator[Relay]:
    """Relays for the overloads of a rating."""
    for each in () if rating is None else rating.overloads:
        yield Relay(protected, 60.0 * each.minutes, each.percent / 100.0)
