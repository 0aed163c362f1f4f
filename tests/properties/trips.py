"""Random protection that trips stations, and the rules of it: when each trips, and what follows."""

from typing import Any

import numpy as np
from hypothesis import strategies as st

from tpss import Result, Scenario, simulate
from tpss.run.relays import Relay, Trip

from .ranges import numbers
from .ratings import with_ratings
from .types import converter_types

Draw = Any
Document = dict[str, Any]

CLOSE = 1e-6
"""Loads nearer than this to an overload, of it, are not told from it. [1]"""


def with_protection(draw: Draw, document: Document) -> None:
    """Let stations trip, some of which have converters that are weak for what they carry.

    Trains that move in steps do not go with it.
    """
    if document["simulation"].get("motion") == "stepped":
        return
    with_ratings(draw, document, least=1)
    for kind in converter_types(document):
        if "rating" in kind and "current_limit_percent" not in kind and draw(st.booleans()):
            kind["rating_mva"] = draw(numbers(0.5, 8.0))
    if any("rating" in each for each in _rated(document)):
        document["protection"] = {"trip": True}


def _rated(document: Document) -> list[Document]:
    """What may bear overloads: types of converters, and transformers of stations."""
    supply = document["supply"]
    transformers = [each["transformer"] for each in supply.get("transformer_stations", ())]
    return [*converter_types(document), *transformers]


def judge_trips(result: Result) -> None:
    """No station bears more than it may, but up to its trip; and a run with one outage is the same.

    Loads are seen at instants; before the run there was none.
    """
    if not result.scenario.protection.trip:
        return
    trips = result.summary.get("trips", [])
    names = [trip["station"] for trip in trips]
    assert len(set(names)) == len(names), "a station trips twice"
    times_min = [trip["time_min"] for trip in trips]
    assert times_min == sorted(times_min), "trips are not in the order of time"
    found = {trip["station"]: trip for trip in trips}
    for s, station in enumerate(result.scenario.supply.stations):
        judge_station(result, s, station, found.get(station.name))
    if trips:
        judge_what_follows(result)


def judge_station(result: Result, s: int, station: Any, trip: Document | None) -> None:
    """A station passes none of its overloads before the instant at which it trips, and one there."""
    data = result.dataset
    instants_min = data.time.to_numpy() / 60.0
    load = np.nan_to_num(data.converter_loading.to_numpy()[:-1, s])
    over_at_trip = False
    for percent, minutes in overloads_of(station):
        for k, until_min in enumerate(instants_min[1:]):
            if trip is not None and until_min > trip["time_min"] + 1e-6:
                break
            within_min = np.diff(np.clip(instants_min, until_min - minutes, until_min))
            square = float(load[: k + 1] ** 2 @ within_min[: k + 1]) / minutes
            at_trip = trip is not None and until_min > trip["time_min"] - 1e-6
            allowed = (percent / 100.0) ** 2
            over_at_trip |= at_trip and square > allowed * (1.0 - CLOSE)
            assert at_trip or square <= allowed * (1.0 + CLOSE), (
                f"{station.name} bears more than {percent} % over {minutes} min at {until_min} min"
            )
    assert trip is None or over_at_trip, f"{station.name} trips without reason"


def trips_of(result: Result) -> list[Trip]:
    """Trips of a run, as the load flow asks for them."""
    stations = [station.name for station in result.scenario.supply.stations]
    found = []
    for each in result.summary.get("trips", []):
        station, highest = stations.index(each["station"]), each["allowed_percent"] / 100.0
        relay = Relay(station, 60.0 * each["window_min"], highest)
        found.append(Trip(station, 60.0 * each["time_min"], each["load_percent"] / 100.0, relay))
    return found


def overloads_of(station: Any) -> list[tuple[float, float]]:
    """What a station bears and for how long. [%], [min]"""
    kinds = [getattr(station, "type", None), getattr(station, "transformer", None)]
    ratings = [kind.rating for kind in kinds if kind is not None and kind.rating is not None]
    return [(each.percent, each.minutes) for rating in ratings for each in rating.overloads]


def judge_what_follows(result: Result) -> None:
    """Up to the second trip, all is as in a run without protection in which the first one is an outage.

    Not where there is an outage already, which has times of its own.
    """
    scenario, trips = result.scenario, result.summary["trips"]
    if scenario.outage is not None or trips[0]["time_min"] >= result.summary["duration_min"]:
        return
    document = scenario.as_document()
    first = {"name": "first", "stations": [trips[0]["station"]], "from_min": trips[0]["time_min"]}
    document |= {"protection": {"trip": False}, "outages": [first]}
    document["simulation"]["outage"] = "first"
    other = simulate(Scenario.from_document(document, "without protection"))
    steps = min(result.dataset.sizes["time"], other.dataset.sizes["time"]) - 1
    if len(trips) > 1:
        until_s = 60.0 * trips[1]["time_min"]
        steps = min(steps, int(np.searchsorted(result.dataset.time, until_s - 1e-3)))
    else:
        assert other.status == result.status
    for name in ("position", "pantograph_voltage", "station_active_power", "converter_loading"):
        one, again = (each.dataset[name].to_numpy()[:steps] for each in (result, other))
        trains = slice(0, min(one.shape[1], again.shape[1]))
        assert np.array_equal(one[:, trains], again[:, trains], equal_nan=True), name
