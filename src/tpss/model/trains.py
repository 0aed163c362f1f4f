"""Trains and machines of a scenario as arrays."""

import math
from typing import Any

from tpss import library
from tpss.kernel import blank_records, plain, records
from tpss.physics.locomotive import MACHINE, TRAIN_TYPE
from tpss.physics.motor import FORMER, NEW
from tpss.physics.neural_network import build_network
from tpss.physics.reactive_power import DOUBLE_BRIDGE, POWER_FACTOR, reactive_ratio
from tpss.scenario.rolling_stock import Train
from tpss.units import si

KM_H = 1.0 / 3.6
KV = 1e3

_REACTIVE = {"power-factor": POWER_FACTOR, "double-bridge": DOUBLE_BRIDGE}
_MODEL = {"new": NEW, "former": FORMER}


def build_machine() -> Any:
    """The networks of the library, scaled to SI units: one record of `MACHINE`."""
    coefficients, machine = library.networks(), blank_records(1, MACHINE)
    for name, units in (
        ("tractive_effort", (KM_H, KV, 1.0)),
        ("bridge_sine", (1.0, 1.0)),
        ("power_factor", (KM_H,)),
    ):
        machine[0][name] = build_network(coefficients[name], units)
    return machine


def build_train_types(trains: list[Train]) -> Any:
    """Records of `TRAIN_TYPE`, in the order of the trains."""
    return records([_train_type(train) for train in trains], TRAIN_TYPE)


def _train_type(train: Train) -> tuple[float, ...]:
    mass, adhesive = si(train, "mass_t"), si(train, "adhesive_mass_t")
    auxiliary_w = si(train, "auxiliary_power_kw")
    values = {
        "mass_kg": mass,
        "adhesive_mass_kg": adhesive,
        "inertia_kg": adhesive + (mass - adhesive) * (1.0 + train.rotating_mass_factor),
        "coasting_inertia_kg": mass * (1.0 + train.rotating_mass_factor),
        "rotor_mass_kg": si(train, "motor_inertia_kg") * (1.0 + train.slip),
        "slip_factor": 1.0 + train.slip,
        "resistance_a_n": si(train, "resistance_a_n"),
        "resistance_b_n_s_per_m": si(train, "resistance_b_n_s_per_m"),
        "resistance_c_n_s2_per_m2": si(train, "resistance_c_n_s2_per_m2"),
        "highest_current_a": si(train, "max_motor_current_a"),
        "highest_retardation_m_s2": si(train, "max_retardation_m_s2"),
        "highest_speed_m_s": si(train, "max_speed_kmh"),
        "efficiency": train.efficiency,
        "auxiliary_power_w": auxiliary_w,
        "auxiliary_reactive_power_var": auxiliary_w
        * plain(reactive_ratio)(train.auxiliary_power_factor),
        "base_speed_m_s": si(train, "base_speed_kmh"),
        "highest_motor_voltage_v": si(train, "max_motor_voltage_v"),
        "reactive_model": _REACTIVE[train.reactive_power],
        "voltage_model": _MODEL[train.motor_voltage],
        "current_model": _MODEL[train.motor_current],
        "filter_reactance_ohm": si(train, "filter_reactance_ohm")
        if train.filter_reactance_ohm is not None
        else math.inf,
    }
    return tuple(values[name] for name in TRAIN_TYPE.names or ())
