"""Scenarios to spoil in tests, and a look at what is found in them."""

from pathlib import Path
from typing import Any

import pytest

from tpss import Finding, ScenarioError, load_scenario

from conftest import EXAMPLES

FILE = EXAMPLES / "thesis_160km.toml"
"""The scenario that is spoilt, by changes to its values."""

HV = "supply.high_voltage_line"
WEST = "supply.converter_stations.0"
EAST = "supply.converter_stations.1"
ENTRY = "traffic.0"
FREIGHT = "trains.freight"
LIMITATION = f"{FREIGHT}.current_limitation"

INLINE = "line.gradients_file"
NOT_RUNNING = {f"{ENTRY}.already_running": None}
BY_TIMETABLE = {**NOT_RUNNING, f"{ENTRY}.headway_min": None}


def faults_of(changes: dict[str, Any], file: Path = FILE) -> tuple[Finding, ...]:
    with pytest.raises(ScenarioError) as caught:
        load_scenario(file, changes)
    return caught.value.findings


def finding_at(key: str, findings: tuple[Finding, ...]) -> Finding:
    """The finding at a key path; at one place there is at most one fault in these tests."""
    at_key = [finding for finding in findings if finding.key == key]
    assert at_key, f"nothing about {key!r} in {findings}"
    return at_key[0]


def shows(finding: Finding, value: str) -> bool:
    """Whether a finding shows a value; of long ones it shows the beginning."""
    return finding.value == value or (bool(value) and finding.value.startswith(value))


def stations(*rows: tuple[str, float]) -> list[dict[str, Any]]:
    return [{"name": name, "position_km": position} for name, position in rows]


def stops(*names: str) -> list[dict[str, Any]]:
    return [{"station": name, "dwell_min": 1.0} for name in names]


def gradients(*rows: tuple[float, float]) -> dict[str, Any]:
    profile = [{"from_km": start, "permille": rise} for start, rise in rows]
    return {INLINE: None, "line.gradients": profile}


def limits(*rows: tuple[float, float]) -> dict[str, Any]:
    return {"line.speed_limits": [{"from_km": km, "speed_kmh": speed} for km, speed in rows]}


def placed(*rows: tuple[float, float]) -> dict[str, Any]:
    trains = [{"position_km": km, "speed_kmh": speed} for km, speed in rows]
    return {**NOT_RUNNING, f"{ENTRY}.initial_trains": trains}
