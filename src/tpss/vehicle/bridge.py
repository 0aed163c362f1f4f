"""The double bridges of a locomotive at a line voltage: reactive power for each ampere of the motors."""

import numpy as np
import numpy.typing as npt

from tpss.kernel import fused, inlined
from tpss.numerics.series import reaches, series_at
from tpss.physics.motor import MotorModel, line_voltage_factor, motor_voltage
from tpss.physics.reactive_power import (
    bridge_reactive_power,
    bridge_sine_series,
    sine_over_motor_voltage,
)
from tpss.vehicle.terms import Demand
from tpss.vehicle.train_type import TrainType

Array = npt.NDArray[np.float64]


@inlined
def train_bridge_sine(
    voltage_v: float, kind: TrainType, demand: Demand, scratch: Array
) -> tuple[float, float]:
    """β, clipped to 0 ≤ β ≤ 1, and its slope over the line voltage. [1], [1/V]"""
    network, series = kind.networks.bridge_sine, demand.sine
    locomotive_v = voltage_v * kind.transformer_ratio
    motor_v = 0.0
    if kind.voltage_model != MotorModel.NEW or not reaches(locomotive_v, series):
        motor_v = motor_voltage(
            demand.terms_speed_m_s,
            voltage_v,
            kind.base_speed_m_s,
            kind.highest_motor_voltage_v,
            kind.voltage_model,
        )
        bridge_sine_series(motor_v, locomotive_v, network, scratch, series)
    sine, by_locomotive = series_at(locomotive_v, series)
    demand.bridge_sine = sine
    if sine <= 0.0:
        return 0.0, 0.0
    if sine >= 1.0:
        return 1.0, 0.0
    slope = by_locomotive * kind.transformer_ratio
    if (
        kind.voltage_model != MotorModel.NEW
        and line_voltage_factor(voltage_v, kind.voltage_model) < 1.0
    ):
        slope += sine_over_motor_voltage(network, scratch) * motor_v / voltage_v
    return sine, slope


@fused
def bridge_ratio(
    voltage_v: float, kind: TrainType, demand: Demand, scratch: Array
) -> tuple[float, float]:
    """Reactive power of the bridges over the motors' current at full line voltage, and its slope.

    [var/A], [var/A/V]

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph. [V]

    References
    ----------
    [Boullanger2009]_, eq. (2.19) and (F.24).
    """
    sine, sine_slope = train_bridge_sine(voltage_v, kind, demand, scratch)
    if kind.voltage_model != MotorModel.NEW:
        factor = line_voltage_factor(voltage_v, kind.voltage_model)
        if factor < 1.0:  # below the knee of the former voltage, current times voltage is constant
            unit = bridge_reactive_power(voltage_v * kind.transformer_ratio / factor, 1.0, 1.0)
            return unit * sine, unit * sine_slope
    per_volt = bridge_reactive_power(kind.transformer_ratio, 1.0, 1.0)
    unit = voltage_v * per_volt
    return unit * sine, unit * sine_slope + per_volt * sine
