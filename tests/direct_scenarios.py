"""A short line of direct current: 6 km between rectifier stations, trains both ways that feed back."""

import copy
from typing import Any

import tpss
from tpss import library

UNIT = {
    "tractive_effort": {"max_force_kn": 200.0, "max_power_kw": 2_000.0},
    "mass_t": 150.0,
    "adhesive_mass_t": 150.0,
    "rotating_mass_share": 0.06,
    "resistance_a_n": 3_000.0,
    "resistance_b_n_s_per_m": 0.0,
    "resistance_c_n_s2_per_m2": 20.0,
    "max_speed_kmh": 80.0,
    "max_retardation_m_s2": 1.0,
    "max_acceleration_m_s2": 1.0,
    "efficiency": 0.85,
    "auxiliary_power_kw": 100.0,
    "regeneration": {"max_force_kn": 150.0, "max_power_kw": 2_000.0},
}
STATIONS = {"A": 0.0, "B": 2.0, "C": 4.0, "D": 6.0}
OHM_PER_KM = {"DC-0.6kV": 0.02, "DC-0.75kV": 0.02, "DC-1.5kV": 0.05, "DC-3kV": 0.1}


def service(name: str, *stations: str) -> dict[str, Any]:
    first, *between, last = stations
    stops = [{"station": each, "dwell_min": 0.5} for each in between]
    return {"name": name, "train": "unit", "from": first, "to": last, "stops": stops,
            "headway_min": 5.0}  # fmt: skip


def direct_document(system: str = "DC-0.75kV") -> dict[str, Any]:
    """A document with stations of 1.1 times the nominal voltage without load."""
    nominal_kv = library.values("systems", system)["nominal_kv"]
    kind = {"no_load_voltage_kv": 1.1 * nominal_kv, "rated_current_a": 2_500.0,
            "resistance_ohm": 0.02 * nominal_kv / 0.75}  # fmt: skip
    return {
        "format": 1,
        "name": "direct",
        "simulation": {"time_step_min": 0.1, "duration_min": 15.0},
        "line": {
            "length_km": 6.0,
            "tracks": 2,
            "gradients": [{"from_km": 0.0, "permille": 0.0}],
            "speed_limits": [{"from_km": 0.0, "speed_kmh": 80.0}],
            "stations": [{"name": name, "position_km": km} for name, km in STATIONS.items()],
        },
        "supply": {
            "system": system,
            "catenary": {"r_ohm_per_km": OHM_PER_KM[system]},
            "tracks_tied": "everywhere",
            "rectifier_stations": [
                {"name": "West", "position_km": 0.5, "type": kind},
                {"name": "East", "position_km": 5.5, "type": kind},
            ],
        },
        "trains": {"unit": copy.deepcopy(UNIT)},
        "traffic": [service("up", *"ABCD"), service("down", *"DCBA")],
    }


def direct_scenario(system: str = "DC-0.75kV", **changes: Any) -> tpss.Scenario:
    scenario = tpss.Scenario.from_document(direct_document(system))
    return scenario.with_(changes) if changes else scenario
