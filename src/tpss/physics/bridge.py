"""The double bridges of a locomotive at a line voltage: reactive power for each ampere of the motors."""

from typing import Any

from tpss.kernel import fused, inlined
from tpss.physics.motor import NEW, line_voltage_factor, motor_voltage
from tpss.physics.reactive_power import (
    TRANSFORMER_RATIO,
    bridge_reactive_power,
    bridge_sine_series,
    sine_over_motor_voltage,
)
from tpss.physics.series import reaches, series_at


@inlined
def train_bridge_sine(voltage_v: float, kind: Any, train: Any, machine: Any) -> tuple[float, float]:
    """β, clipped to 0 ≤ β ≤ 1, and its slope over the line voltage. [1], [1/V]"""
    network, series, locomotive_v = machine.bridge_sine, train.sine, voltage_v * TRANSFORMER_RATIO
    motor_v = 0.0
    if kind.voltage_model != NEW or not reaches(locomotive_v, series):
        motor_v = motor_voltage(
            train.speed_m_s,
            voltage_v,
            kind.base_speed_m_s,
            kind.highest_motor_voltage_v,
            kind.voltage_model,
        )
        bridge_sine_series(motor_v, locomotive_v, network, machine.room, series)
    sine, by_locomotive = series_at(locomotive_v, series)
    train.bridge_sine = sine
    if sine <= 0.0:
        return 0.0, 0.0
    if sine >= 1.0:
        return 1.0, 0.0
    slope = by_locomotive * TRANSFORMER_RATIO
    if kind.voltage_model != NEW and line_voltage_factor(voltage_v, kind.voltage_model) < 1.0:
        slope += sine_over_motor_voltage(network, machine.room) * motor_v / voltage_v
    return sine, slope


@fused
def bridge_ratio(voltage_v: float, kind: Any, train: Any, machine: Any) -> tuple[float, float]:
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
    sine, sine_slope = train_bridge_sine(voltage_v, kind, train, machine)
    if kind.voltage_model != NEW:
        factor = line_voltage_factor(voltage_v, kind.voltage_model)
        if factor < 1.0:  # below the knee of the former voltage, current times voltage is constant
            unit = bridge_reactive_power(voltage_v * TRANSFORMER_RATIO / factor, 1.0, 1.0)
            return unit * sine, unit * sine_slope
    per_volt = bridge_reactive_power(TRANSFORMER_RATIO, 1.0, 1.0)
    unit = voltage_v * per_volt
    return unit * sine, unit * sine_slope + per_volt * sine
