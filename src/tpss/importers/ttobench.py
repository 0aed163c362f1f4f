"""Tracks and trains of TTOBench, the open library of train trajectory optimization problems.

A track's gradients and speed limits apply from their positions on, and gradients are positive uphill,
as here.  A train is a highest force and power, a rotating mass ρ as a share of its mass, and a running
resistance; it runs by m (1 + ρ) a = F - R(v) - m g α, power at the pantograph is F v / η.

References
----------
[Kouzoupis2023]_.
"""

import re
from dataclasses import dataclass, field, replace
from operator import gt
from pathlib import Path
from typing import Any

from tpss import library
from tpss.errors import Finding, ScenarioError
from tpss.importers.quantities import (
    DIGITS,
    KM,
    KMH,
    KN,
    KW,
    M_S2,
    NEWTON,
    NEWTON_S2_PER_M2,
    NEWTON_S_PER_M,
    PERMILLE,
    SHARE,
    TONNES,
    Quantities,
)
from tpss.scenario.scenario import Scenario
from tpss.units import kilometres

EFFICIENCY = 0.8
RETARDATION_M_S2 = 0.85
"""Used where a train states none."""

_WHY_LEFT_OUT = {
    "altitude": "only differences of altitude count, which the gradients give",
    "curvatures": "curves are not imported; line.curves takes their radii",
    "ETCS braking data": "braking is at the highest deceleration, without a supervision curve",
    "tunnel resistance": "resistance in tunnels is not modelled",
    "num seats": "it does not act on the train's motion",
    "num coaches": "it does not act on the train's motion",
    "length": "a train is imported as a point; length_m gives it a length",
    "max reg braking power": "trains do not feed power back",
    "max reg braking force": "trains do not feed power back",
    "efficiency traction": "a map of losses over load and speed is not modelled",
    "efficiency reg brake": "trains do not feed power back",
    "max pn braking force": "the brakes are limited by the highest deceleration only",
}


_ORIGIN = {
    r"line\.stations\.(\d+)\.position_km": r"stops.values.\1",
    r"line\.stations": "stops.values",
    r"line\.speed_limits\.(\d+)\.from_km": r"speed limits.values.\1.0",
    r"line\.speed_limits\.(\d+)\.speed_kmh": r"speed limits.values.\1.1",
    r"line\.gradients\.(\d+)\.from_km": r"gradients.values.\1.0",
    r"line\.gradients\.(\d+)\.permille": r"gradients.values.\1.1",
    r"trains\.t\.(adhesive_)?mass_t": "mass.value",
    r"trains\.t\.motor_inertia_kg": "rho.value",
    r"trains\.t\.resistance_a_n": "rolling resistance r0.value",
    r"trains\.t\.resistance_b_n_s_per_m": "rolling resistance r1.value",
    r"trains\.t\.resistance_c_n_s2_per_m2": "rolling resistance r2.value",
    r"trains\.t\.max_speed_kmh": "max speed.value",
    r"trains\.t\.max_acceleration_m_s2": "max acceleration.value",
    r"trains\.t\.max_retardation_m_s2": "max deceleration.value",
    r"trains\.t\.efficiency": "efficiency traction.value",
    r"trains\.t\.tractive_effort\.max_force_kn": "max traction force.value",
    r"trains\.t\.tractive_effort\.max_power_kw": "max traction power.value",
}
"""Places of a scenario's values in the files."""


@dataclass(frozen=True)
class Imported:
    """A part of a scenario, and how the file that it was made from was used."""

    name: str
    source: Path
    document: dict[str, Any]
    """Keys and values as in a scenario; a line carries its gradients as a list."""
    taken: list[str] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    assumed: list[str] = field(default_factory=list)


def read(paths: list[Path]) -> tuple[list[Imported], list[Imported]]:
    """Tracks and trains of TTOBench files, each in the order of the paths.

    Raises
    ------
    ScenarioError
        Files cannot be read, or have faults; all of them are listed.
    """
    tracks: list[Imported] = []
    trains: list[Imported] = []
    findings: list[Finding] = []
    for path in paths:
        try:
            data = Quantities(path)
            if "stops" in data:
                tracks.append(track(data))
            elif "mass" in data:
                trains.append(train(data))
            else:
                data.blame("", None, "neither a track (stops) nor a train (mass)", "name another")
                raise ScenarioError(data.findings)
        except ScenarioError as error:
            findings += error.findings
    if findings:
        raise ScenarioError(findings)
    return tracks, trains


