"""A train up or down 40 km of constant gradient, fed by a station whose voltage nothing moves."""

import copy
from typing import Any

import numpy as np

import tpss
from lines import line, network, service

R_OHM_PER_KM = 0.2
EFFICIENCY = 0.8
A_N, MASS_KG, SPEED_M_S = 10e3, 400e3, 72.0 / 3.6
WEIGHT_N = MASS_KG * 9.81
BRAKES = {"max_force_kn": 150.0, "max_power_kw": 3000.0}

TRAIN = {
    "mass_t": 400.0, "adhesive_mass_t": 200.0, "max_speed_kmh": 120.0, "max_retardation_m_s2": 0.5,
    "resistance_a_n": A_N, "resistance_b_n_s_per_m": 0.0, "resistance_c_n_s2_per_m2": 0.0,
    "rotating_mass_share": 0.0, "efficiency": EFFICIENCY, "auxiliary_power_kw": 0.0,
    "power_factor": 1.0, "tractive_effort": {"max_force_kn": 200.0, "max_power_kw": 4000.0},
}  # fmt: skip

STIFF = {
    "rating_mva": 100.0, "no_load_voltage_kv": 16.5, "droop_kv_per_mvar": 0.0,
    "generator_reactance_pu": 0.0, "generator_base_mva": 10.0, "motor_reactance_pu": 0.0,
    "motor_base_mva": 10.0, "base_voltage_kv": 16.5,
}  # fmt: skip
"""A station whose voltage nothing moves."""


def document(
    permille: float = -10.0,
    step_min: float = 0.1,
    r_ohm_per_km: float = R_OHM_PER_KM,
    **brakes: Any,
) -> dict[str, Any]:
    """40 km of constant gradient, held at 72 km/h, fed at its beginning by a stiff station."""
    made = line(
        40.0,
        {"A": 0.0, "B": 40.0},
        gradients=[{"from_km": 0.0, "permille": permille}],
        speed_limits=[{"from_km": 0.0, "speed_kmh": 72.0}],
    )
    found = network({"main": made}, [service("down", "A", "B")])
    found["trains"]["freight"] = copy.deepcopy(TRAIN)
    if brakes:
        found["trains"]["freight"]["regeneration"] = {**BRAKES, **brakes}
    found["supply"] = {
        "catenary": {"r_ohm_per_km": r_ohm_per_km, "x_ohm_per_km": 0.0},
        "converter_stations": [
            {"name": "West", "line": "main", "position_km": 0.0, "type": STIFF, "converters": 1}
        ],
    }
    found["simulation"] = {"time_step_min": step_min, "until": "first-departure-arrives"}
    return found


def values(result: tpss.Result, name: str) -> np.ndarray:
    return result.dataset[name].to_numpy()[:-1, 0]
