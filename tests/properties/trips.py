"""Random protection that trips stations, and the rules of it: when each trips, and what follows."""

from typing import Any

import numpy as np
from hypothesis import strategies as st

from tpss import Result, Scenario, simulate
from tpss.model import build_model
from tpss.model.outages import layout_of
from tpss.model.rated import rated_sections, rated_transformers
from tpss.model.start import start_of
from tpss.model.supply import layouts_of
from tpss.results.thermal.elements import Element
from tpss.run.relays import Trip

from .ranges import numbers
from .ratings import with_ratings
from .types import converter_types

Draw = Any
Document = dict[str, Any]

CLOSE = 1e-6
"""Loads nearer than this to an overload, of it, are not told from it. [1]"""


def with_protection(draw: Draw, document: Document) -> None:
    """Let equipment trip: stations, some of which have converters that are weak for what they carry,
    transformers and sections of contact line.

    Trains that move in steps do not go with it.
    """
    if document["simulation"].get("motion") == "stepped":
        return
    with_ratings(draw, document, least=1)
    for kind in converter_types(document):
        if "rating" in kind and "current_limit_percent" not in kind and draw(st.booleans()):
            kind["rating_mva"] = draw(numbers(0.5, 8.0))
    if any("rating" in each for each in _protected(document)):
        document["protection"] = {"trip": True}


def _protected(document: Document) -> list[Document]:
    """Tables of all that may have overloads, as far as they are tables."""
    supply = document["supply"]
    transformers = [each["transformer"] for each in supply.get("transformer_stations", ())]
    high_voltage = supply.get("high_voltage_line", {})
    others = [
        supply["catenary"],
        *map(high_voltage.get, ("line_transformer", "station_transformer")),
    ]
    tables = [each for each in others if isinstance(each, dict)]
    return [*converter_types(document), *transformers, *tables]


def judge_trips(result: Result) -> None:
    """Nothing bears more than it may, but up to its trip; and a run with one outage is the same.

    Loads are seen at instants; before the run there was none.
    """
    if not result.scenario.protection.trip:
        return
    trips = result.summary.get("trips", [])
    names = [trip["element"] for trip in trips]
    assert len(set(names)) == len(names), "something trips twice"
    times_min = [trip["time_min"] for trip in trips]
    assert times_min == sorted(times_min), "trips are not in the order of time"
    found = {trip["element"]: trip for trip in trips}
    over_at_trip = set()
    own = result.equipment
    for element, load in zip(own.elements, own.load.T, strict=True):
        name = protected(element)
        if name and judge_element(result, element, np.nan_to_num(load), found.get(name)):
            over_at_trip.add(name)
    assert over_at_trip == set(names), "something trips without reason"
    if trips:
        judge_what_follows(result)


def protected(element: Element) -> str:
    """What trips if a piece of equipment bears too much; nothing of motors, which do not."""
    name = element.name
    if element.kind == "contact line":
        return name.rpartition(", ")[0]
    return "" if element.train >= 0 else name.rpartition(" of ")[2].partition(", type ")[0]


def judge_element(result: Result, element: Element, load: Any, trip: Document | None) -> bool:
    """Equipment passes none of its overloads before the instant at which it trips; whether one there."""
    instants_min = result.dataset.time.to_numpy() / 60.0
    over_at_trip = False
    for allowed, lasts_s in element.body.overloads:
        minutes = lasts_s / 60.0
        for k, until_min in enumerate(instants_min[1:]):
            if trip is not None and until_min > trip["time_min"] + 1e-6:
                break
            within_min = np.diff(np.clip(instants_min, until_min - minutes, until_min))
            square = float(load[: k + 1] ** 2 @ within_min[: k + 1]) / minutes
            at_trip = trip is not None and until_min > trip["time_min"] - 1e-6
            over_at_trip |= at_trip and square > allowed**2 * (1.0 - CLOSE)
            assert at_trip or square <= allowed**2 * (1.0 + CLOSE), (
                f"{element.name} bears more than {allowed} over {minutes} min at {until_min} min"
            )
    return over_at_trip


def trips_of(result: Result) -> list[Trip]:
    """Trips of a run, as the load flow asks for them."""
    model, _ = build_model(result.scenario)
    relays = start_of(result.scenario, model).relays
    known = {relay.protected.name: relay for relay in relays}
    found = []
    for each in result.summary.get("trips", []):
        relay = known[each["element"]]
        load = each["load_percent"] / 100.0
        found.append(Trip(relay.protected, 60.0 * each["time_min"], load, relay))
    return found


def judge_what_follows(result: Result) -> None:
    """Up to the second trip, all is as in a run without protection in which the first one is an outage.

    Not where there is an outage already, which has times of its own.  Contact lines that may trip have
    further nodes, and so other roundings.
    """
    scenario, trips = result.scenario, result.summary["trips"]
    if scenario.outage is not None or trips[0]["time_min"] >= result.summary["duration_min"]:
        return
    document = scenario.as_document()
    document |= {"protection": {"trip": False}, "outages": [outage_of(scenario, trips[0])]}
    document["simulation"]["outage"] = "first"
    other = simulate(Scenario.from_document(document, "without protection"))
    steps = min(result.dataset.sizes["time"], other.dataset.sizes["time"]) - 1
    if len(trips) > 1:
        until_s = 60.0 * trips[1]["time_min"]
        steps = min(steps, int(np.searchsorted(result.dataset.time, until_s - 1e-3)))
    else:
        assert other.status == result.status
    exact = result.dataset.sizes["node"] == other.dataset.sizes["node"]
    for name in ("position", "pantograph_voltage", "station_active_power", "converter_loading"):
        one, again = (each.dataset[name].to_numpy()[:steps] for each in (result, other))
        trains = slice(0, min(one.shape[1], again.shape[1]))
        if exact:
            assert np.array_equal(one[:, trains], again[:, trains], equal_nan=True), name
        else:
            scale = np.nanmax(np.abs(one), initial=1.0)
            np.testing.assert_allclose(
                one[:, trains], again[:, trains], rtol=0.0, atol=1e-5 * scale
            )


def outage_of(scenario: Scenario, trip: Document) -> Document:
    """The outage that takes out from a time on what has tripped."""
    name, laid = trip["element"], layout_of(scenario, None)
    lines = layouts_of(scenario.lines_by_name)
    found: Document = {"name": "first", "from_min": trip["time_min"]}
    if name in [station.name for station in scenario.supply.stations]:
        return {**found, "stations": [name]}
    for each in rated_transformers(laid.plan, laid.supply):
        if laid.plan.branch_names[each.branch] == name:
            return {**found, "transformers_km": [each.position_km]}
    for section in rated_sections(laid.plan, laid.supply, lines):
        if laid.plan.section_names[section.section] == name:
            begin_km, end_km = (_place(km, laid.plan.node_km) for km in section.ends_km)
            cut: Document = {"from_km": begin_km, "to_km": end_km}
            cut |= {} if section.track is None else {"track": section.track}
            cut |= {"line": lines[section.line].name} if len(lines) > 1 else {}
            return {**found, "sections": [cut]}
    raise AssertionError(f"nothing is named {name}")


def _place(km: float, places_km: list[float]) -> float:
    """A place as it is written, which is the same but for a rounding. [km]"""
    return min(places_km, key=lambda place_km: abs(place_km - km))
