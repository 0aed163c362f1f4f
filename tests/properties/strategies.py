"""Random scenarios: sound ones of every kind, and ones that are spoilt.

Numbers are drawn from a coarse grid as often as not, so that things coincide: a limit at a stop, a
train at a node, a dwell of a whole number of steps.  Sizes are bounded so that a run takes some
hundred steps with a dozen trains.
"""

import copy
import math
from random import Random
from typing import Any

from hypothesis import strategies as st

from .bounds import with_bounds
from .conductors import of_25_kv_or_direct, take_apart
from .direct import into_direct_current
from .electric_brakes import with_electric_brakes
from .feeding import CONVERTER_STATIONS, OWN_CATENARIES, UNLIKE_STATIONS, transformer_stations
from .given_tracks import give_tracks
from .kilometres import moved
from .load_curves import give_curves_over_load
from .losses import with_losses
from .machines import EMUS, ODD_TRAINS, TRAINS
from .mixed import with_mixed_stations
from .networks import into_network
from .neutral import with_neutral_section
from .outages import outages, take_parts_out
from .ranges import numbers
from .ratings import with_ratings
from .single_tracks import with_single_tracks
from .spare_time import with_spare_time
from .trips import with_protection

Draw = Any
Document = dict[str, Any]
Path = tuple[str | int, ...]

MOST_STEPS = 150
MOST_TRAINS = 12
STEPS = st.sampled_from([60.0, MOST_STEPS, 20.3, 99.999, 5.0, 1.0])
"""Length of a run; what is listed first is drawn most often."""
STEPS_MIN = [0.01, 0.02, 0.05, 0.1, 0.25, 0.3, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 0.001, 0.004]


@st.composite
def places_km(draw: Draw, length_km: float, least: int, most: int) -> list[float]:
    """Different places on a line, unsorted; perhaps the first two only metres apart."""
    places = draw(st.lists(numbers(0.0, length_km), min_size=least, max_size=most, unique=True))
    near = draw(st.sampled_from([0.0, 0.0, 0.001, 0.01, 0.2]))
    if near and len(places) > 1 and places[0] + near <= length_km:
        places[1] = places[0] + near
    apart: list[float] = []
    for place in places:
        if all(abs(place - other) >= 0.001 for other in apart):
            apart.append(place)
    return apart if len(apart) >= least else [0.0, length_km]


@st.composite
def others_down(draw: Draw, length_km: float, speeds: st.SearchStrategy[float]) -> Document:
    """Speed limits of the other direction, on a quarter of the lines."""
    if draw(st.integers(0, 3)) < 3:
        return {}
    kms = sorted({0.0, *draw(st.lists(numbers(0.0, length_km), max_size=3))})
    return {"speed_limits_down": [{"from_km": km, "speed_kmh": draw(speeds)} for km in kms]}


@st.composite
def lines(draw: Draw) -> Document:
    """A line of 100 m to 300 km."""
    longest_km = draw(st.sampled_from([60.0, 300.0, 120.0, 20.0, 3.0, 0.3]))
    length_km = draw(numbers(longest_km / 3.0, longest_km))
    stations = draw(places_km(length_km, 2, 5))
    special = st.one_of(numbers(0.0, length_km), st.sampled_from(stations))
    steep = draw(st.sampled_from([0.0, 10.0, 10.0, 25.0, 100.0]))
    gradient_km = {0.0, *draw(st.lists(special, max_size=5))}
    limit_km = {0.0, *draw(st.lists(special, max_size=5))}
    off = draw(st.sampled_from([0.0, -0.01, -1e-6, 1e-6, 0.001, 0.02]))
    if off:  # a limit just before or behind a stop
        limit_km.add(max(0.0, draw(st.sampled_from(stations)) + off))
    speeds = numbers(5.0, draw(st.sampled_from([60.0, 100.0, 200.0])))
    return {
        "length_km": length_km,
        "gradients": [
            {"from_km": km, "permille": draw(numbers(-steep, steep))} for km in sorted(gradient_km)
        ],
        "speed_limits": [{"from_km": km, "speed_kmh": draw(speeds)} for km in sorted(limit_km)],
        **draw(others_down(length_km, speeds)),
        "stations": [{"name": f"S{i}", "position_km": km} for i, km in enumerate(stations)],
    }


