"""Random scenarios: sound ones of every kind, and ones that are spoilt.

Numbers are drawn from a coarse grid as often as not, so that things coincide: a limit at a stop, a
train at a node, a dwell of a whole number of steps.  Sizes are bounded so that a run takes some
hundred steps with a dozen trains.
"""

import copy
import math
from typing import Any

from hypothesis import strategies as st

from .kilometres import moved

Draw = Any
Document = dict[str, Any]
Path = tuple[str | int, ...]

MOST_STEPS = 150
MOST_TRAINS = 12
STEPS = st.sampled_from([60.0, MOST_STEPS, 20.3, 99.999, 5.0, 1.0])
"""Length of a run; what is listed first is drawn most often."""
STEPS_MIN = [0.01, 0.02, 0.05, 0.1, 0.25, 0.3, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0]


def numbers(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers of a range, evenly: on a grid of a hundred places, or on one finer than a millionth.

    Hypothesis prefers small numbers in a wide range, so the fine grid is drawn in three digits.
    """
    digits = st.integers(0, 100)
    grid = digits.map(lambda k: round(low + (high - low) * k / 100.0, 9))
    fine = st.tuples(digits, digits, digits).map(
        lambda k: low + (high - low) * (k[0] / 101.0 + k[1] / 1e4 + k[2] / 1e7)
    )
    return st.one_of(grid, fine).map(lambda number: max(low, min(high, number)))


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
        "stations": [{"name": f"S{i}", "position_km": km} for i, km in enumerate(stations)],
    }


OWN_CATENARIES = st.fixed_dictionaries(
    {"r_ohm_per_km": numbers(0.01, 0.5), "x_ohm_per_km": numbers(0.0, 0.5)},
    optional={
        "capacitance_nf_per_km": numbers(0.0, 30.0),
        "connection_r_ohm": numbers(0.01, 0.5),
        "connection_x_ohm": numbers(0.01, 0.5),
    },
)

CONVERTER_STATIONS = st.fixed_dictionaries(
    {
        "type": st.just("Q48/Q49"),
        "converters": st.integers(1, 6),
        "control": st.sampled_from(["all-on", "loading"]),
    },
    optional={
        "grid_reactance_ohm": numbers(0.0, 2.0),
        "grid_reactive_power_mvar": numbers(-5.0, 5.0),
        "grid_angle_deg": numbers(-10.0, 10.0),
    },
)


TRANSFORMERS = st.fixed_dictionaries(
    {"rated_mva": numbers(5.0, 60.0)},
    optional={"load_loss_kw": numbers(0.0, 40.0)},
)


def transformer_stations(no_load_kv: tuple[float, float]) -> st.SearchStrategy[Document]:
    """Transformer stations, ideal ones too, at strong and weak grids."""
    percent = st.one_of(numbers(2.0, 20.0), numbers(2.0, 20.0), st.just(0.0))

    def with_percent(unit: Document, short_circuit_percent: float) -> Document:
        losses = {} if short_circuit_percent == 0.0 else unit
        rated = {"rated_mva": unit["rated_mva"], "short_circuit_percent": short_circuit_percent}
        return {**losses, **rated}

    return st.fixed_dictionaries(
        {
            "no_load_voltage_kv": numbers(*no_load_kv),
            "transformer": st.builds(with_percent, TRANSFORMERS, percent),
        },
        optional={
            "transformers": st.integers(1, 3),
            "grid_short_circuit_mva": numbers(200.0, 5000.0),
            "grid_r_over_x": numbers(0.0, 1.0),
        },
    )


@st.composite
def supplies(draw: Draw, length_km: float) -> Document:
    """One to five converter stations anywhere, perhaps a high-voltage line.

    A few of the stations are transformer stations.
    """
    kms = draw(places_km(length_km, 1, 5))
    by_grid = draw(st.integers(0, 1)) if draw(st.integers(0, 7)) == 7 else 0
    supply = {
        "frequency_hz": 16.7,
        "catenary": draw(st.one_of(st.sampled_from(["BT", "AT"]), OWN_CATENARIES)),
        "converter_stations": [
            {"name": f"C{i}", "position_km": km, **draw(CONVERTER_STATIONS)}
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


TRAINS = st.fixed_dictionaries(
    {"model": st.just("Rc4-freight-1470t")},
    optional={
        "mass_t": numbers(80.0, 2500.0),
        "adhesion": numbers(0.05, 0.4),
        "length_m": st.sampled_from([0.0, 25.0, 700.0]),
        "max_motor_current_a": st.sampled_from([150.0, 700.0, 1250.0, 2080.0, 2500.0, 5000.0]),
        "max_retardation_m_s2": numbers(0.05, 2.0),
        "max_speed_kmh": numbers(20.0, 250.0),
        "efficiency": numbers(0.5, 1.0),
        "auxiliary_power_kw": st.one_of(numbers(0.0, 800.0), numbers(1000.0, 6000.0)),
        "auxiliary_power_factor": numbers(0.5, 1.0),
        "reactive_power": st.sampled_from(["power-factor", "double-bridge"]),
        "motor_voltage": st.sampled_from(["new", "former"]),
        "motor_current": st.sampled_from(["new", "former"]),
        "rotating_mass_factor": numbers(0.0, 0.3),
        "motor_inertia_kg": numbers(0.0, 20_000.0),
        "slip": numbers(0.0, 0.2),
        "resistance_a_n": numbers(0.0, 40_000.0),
        "resistance_b_n_s_per_m": numbers(0.0, 1000.0),
        "resistance_c_n_s2_per_m2": numbers(0.0, 200.0),
        "base_speed_kmh": numbers(20.0, 200.0),
        "filter_reactance_ohm": numbers(-5.0, -0.2),
        "current_limitation": st.fixed_dictionaries(
            {"max_current_a": st.one_of(numbers(900.0, 2000.0), st.just(900.0))},
            optional={"knee_factor": numbers(0.8, 1.0), "umin2_kv": numbers(9.0, 11.9)},
        ),
    },
)

SIMULATIONS = st.fixed_dictionaries(
    {"time_step_min": st.one_of(st.sampled_from(STEPS_MIN), numbers(0.01, 5.0))},
    optional={
        "power_sampling": st.sampled_from(["mean", "start"]),
        "gradient_sampling": st.sampled_from(["mean", "start"]),
        "adhesion_speed_unit": st.sampled_from(["m/s", "km/h"]),
        "rail": st.sampled_from(["dry", "wet"]),
        "braking": st.sampled_from(["within-step", "whole-steps"]),
    },
)


@st.composite
def services(draw: Draw, i: int, document: Document, span_min: float) -> Document:
    """A traffic entry between two stations, with a timetable of one kind or another."""
    stations = sorted(document["line"]["stations"], key=lambda s: s["position_km"])
    step = document["simulation"]["time_step_min"]
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
                st.lists(numbers(begin, end), min_size=draw(st.sampled_from([3, 0])), max_size=5)
            )
            if km < end
        ]
    return entry


def _pull_out_beyond_the_knee(
    max_force_kn: float, max_power_kw: float, limit_speed_kmh: float | None = None
) -> Document:
    """The limit speed, raised to that from which power limits; nothing, if there is none."""
    if limit_speed_kmh is None:
        return {}
    return {"limit_speed_kmh": max(limit_speed_kmh, 3.6 * max_power_kw / max_force_kn)}


EMUS = st.fixed_dictionaries(
    {
        "tractive_effort": st.fixed_dictionaries(
            {"max_force_kn": numbers(50.0, 400.0), "max_power_kw": numbers(500.0, 9000.0)},
            optional={"limit_speed_kmh": numbers(80.0, 300.0)},
        ).map(lambda effort: effort | _pull_out_beyond_the_knee(**effort)),
        "mass_t": numbers(80.0, 900.0),
        "adhesive_mass_t": numbers(40.0, 80.0),
        "resistance_a_n": numbers(0.0, 10_000.0),
        "resistance_b_n_s_per_m": numbers(0.0, 300.0),
        "resistance_c_n_s2_per_m2": numbers(0.0, 20.0),
        "max_speed_kmh": numbers(40.0, 300.0),
        "max_retardation_m_s2": numbers(0.2, 1.5),
        "efficiency": numbers(0.6, 1.0),
        "auxiliary_power_kw": numbers(0.0, 800.0),
        "power_factor": numbers(0.8, 1.0),
    },
    optional={
        "max_acceleration_m_s2": numbers(0.2, 1.5),
        "rotating_mass_factor": numbers(0.0, 0.2),
        "length_m": st.sampled_from([0.0, 25.0, 700.0]),
        "current_limitation": st.fixed_dictionaries(
            {"max_current_a": numbers(300.0, 1000.0)},
            optional={"knee_factor": numbers(0.8, 1.0)},
        ).map(lambda limit: {**limit, "un_kv": 25.0, "umin2_kv": 17.5}),
    },
)
"""Trains with converters, whose auxiliaries stay within their current limitation."""


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


BEGINNINGS_KM = st.sampled_from([False, False, False, False, True]).flatmap(
    lambda elsewhere: numbers(-300.0, 1500.0) if elsewhere else st.none()
)
"""Kilometres where a fifth of the lines begin; None for 0."""


@st.composite
def sound_scenarios(draw: Draw) -> Document:
    """A scenario without faults, but for trains that may be placed too fast to stop.

    A fifth of the lines begin elsewhere than at 0.
    """
    begin_km = draw(BEGINNINGS_KM)
    line = draw(lines())
    document: Document = {
        "format": 1,
        "name": "random",
        "simulation": draw(SIMULATIONS),
        "line": line,
        "supply": draw(supplies(line["length_km"])),
        "trains": {f"train {i}": draw(TRAINS) for i in range(draw(st.integers(1, 2)))},
    }
    if draw(st.integers(0, 4)) == 4:
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
    return document if begin_km is None else moved(document, begin_km)


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
