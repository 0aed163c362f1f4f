"""A short line on which trains brake downhill and feed back, and converters say what they lose."""

import copy
from pathlib import Path
from typing import Any

import tomli_w

import tpss

from scenarios import SHORT_LINE

LOSING, PLAIN = "Q48/Q49 with losses (estimate)", "Q48/Q49"

BRAKES = {"max_force_kn": 150.0, "max_power_kw": 3000.0}


def document(kind: str = LOSING, brakes: dict[str, Any] | None = None) -> dict[str, Any]:
    """Trains every 10 min down 15 per mille; brakes of None are electric ones, {} those of friction."""
    found: dict[str, Any] = copy.deepcopy(SHORT_LINE)
    found["simulation"] = {"time_step_min": 0.2, "duration_min": 30.0}
    found["line"]["gradients"] = [{"from_km": 0.0, "permille": -15.0}]
    for station in found["supply"]["converter_stations"]:
        station["type"] = kind
    if brakes is None or brakes:
        found["trains"]["freight"]["regeneration"] = brakes or BRAKES
    found["traffic"][0]["headway_min"] = 10.0
    return found


def scenario(kind: str = LOSING, brakes: dict[str, Any] | None = None) -> tpss.Scenario:
    """That line as a scenario."""
    return tpss.Scenario.from_document(document(kind, brakes), "feeding-back")


def study(folder: Path, of: dict[str, Any], choices: dict[str, Any] | None = None) -> tpss.Study:
    """Two headways on a line, with each of some choices."""
    (folder / "line.toml").write_text(tomli_w.dumps(of), "utf-8")
    varied = {
        "format": 1,
        "name": "feeding-back",
        "scenario": "line.toml",
        "design": "grid",
        "vary": {"traffic.0.headway_min": [10.0, 15.0]},
        **({"choices": choices} if choices else {}),
    }
    (folder / "study.toml").write_text(tomli_w.dumps(varied), "utf-8")
    return tpss.load_study(folder / "study.toml")
