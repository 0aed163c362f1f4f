"""The cases of a table of outages: the intact supply, the scenario's outages, every single element."""

from collections.abc import Iterator

from tpss.errors import Finding, ScenarioError
from tpss.scenario.outages import SWITCHES, Outage, OutAutotransformer
from tpss.scenario.scenario import Scenario
from tpss.scenario.supply.feeds import feeds_of, places_on
from tpss.scenario.supply.mixed_station import MixedStation
from tpss.scenario.supply.transformers import feeding_positions_km
from tpss.units import kilometres


def outages_of(scenario: Scenario, every: bool) -> list[Outage]:
    """Outages of a table: those of the scenario, and if asked for each of a single element.

    A single one that the scenario has already, under a name of its own, is not made again; beside one of
    its name, which is out for a time only, or more, it says that it is out throughout.

    Raises
    ------
    ScenarioError
        There is none.
    """
    named = list(scenario.outages)
    if every:
        known, names = [_content(outage) for outage in named], [outage.name for outage in named]
        for each in single_outages(scenario):
            if _content(each) not in known:
                name = f"{each.name}, throughout" if each.name in names else each.name
                named.append(each.model_copy(update={"name": name}))
    if not named:
        problem = "the scenario has no outages"
        remedy = "add [[outages]], or take every single element with --n-1"
        raise ScenarioError([Finding(scenario.given_source, "outages", "", problem, remedy)])
    return named


def single_outages(scenario: Scenario) -> Iterator[Outage]:
    """Each station, each with one unit fewer if it has several alike, and each other single element.

    These are transformers, autotransformers, stores of energy at the line, and switches.

    Of the feeds those of stations with more than one: a single one is as much as its station.  The
    contact line is left out, which rules of n-1 exempt, as those of Bane NOR do (TRV:03191).
    """
    stations = scenario.supply.stations
    for station in stations:
        yield Outage(name=f"{station.name} out", stations=(station.name,))
    for station in stations:
        if station.installed > 1 and not isinstance(station, MixedStation):
            yield Outage(name=f"{station.name}, one unit out", units={station.name: 1})
    for km in feeding_positions_km(scenario.supply):
        yield Outage(name=f"transformer {kilometres(km)} km out", transformers_km=(km,))
    for each in scenario.supply.autotransformers:
        for km in each.positions_km:
            out = OutAutotransformer(line=each.line, position_km=km)
            yield Outage(name=f"{out.in_words} out", autotransformers=(out,))
    for store in scenario.supply.storage:
        yield Outage(name=f"store {store.name} out", storage=(store.name,))
    for kind in SWITCHES:
        for switch in getattr(scenario.supply, kind):
            if switch.closed:
                yield Outage(name=f"{switch.name} open", opens=(switch.name,))
    places = places_on(scenario.lines_by_name)
    for station in stations:
        feeds = list(feeds_of(station, places))
        for feed in feeds if len(feeds) > 1 else ():
            yield Outage(name=f"{feed.name} open", opens=(feed.name,))


def _content(outage: Outage) -> dict[str, object]:
    """What is out, and when."""
    return outage.model_dump(exclude={"name"})
