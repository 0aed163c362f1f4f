"""A small plan to vary in tests: on a line of 20 km a station, an AT catenary or both may be built."""

import copy
from pathlib import Path
from typing import Any

import tomli_w

from tpss.planning.case_folder import CaseFolder
from tpss.planning.cases import CaseList
from tpss.planning.load import Plan, load_plan
from tpss.planning.simulate import simulate_cases
from tpss.planning.solve import model_of

from scenarios import SHORT_LINE

LINE: dict[str, Any] = copy.deepcopy(SHORT_LINE)
LINE["simulation"] = {"time_step_min": 0.5}
LINE["supply"]["converter_stations"] = LINE["supply"]["converter_stations"][:1]
LINE["outages"] = [
    {"name": "one out", "units": {"West": 1}},
    {"name": "a while", "units": {"West": 1}, "to_min": 10.0},
]

PLAN: dict[str, Any] = {
    "format": 1,
    "name": "small",
    "scenario": "line.toml",
    "stages": {"start": [2030, 2040], "end": 2050},
    "economics": {
        "price_year": 2024,
        "currency": "MSEK",
        "discount_rate": 0.04,
        "running_hours_per_year": 6000.0,
        "energy_per_kwh": 0.65e-6,
        "lost_minute": {"freight": 67e-6},
        "train_not_run": {"freight": {"value": 0.06, "source": "assumed"}},
    },
    "require": {"lowest_voltage_kv": 12.0},
    "measures": {
        "Mid": {
            "add": {
                "supply.converter_stations": {
                    "name": "Mid",
                    "position_km": 10.0,
                    "type": "Q48/Q49",
                    "converters": 2,
                }
            },
            "cost": 20.0,
            "lifetime_years": 40,
            "source": "assumed",
        },
        "AT": {
            "set": {"supply.catenary": "AT"},
            "cost": {"per_km": 2.0, "km": 20.0},
            "lifetime_years": 40,
            "source": "assumed",
        },
    },
    "scenarios": {
        "low": {"probability": 0.6, "traffic.eastbound.headway_min": [20.0, 20.0]},
        "high": {"probability": 0.4, "traffic.eastbound.headway_min": [20.0, 5.0]},
    },
}


def changed(changes: dict[str, Any], document: dict[str, Any] = PLAN) -> dict[str, Any]:
    """The small plan with values set by key path; None takes a key out."""
    changed = copy.deepcopy(document)
    for path, value in changes.items():
        *above, last = path.split("/")
        container = changed
        for key in above:
            container = container.setdefault(key, {})
        if value is None:
            container.pop(last, None)
        else:
            container[last] = copy.deepcopy(value)
    return changed


def write_plan(folder: Path, changes: dict[str, Any] | None = None) -> Path:
    """Write the small plan, changed by key paths with `/`, and its scenario; give its file."""
    (folder / "line.toml").write_text(tomli_w.dumps(LINE), "utf-8")
    file = folder / "plan.toml"
    file.write_text(tomli_w.dumps(changed(changes or {})), "utf-8")
    return file


def plan(folder: Path, changes: dict[str, Any] | None = None) -> Plan:
    """The small plan with values set by key path (`/` between keys)."""
    return load_plan(write_plan(folder, changes))


def modelled(folder, changes=None, tamper=None):
    """Model of the small plan; its cases are simulated once for all tests."""
    listed, cases = CaseList(plan(folder, changes)), CaseFolder(folder / "out")
    with cases.opened():
        table = simulate_cases(listed, cases, listed.cases, workers=1)
    if tamper is not None:
        table = tamper(table.copy())
    return model_of(listed, table)