def track(data: Quantities) -> Imported:
    """A line from a track.

    Raises
    ------
    ScenarioError
        Values are missing, of unknown units, or not valid for a line.
    """
    name = _name(data)
    stops_km = data.column("stops", KM)
    limits = data.pairs("speed limits", {"position": KM, "velocity": KMH})
    begin_km = min([*stops_km[:1], *(row[0] for row in limits[:1])], default=0.0)
    gradients: list[tuple[float, ...]] = [(begin_km, 0.0)]
    assumed = ["level track: the file states no gradients"]
    if "gradients" in data:
        gradients = data.pairs("gradients", {"position": KM, "slope": PERMILLE})
        assumed = []
    _demand_rising(data, stops_km, limits, gradients)
    if data.findings:
        raise ScenarioError(data.findings)
    names = station_names(name, len(stops_km))
    line = {
        **({"begins_at_km": begin_km} if begin_km else {}),
        "length_km": round(stops_km[-1] - begin_km, DIGITS),
        "speed_limits": [{"from_km": km, "speed_kmh": speed} for km, speed in limits],
        "stations": [
            {"name": station, "position_km": km}
            for station, km in zip(names, stops_km, strict=True)
        ],
        "gradients": [{"from_km": km, "permille": rise} for km, rise in gradients],
    }
    taken = [
        f"stops: {len(stops_km)} stations, the last one ends the line at {kilometres(stops_km[-1])} km",
        f"speed limits: {len(limits)}",
    ]
    if not assumed:
        taken.append(f"gradients: {len(gradients)}, positive uphill, from their positions on")
    assumed.append(f"names of the stations: {', '.join(names)}, from the file's id")
    imported = Imported(name, data.path, line, taken, _left_out(data), assumed)
    _check(imported, data, line=line)
    return imported


def _demand_rising(
    data: Quantities, stops_km: list[float], *profiles: list[tuple[float, ...]]
) -> None:
    """Note a fault if positions do not increase; one alone if the kilometres of all of them fall."""
    columns = [stops_km, *([row[0] for row in profile] for profile in profiles)]
    if len(stops_km) > 1 and all(all(map(gt, km, km[1:])) for km in columns):
        place = (str(data.path), "stops.values.1", data.given["stops.values.1"])
        problem = "kilometres fall in the direction of travel"
        remedy = (
            "write a minus sign before every position; the order and the slopes stay as they are"
        )
        data.findings.append(Finding(*place, problem, remedy))
        return
    for name, km in zip(("stops", "speed limits", "gradients"), columns, strict=True):
        data.demand_ascending(name, km)


def train(data: Quantities) -> Imported:
    """A train from a train.

    Raises
    ------
    ScenarioError
        Values are missing, of unknown units, or not valid for a train.
    """
    assumed: list[str] = []
    mass_t = data.number("mass", TONNES)
    rotating = _rotating_share(data, assumed)
    document = {
        "mass_t": mass_t,
        "adhesive_mass_t": mass_t,
        "motor_inertia_kg": round(1e3 * mass_t * rotating, 3),
        "resistance_a_n": data.number("rolling resistance r0", NEWTON),
        "resistance_b_n_s_per_m": data.number("rolling resistance r1", NEWTON_S_PER_M),
        "resistance_c_n_s2_per_m2": data.number("rolling resistance r2", NEWTON_S2_PER_M2),
        "max_speed_kmh": data.number("max speed", KMH),
        "max_retardation_m_s2": _retardation(data, assumed),
        "efficiency": _efficiency(data, assumed),
        "power_factor": 1.0,
        "auxiliary_power_kw": 0.0,
        "tractive_effort": {
            "max_force_kn": data.number("max traction force", KN),
            "max_power_kw": data.number("max traction power", KW),
        },
    }
    if "max acceleration" in data:
        document["max_acceleration_m_s2"] = data.number("max acceleration", M_S2)
    assumed += [
        "adhesive_mass_t is the whole mass: only the stated force limits, not adhesion; the format has "
        "no adhesive mass",
        "motor_inertia_kg is all of the rotating mass ρ m; it is accelerated by the motors, and "
        "neglected when they are off",
        "power_factor is 1, as of a four-quadrant converter; the format has none",
        "auxiliary_power_kw is 0; the format has none",
        "force and power do not depend on the line voltage (see full_voltage_kv and zero_voltage_kv)",
    ]
    if data.findings:
        raise ScenarioError(data.findings)
    taken = [name for name in data.document if name in data.used]
    imported = Imported(_name(data), data.path, document, taken, _left_out(data), assumed)
    _check(imported, data, train=document)
    return imported


