"""A short line to vary in tests of the clock; its trains move in steps unless a test says otherwise."""

import copy
from typing import Any

import tpss

from properties.journeys import Journey
from properties.rules import keep_the_rules

SHORT_LINE: dict[str, Any] = {
    "format": 1,
    "name": "short-line",
    "simulation": {"time_step_min": 0.05, "motion": "stepped", "braking": "whole-steps"},
    "line": {
        "length_km": 20.0,
        "gradients": [{"from_km": 0.0, "permille": 0.0}],
        "speed_limits": [{"from_km": 0.0, "speed_kmh": 60.0}],
        "stations": [
            {"name": "West", "position_km": 0.0},
            {"name": "Middle", "position_km": 10.0},
            {"name": "East", "position_km": 20.0},
        ],
    },
    "supply": {
        "frequency_hz": 16.7,
        "catenary": "BT",
        "converter_stations": [
            {"name": "West", "position_km": 0.0, "type": "Q48/Q49", "converters": 2},
            {"name": "East", "position_km": 20.0, "type": "Q48/Q49", "converters": 2},
        ],
    },
    "trains": {"freight": {"model": "Rc4-freight-1470t"}},
    "traffic": [
        {"name": "eastbound", "train": "freight", "from": "West", "to": "East", "headway_min": 60.0}
    ],
}


COLD: dict[str, Any] = {
    "format": 1,
    "name": "chainage",
    "simulation": {"time_step_min": 0.1},
    "line": {
        "length_km": 40.0,
        "gradients": [{"from_km": 0.0, "permille": 2.0}],
        "speed_limits": [{"from_km": 0.0, "speed_kmh": 160.0}],
        "stations": [{"name": "A", "position_km": 0.0}, {"name": "B", "position_km": 40.0}],
    },
    "supply": {
        "catenary": {"r_ohm_per_km": 0.1, "x_ohm_per_km": 0.1, "capacitance_nf_per_km": 100.0},
        "converter_stations": [
            {"name": "W", "position_km": 0.0, "type": "Q48/Q49", "converters": 2},
            {"name": "E", "position_km": 40.0, "type": "Q48/Q49", "converters": 2},
        ],
    },
    "trains": {"t": {"model": "Rc4-freight-1470t"}},
    "traffic": [
        {"name": "s", "train": "t", "from": "A", "to": "B", "departures_min": [0.0, 10.0, 20.0]}
    ],
}
"""40 km of a line whose capacitance counts: kilometres of dead contact line would show."""

BUSY: dict[str, Any] = copy.deepcopy(SHORT_LINE)
"""Limits, a hill, transformers, zones, stops, and trains on the line at the start."""
BUSY["line"]["gradients"] += [
    {"from_km": 7.3, "permille": 6.0},
    {"from_km": 15.0, "permille": -4.0},
]
BUSY["line"]["speed_limits"] += [{"from_km": 4.1, "speed_kmh": 90.0}]
BUSY["supply"]["high_voltage_line"] = {"type": "132kV", "transformers_km": [5.0, 12.6]}
BUSY["standards"] = {
    "zones": [
        {"name": "first", "from_km": 0.0, "to_km": 8.0},
        {"name": "last", "from_km": 8.0, "to_km": 20.0},
    ]
}
BUSY["traffic"][0] |= {
    "headway_min": 6.0,
    "stops": [{"station": "Middle", "dwell_min": 0.5}],
    "initial_trains": [{"position_km": 11.7, "speed_kmh": 40.0}],
}


def short_line(changes: dict[str, Any] | None = None) -> tpss.Scenario:
    """The short line with some values changed by key path."""
    scenario = tpss.Scenario.from_document(copy.deepcopy(SHORT_LINE), "short-line")
    return scenario.with_(changes or {})


def run(changes: dict[str, Any] | None = None) -> tpss.Result:
    """Result of the short line with some values changed, after a look at the rules of every run."""
    result = tpss.simulate(short_line(changes))
    keep_the_rules(result)
    return result


def journey(result: tpss.Result, train: str = "eastbound 1") -> Journey:
    """Way of one train: its positions [m], speeds [m/s] and accelerations [m/s²] by name."""
    return Journey(result, train)


def limits(*rows: tuple[float, float]) -> dict[str, Any]:
    """Speed limits from pairs of a position [km] and a speed [km/h]."""
    return {"line.speed_limits": [{"from_km": km, "speed_kmh": speed} for km, speed in rows]}


def gradients(*rows: tuple[float, float]) -> dict[str, Any]:
    """Gradients from pairs of a position [km] and a rise [per mille]."""
    return {"line.gradients": [{"from_km": km, "permille": rise} for km, rise in rows]}


def stops(*rows: tuple[float, float]) -> dict[str, Any]:
    """Stations W, 0, 1, 2, ... and E; eastbound trains stop at places [km] for a dwell [min]."""
    named = [("W", 0.0), *((str(i), km) for i, (km, _) in enumerate(rows)), ("E", 20.0)]
    return {
        "line.stations": [{"name": name, "position_km": km} for name, km in named],
        "traffic.0.from": "W",
        "traffic.0.to": "E",
        "traffic.0.stops": [
            {"station": str(i), "dwell_min": dwell} for i, (_, dwell) in enumerate(rows)
        ],
    }


def phases(result: tpss.Result, train: str = "eastbound 1") -> list[str]:
    """States of a train in their order, each once until it changes."""
    names = result.dataset.train_state.attrs["flag_meanings"].split()
    codes = result.dataset.train_state.sel(train=train).to_numpy()
    on_line = [names[code] for code in codes if code >= 0]
    return [name for k, name in enumerate(on_line) if k == 0 or name != on_line[k - 1]]
