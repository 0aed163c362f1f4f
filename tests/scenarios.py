"""A short line to vary in tests of the clock."""

import copy
from typing import Any

import tpss

SHORT_LINE: dict[str, Any] = {
    "format": 1,
    "name": "short-line",
    "simulation": {"time_step_min": 0.05},
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


def short_line(changes: dict[str, Any] | None = None) -> tpss.Scenario:
    """The short line with some values changed by key path."""
    scenario = tpss.Scenario.from_document(copy.deepcopy(SHORT_LINE), "short-line")
    return scenario.with_(changes or {})


def run(changes: dict[str, Any] | None = None) -> tpss.Result:
    """Result of the short line with some values changed; its audit has passed."""
    result = tpss.simulate(short_line(changes))
    assert result.audit["passed"], result.audit["failures"]
    return result


def phases(result: tpss.Result, train: str) -> list[str]:
    """States of a train in their order, each once until it changes."""
    names = result.dataset.train_state.attrs["flag_meanings"].split()
    codes = result.dataset.train_state.sel(train=train).to_numpy()
    on_line = [names[code] for code in codes if code >= 0]
    return [name for k, name in enumerate(on_line) if k == 0 or name != on_line[k - 1]]