@st.composite
def supplies(draw: Draw, length_km: float) -> Document:
    """One to five converter stations anywhere, perhaps a high-voltage line.

    On a third of the lines they are unlike, and a few are transformer stations.
    """
    kms = draw(places_km(length_km, 1, 5))
    stations = draw(st.sampled_from([CONVERTER_STATIONS, CONVERTER_STATIONS, UNLIKE_STATIONS]))
    by_grid = draw(st.integers(0, 1)) if draw(st.integers(0, 7)) == 7 else 0
    supply = {
        "frequency_hz": 16.7,
        "catenary": draw(st.one_of(st.sampled_from(["BT", "AT"]), OWN_CATENARIES)),
        "converter_stations": [
            {"name": f"C{i}", "position_km": km, **draw(stations)}
            for i, km in enumerate(kms[by_grid:])
        ],
        "transformer_stations": [
            {"name": f"T{i}", "position_km": km, **draw(transformer_stations((15.5, 17.0)))}
            for i, km in enumerate(kms[:by_grid])
        ],
    }
    if draw(st.booleans()):
        between = [
            km
            for km in draw(places_km(length_km, 0, 3))
            if all(abs(km - station) >= 0.001 for station in kms)
        ]
        supply["high_voltage_line"] = {"type": "132kV", "transformers_km": sorted(between)}
        gap_km = min((b - a for a, b in zip(sorted(kms), sorted(kms)[1:], strict=False)), default=0)
        if gap_km > 0.004 and draw(st.booleans()):
            supply["high_voltage_line"] = {"type": "132kV", "transformers": draw(st.integers(0, 3))}
    return supply


TIME_STEPS: Document = {
    "time_step_min": st.one_of(st.sampled_from(STEPS_MIN), numbers(0.01, 5.0), numbers(0.001, 10.0))
}
RAILS: Document = {
    "adhesion_speed_unit": st.sampled_from(["m/s", "km/h"]),
    "rail": st.sampled_from(["dry", "wet"]),
}
CONTINUOUS = st.fixed_dictionaries(
    TIME_STEPS,
    optional={
        **RAILS,
        "braking": st.just("within-step"),
        "motion": st.just("continuous"),
    },
)
STEPPED = st.fixed_dictionaries(
    {**TIME_STEPS, "motion": st.just("stepped")},
    optional={
        **RAILS,
        "power_sampling": st.sampled_from(["mean", "start"]),
        "gradient_sampling": st.sampled_from(["mean", "start"]),
        "braking": st.sampled_from(["within-step", "whole-steps"]),
    },
)
SIMULATIONS = st.one_of(CONTINUOUS, CONTINUOUS, STEPPED)


def schedule(draw: Draw, entry: Document, span_min: float) -> None:
    """Give some stops of a service scheduled times, in order, which may be too early or late."""
    calls = 2 * len(entry["stops"])
    times = iter(sorted(draw(st.lists(numbers(1e-3, span_min), min_size=calls, max_size=calls))))
    for stop in entry["stops"]:
        arrival, departure = next(times), next(times)
        if draw(st.booleans()):
            stop["arrive_after_min"] = arrival
        if draw(st.booleans()):
            stop["depart_after_min"] = departure


@st.composite
def services(draw: Draw, i: int, document: Document, span_min: float) -> Document:
    """A traffic entry between two stations, with a timetable of one kind or another."""
    stations = sorted(document["line"]["stations"], key=lambda s: s["position_km"])
    step = document["simulation"]["time_step_min"]
    if draw(st.integers(0, 2)) == 2:
        stations.reverse()
    first = draw(st.integers(0, len(stations) - 2))
    last = draw(st.integers(first + 1, len(stations) - 1))
    whole_steps = st.integers(0, MOST_STEPS).map(lambda k: k * step)
    times = st.one_of(whole_steps, numbers(0.0, span_min))
    dwell = st.one_of(st.integers(0, 4).map(lambda k: k * step), numbers(0.0, 6.0 * step))
    entry = {
        "name": f"service {i}",
        "train": draw(st.sampled_from(list(document["trains"]))),
        "from": stations[first]["name"],
        "to": stations[last]["name"],
        "stops": [
            {"station": station["name"], "dwell_min": draw(dwell)}
            for station in stations[first + 1 : last]
            if draw(st.booleans())
        ],
    }
    if draw(st.integers(0, 3)) == 3:
        schedule(draw, entry, span_min)
    kind = draw(st.sampled_from(["headway", "timetable", "already running"]))
    if kind == "timetable":
        listed = draw(st.sets(st.one_of(st.just(0.0), times), min_size=1, max_size=4))
        entry["departures_min"] = sorted(listed)
    else:
        entry["headway_min"] = max(0.01, span_min / draw(numbers(0.5, MOST_TRAINS)))
    if kind == "headway":
        entry["first_departure_min"] = draw(st.one_of(st.just(0.0), st.just(0.0), times))
    if kind == "already running":
        entry["already_running"] = True
    else:
        begin, end = stations[first]["position_km"], stations[last]["position_km"]
        speeds = st.sampled_from([0.0, 0.0, 0.001, 1.0, 4.0, 20.0])
        entry["initial_trains"] = [
            {"position_km": km, "speed_kmh": draw(speeds)}
            for km in draw(
                st.lists(
                    numbers(*sorted((begin, end))),
                    min_size=draw(st.sampled_from([3, 0])),
                    max_size=5,
                )
            )
            if km != end
        ]
    return entry