def _rotating_share(data: Quantities, assumed: list[str]) -> float:
    """Rotating mass as a share of the mass; a factor of 1 or more holds the mass itself."""
    if "rho" not in data:
        assumed.append("no rotating mass: the file states no rho")
        return 0.0
    share = data.number("rho", SHARE)
    return share - 1.0 if share >= 1.0 else share


def _retardation(data: Quantities, assumed: list[str]) -> float:
    if "max deceleration" in data:
        return data.number("max deceleration", M_S2)
    assumed.append(
        f"max_retardation_m_s2 is {RETARDATION_M_S2}: the file states no max deceleration"
    )
    return RETARDATION_M_S2


def _efficiency(data: Quantities, assumed: list[str]) -> float:
    entry = data.document.get("efficiency traction")
    if isinstance(entry, dict) and "values" not in entry:
        return data.number("efficiency traction", SHARE)
    states = "a map of losses, which is left out" if entry else "none"
    assumed.append(f"efficiency is {EFFICIENCY}: the file states {states}")
    return EFFICIENCY


def _name(data: Quantities) -> str:
    """Id of a file in letters, digits, hyphens and underscores; the file's own name without one."""
    data.used.add("metadata")
    metadata = data.document.get("metadata")
    given = metadata.get("id") if isinstance(metadata, dict) else None
    text = given if isinstance(given, str) and given.strip() else data.path.stem
    return re.sub(r"[^A-Za-z0-9_-]", "_", text).lstrip("_-") or "imported"


def station_names(name: str, count: int) -> list[str]:
    """Names of a track's stations: those in its id, such as ``SE_Vasteras_Kolback``, or numbers."""
    words = name.split("_")
    places = words[1:] if re.fullmatch(r"[A-Z]{2}|00", words[0]) else words
    places = [word for word in places if word]
    if len(places) == count and len(set(places)) == count:
        return places
    numbered = [f"Stop {k}" for k in range(1, count + 1)]
    if len(places) == 2 and count > 2 and places[0] != places[1]:
        return [places[0], *numbered[1:-1], places[1]]
    return numbered


def _left_out(data: Quantities) -> list[str]:
    unknown = "not known to this importer"
    return [f"{name}: {_WHY_LEFT_OUT.get(name, unknown)}" for name in data.unused()]


def _check(
    part: Imported,
    data: Quantities,
    line: dict[str, Any] | None = None,
    train: dict[str, Any] | None = None,
) -> None:
    """Validate a part in a scenario whose other parts are placeholders.

    Raises
    ------
    ScenarioError
        The part has faults, such as values out of range.
    """
    line = line or {
        "length_km": 1.0,
        "gradients": [{"from_km": 0.0, "permille": 0.0}],
        "speed_limits": [{"from_km": 0.0, "speed_kmh": 100.0}],
        "stations": [{"name": "A", "position_km": 0.0}, {"name": "B", "position_km": 1.0}],
    }
    ends = [line["stations"][0]["name"], line["stations"][-1]["name"]]
    kind = next(iter(library.entries("converters")))
    document = {
        "format": 1,
        "name": "check",
        "simulation": {"time_step_min": 1.0},
        "line": line,
        "supply": {
            "frequency_hz": 16.7,
            "catenary": next(iter(library.entries("catenaries"))),
            "converter_stations": [
                {
                    "name": "A",
                    "position_km": line["stations"][0]["position_km"],
                    "type": kind,
                    "converters": 1,
                }
            ],
        },
        "trains": {"t": train or {"model": next(iter(library.entries("locomotives")))}},
        "traffic": [
            {"name": "t", "train": "t", "from": ends[0], "to": ends[-1], "headway_min": 10.0}
        ],
    }
    try:
        Scenario.from_document(document, part.source)
    except ScenarioError as error:
        own = [finding for finding in error.findings if not finding.key.startswith("traffic")]
        findings = dict.fromkeys(_at_its_origin(finding, data) for finding in own)
        raise ScenarioError(list(findings)) from error


def _at_its_origin(finding: Finding, data: Quantities) -> Finding:
    """A finding of a scenario's value, traced to the imported value."""
    key = finding.key
    if key == "line.begins_at_km":
        key = "line.stations.0.position_km"
    if key == "line.length_km":
        key = f"line.stations.{len(data.document['stops']['values']) - 1}.position_km"
    for ours, theirs in _ORIGIN.items():
        if match := re.fullmatch(ours, key):
            key = match.expand(theirs)
            return replace(finding, key=key, value=data.given.get(key, finding.value))
    return replace(finding, key=key)
