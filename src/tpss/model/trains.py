"""Trains and machines of a scenario as arrays."""

import math
from typing import Any

import numpy as np

from tpss import library
from tpss.kernel import blank_records, plain, records
from tpss.model.curves import CurveBook, interpolate
from tpss.physics.effort_table import MOST_VOLTAGES
from tpss.physics.locomotive import MACHINE, TRAIN_TYPE
from tpss.physics.machine import LIMITS, NETWORK, TABLE
from tpss.physics.motor import FORMER, NEW
from tpss.physics.neural_network import build_network
from tpss.physics.reactive_power import (
    DOUBLE_BRIDGE,
    POWER_FACTOR,
    POWER_FACTOR_CURVE,
    reactive_ratio,
)
from tpss.scenario.machine import Curve, EffortLimits, EffortTable
from tpss.scenario.rolling_stock import Train
from tpss.units import si, si_list

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


def build_train_types(trains: list[Train]) -> tuple[Any, Any]:
    """Records of `TRAIN_TYPE` in the order of the trains, and of `CURVE_POINT` for their curves."""
    book = CurveBook()
    rows = [_train_type(train, book) for train in trains]
    return records(rows, TRAIN_TYPE), book.points()


def _train_type(train: Train, book: CurveBook) -> tuple[Any, ...]:
    mass, adhesive = si(train, "mass_t"), si(train, "adhesive_mass_t")
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
        "highest_acceleration_m_s2": _si_or(train, "max_acceleration_m_s2", math.inf),
        "highest_retardation_m_s2": si(train, "max_retardation_m_s2"),
        "highest_speed_m_s": si(train, "max_speed_kmh"),
        "efficiency": _over_speed(train.efficiency, book),
        **_effort(train, book),
        **_current_limit(train),
        **_electric(train, book),
    }
    return tuple(values.get(name, 0) for name in TRAIN_TYPE.names or ())


def _effort(train: Train, book: CurveBook) -> dict[str, Any]:
    """Fields of `TRAIN_TYPE` that describe the tractive effort."""
    effort = train.tractive_effort
    if isinstance(effort, EffortTable):
        return _effort_table(train, effort, book)
    if isinstance(effort, EffortLimits):
        return {
            "effort_model": LIMITS,
            "highest_force_n": si(effort, "max_force_kn"),
            "highest_power_w": si(effort, "max_power_kw"),
            "limit_speed_m_s": _si_or(effort, "limit_speed_kmh", math.inf),
            "zero_voltage_v": _si_or(effort, "zero_voltage_kv", 0.0),
            "full_voltage_v": _si_or(effort, "full_voltage_kv", 0.0),
        }
    return {"effort_model": NETWORK, "highest_current_a": si(train, "max_motor_current_a")}


def _effort_table(train: Train, effort: EffortTable, book: CurveBook) -> dict[str, Any]:
    """A table at the train's current limit: rows over speed, one a voltage."""
    force_n = np.array(effort.force_kn) * 1e3
    if effort.motor_current_a is not None:
        currents = np.array(effort.motor_current_a)
        force_n = interpolate(si(train, "max_motor_current_a"), currents, force_n)
    voltages = [0.0] if effort.voltage_kv is None else si_list(effort, "voltage_kv")
    speeds = si_list(effort, "speed_kmh")
    places = [book.add(speeds, row) for row in np.atleast_2d(force_n)]
    return {
        "effort_model": TABLE,
        "effort": places[0],
        "effort_rows": len(voltages),
        "effort_voltage_v": voltages + [math.inf] * (MOST_VOLTAGES - len(voltages)),
    }


def _current_limit(train: Train) -> dict[str, float]:
    """Fields of `TRAIN_TYPE` that limit the current at the pantograph."""
    limit = train.current_limitation
    if limit is None:
        return {"highest_line_current_a": math.inf}
    return {
        "highest_line_current_a": si(limit, "max_current_a"),
        "auxiliary_current_a": train.auxiliary_current_a,
        "no_traction_voltage_v": si(limit, "umin2_kv"),
        "full_current_voltage_v": limit.knee_factor * si(limit, "un_kv"),
    }


def _electric(train: Train, book: CurveBook) -> dict[str, Any]:
    """Fields of `TRAIN_TYPE` that describe auxiliaries, reactive power, motor voltage and current."""
    auxiliary_w = si(train, "auxiliary_power_kw")
    values: dict[str, Any] = {
        "auxiliary_power_w": auxiliary_w,
        "auxiliary_reactive_power_var": auxiliary_w
        * plain(reactive_ratio)(train.auxiliary_power_factor),
        "base_speed_m_s": _si_or(train, "base_speed_kmh", math.nan),
        "highest_motor_voltage_v": _si_or(train, "max_motor_voltage_v", math.nan),
        "reactive_model": _REACTIVE[train.reactive_power],
        "voltage_model": _MODEL[train.motor_voltage],
        "current_model": _MODEL[train.motor_current],
        "filter_reactance_ohm": _si_or(train, "filter_reactance_ohm", math.inf),
    }
    if train.power_factor is not None and train.reactive_power == "power-factor":
        values["reactive_model"] = POWER_FACTOR_CURVE
        values["power_factor"] = _over_speed(train.power_factor, book)
    return values


def _over_speed(value: float | Curve, book: CurveBook) -> tuple[int, int]:
    if isinstance(value, Curve):
        return book.add(si_list(value, "speed_kmh"), value.value)
    return book.add_constant(value)


def _si_or(source: object, name: str, default: float) -> float:
    """Value of a field in SI units, or what stands for one that is left out."""
    return default if getattr(source, name) is None else si(source, name)