def on_25_kv(draw: Draw, document: Document) -> Document:
    """A scenario with the supply and the trains of a 25 kV, 50 Hz railway."""
    supply = document["supply"]
    stations = [
        {"name": station["name"], "position_km": station["position_km"],
         **draw(transformer_stations((25.0, 28.5)))}
        for kind in ("converter_stations", "transformer_stations") for station in supply[kind]
    ]  # fmt: skip
    return {
        **document,
        "supply": {
            "system": "25kV-50Hz",
            "catenary": draw(OWN_CATENARIES),
            "transformer_stations": stations,
        },
        "trains": {name: draw(EMUS) for name in document["trains"]},
    }


SIGNALLING = st.one_of(
    st.fixed_dictionaries(
        {"separation": st.just("moving-block")},
        optional={"margin_m": numbers(0.0, 500.0), "reaction_s": numbers(0.0, 30.0)},
    ),
    st.fixed_dictionaries(
        {"separation": st.just("fixed-block"), "block_m": numbers(100.0, 5000.0)},
        optional={"margin_m": numbers(0.0, 500.0)},
    ),
)


def moves_continuously(simulation: Document) -> bool:
    """Whether trains move continuously, which separation goes with."""
    return simulation.get("motion", "continuous") == "continuous"


BEGINNINGS_KM = st.sampled_from([False, False, False, False, True]).flatmap(
    lambda elsewhere: numbers(-300.0, 1500.0) if elsewhere else st.none()
)
"""Kilometres where a fifth of the lines begin; None for 0."""


def with_one_retardation(trains: Document) -> None:
    """Leave trains that move in steps the retardation of their lowest speeds."""
    for train in trains.values():
        given = train.get("max_retardation_m_s2")
        if isinstance(given, dict):
            train["max_retardation_m_s2"] = given["retardation_m_s2"][0]


@st.composite
def sound_scenarios(
    draw: Draw, feed_back: bool = False, direct: bool = False, network: bool = False,
    apart: bool = False,
) -> Document:  # fmt: skip
    """A scenario without faults, but for trains that may be placed too fast to stop.

    A fifth of the lines begin elsewhere than at 0, and a quarter are those of a network, or all if they
    are to be.  All trains have electric brakes if they are to feed back, and half of the equipment says
    more of itself.  A railway of direct current has the lines, the traffic and the outages of any other;
    where conductors are apart, it has rails of its own, as those of 25 kV have.
    """
    begin_km = draw(BEGINNINGS_KM)
    line = draw(lines())
    document: Document = {
        "format": 1,
        "name": "random",
        "simulation": draw(CONTINUOUS if feed_back else SIMULATIONS),
        "line": line,
        "supply": draw(supplies(line["length_km"])),
        "trains": {
            f"train {i}": draw(draw(st.sampled_from([TRAINS, TRAINS, ODD_TRAINS])))
            for i in range(draw(st.integers(1, 2)))
        },
    }
    if document["simulation"].get("motion") == "stepped":
        with_one_retardation(document["trains"])
    if draw(st.integers(0, 4)) == 4 or (apart and not direct):
        document = on_25_kv(draw, document)
    step = document["simulation"]["time_step_min"]
    span_min = step * draw(STEPS)
    slowest_kmh = min(20.0, *(limit["speed_kmh"] for limit in line["speed_limits"]))
    longest_min = line["length_km"] / slowest_kmh * 60.0
    if longest_min > 2.0 * MOST_STEPS * step or draw(st.booleans()):
        document["simulation"]["duration_min"] = span_min
    else:  # until the first train arrives, which the recording leaves ten minutes for
        span_min = longest_min + 10.0
    entries = draw(st.sampled_from([2, 1, 3]))
    document["traffic"] = [draw(services(i, document, span_min)) for i in range(entries)]
    if moves_continuously(document["simulation"]) and draw(st.integers(0, 3)) == 3:
        document["signalling"] = draw(SIGNALLING)
    document = document if begin_km is None else moved(document, begin_km)
    if draw(st.integers(0, 3)) == 3 or network:
        document = into_network(draw, document, lines())
        give_tracks(Random(repr(document)), document)  # no draw: all else is as it was without
    if "signalling" in document and draw(st.booleans()):
        with_single_tracks(draw, document)
    if draw(st.integers(0, 3)) == 3:
        continuous = moves_continuously(document["simulation"])
        document["outages"] = [draw(outages(document, span_min, continuous))]
        document["simulation"]["outage"] = "random"
    if moves_continuously(document["simulation"]) and draw(st.integers(0, 7)) == 7:
        with_neutral_section(draw, document)
    if feed_back or (moves_continuously(document["simulation"]) and draw(st.integers(0, 3)) == 3):
        with_electric_brakes(draw, document)
    if moves_continuously(document["simulation"]) and draw(st.integers(0, 7)) == 7:
        with_spare_time(draw, document)
    if direct:
        into_direct_current(draw, document)
    if apart and of_25_kv_or_direct(document):
        take_apart(draw, document)
    give_curves_over_load(Random(repr(document)), document)
    take_parts_out(Random(repr(document)), document)
    if direct or apart:
        return document
    rarely = st.sampled_from([False, True] if feed_back else [False, False, False, True])
    for say_more in (with_bounds, with_mixed_stations, with_losses, with_ratings, with_protection):
        if draw(rarely):
            say_more(draw, document)
    return document


