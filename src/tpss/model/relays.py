"""Relays of a scenario's feeding stations: the overloads that their units bear."""

from tpss.errors import Finding, ScenarioError
from tpss.run.relays import Relay
from tpss.scenario.rating import Overload
from tpss.scenario.scenario import Scenario
from tpss.scenario.supply import ConverterStation, Station, TransformerStation


def relays_of(scenario: Scenario) -> tuple[Relay, ...]:
    """What each station bears over which windows, if stations trip; none otherwise.

    Raises
    ------
    ScenarioError
        Stations are to trip, and none has overloads in the rating of its units.
    """
    if not scenario.protection.trip:
        return ()
    relays = tuple(
        Relay(number, 60.0 * overload.minutes, overload.percent / 100.0)
        for number, station in enumerate(scenario.supply.stations)
        for overload in _overloads(station)
    )
    if not relays:
        problem = "no feeding station has a rating with overloads, so none trips"
        remedy = (
            "give rating.overloads of a type of converters or of a transformer, or leave it out"
        )
        raise ScenarioError(
            [Finding(scenario.given_source, "protection.trip", "true", problem, remedy)]
        )
    return relays


def _overloads(station: Station) -> tuple[Overload, ...]:
    if isinstance(station, ConverterStation) and station.type.rating is not None:
        return station.type.rating.overloads
    if isinstance(station, TransformerStation) and station.transformer.rating is not None:
        return station.transformer.rating.overloads
    return ()