def scenarios_of_conductors() -> st.SearchStrategy[Document]:
    """Sound scenarios whose rails are conductors of their own, of direct current and of 25 kV."""
    return st.one_of(
        sound_scenarios(direct=True, apart=True),  # type: ignore[call-arg]
        sound_scenarios(apart=True),  # type: ignore[call-arg]
    )


def scenarios_that_feed_back() -> st.SearchStrategy[Document]:
    """Sound scenarios all of whose trains have electric brakes."""
    return sound_scenarios(feed_back=True)


def network_scenarios() -> st.SearchStrategy[Document]:
    """Sound scenarios of several lines that meet."""
    return sound_scenarios(network=True)


def direct_scenarios() -> st.SearchStrategy[Document]:
    """Sound scenarios of direct current."""
    return sound_scenarios(direct=True)


JUNK: list[Any] = [None, True, "x", "", [], {}, [None], {"x": 1}, math.nan, math.inf, -math.inf]
EXTREMES = [0.0, 1e-4, 0.001, 0.01, 0.1, 1.0, 10.0, 100.0, 500.0, 5e3, 2e4, 1e5, 1e7, 1e308, 5e-324]


def paths(part: Any, path: Path = ()) -> list[Path]:
    """Key paths of all parts of a document, the whole left out."""
    if not isinstance(part, dict | list):
        return [path]
    items = part.items() if isinstance(part, dict) else enumerate(part)
    inner = [below for key, item in items for below in paths(item, (*path, key))]
    return [path, *inner] if path else inner


def part_at(document: Document, path: Path) -> Any:
    """What stands at a key path."""
    part: Any = document
    for key in path:
        part = part[key]
    return part


def is_number(value: Any) -> bool:
    """Whether a value is a number; True is none."""
    return isinstance(value, int | float) and not isinstance(value, bool)


SPOILERS = ["extreme", "extreme", "extreme", "junk", "misspell", "disorder", "delete", "unknown"]


@st.composite
def spoil(draw: Draw, document: Document) -> Document:
    """A copy with one fault, or at least one oddity."""
    document = copy.deepcopy(document)
    kind, everywhere = draw(st.sampled_from(SPOILERS)), paths(document)
    suited = {
        "extreme": [path for path in everywhere if is_number(part_at(document, path))],
        "misspell": [path for path in everywhere if isinstance(part_at(document, path), str)],
        "disorder": [path for path in everywhere if isinstance(part_at(document, path), list)],
        "unknown": [path for path in everywhere if isinstance(path[-1], str)],
    }
    path = draw(st.sampled_from(suited.get(kind) or everywhere))
    owner, key = part_at(document, path[:-1]), path[-1]
    value = owner[key]
    if kind == "delete":
        del owner[key]
    elif kind == "unknown" and isinstance(key, str):
        owner[draw(st.sampled_from([f"{key}x", key[1:], key.upper()]))] = owner.pop(key)
    elif kind == "extreme" and is_number(value):
        extreme = draw(st.sampled_from(EXTREMES)) * draw(st.sampled_from([1.0, 1.0, -1.0]))
        owner[key] = int(extreme) if isinstance(value, int) else extreme
    elif kind == "misspell" and isinstance(value, str):
        owner[key] = value + draw(st.sampled_from(["x", " ", "é", "\n", "\x00"]))
    elif kind == "disorder" and isinstance(value, list):
        owner[key] = draw(st.sampled_from([value[::-1], value * 2, value[:1]]))
    else:
        owner[key] = copy.deepcopy(draw(st.sampled_from(JUNK)))
    return document


@st.composite
def spoilt_scenarios(draw: Draw) -> Document:
    """A sound scenario, spoilt once or, more rarely, several times."""
    document = draw(sound_scenarios())
    for _ in range(draw(st.sampled_from([1, 1, 1, 2, 3]))):
        document = draw(spoil(document))
    return document
