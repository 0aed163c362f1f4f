"""The electrification system of a network: its voltages, its frequency, its band of voltages."""

from typing import NamedTuple

import numpy as np

EPSILON = float(np.finfo(float).eps)


class System(NamedTuple):
    """An electrification system, as the load flow knows it; see `system`."""

    nominal_voltage_v: float
    """Nominal voltage of the contact line. [V]"""
    base_voltage_v: float
    """Base of voltages in per unit, and the start of a load flow that knows no better. [V]"""
    base_power_va: float
    """Base of powers in per unit. [VA]"""
    frequency_hz: float
    """Frequency of the contact line. [Hz]"""
    lowest_voltage_v: float
    """Voltages below this do not occur on a sound line. [V]"""
    highest_voltage_v: float
    """Nor do voltages above this. [V]"""
    per_square_volt: float
    """Turns the square of a voltage into per unit. [1/V²]"""
    per_square_ampere: float
    """Turns the square of a current into per unit. [1/A²]"""


def system(
    nominal_voltage_v: float,
    base_voltage_v: float,
    base_power_va: float,
    frequency_hz: float,
    lowest_pu: float,
    highest_pu: float,
) -> System:
    """System from its base quantities and its band of plausible voltages, in per unit. [1]"""
    return System(
        nominal_voltage_v=nominal_voltage_v,
        base_voltage_v=base_voltage_v,
        base_power_va=base_power_va,
        frequency_hz=frequency_hz,
        lowest_voltage_v=lowest_pu * base_voltage_v,
        highest_voltage_v=highest_pu * base_voltage_v,
        per_square_volt=1.0 / base_voltage_v**2,
        per_square_ampere=(base_voltage_v / base_power_va) ** 2,
    )


def resolution_va(impedance_ohm: float, system: System) -> float:
    """Power mismatch that the rounding of voltages causes at the ends of an impedance. [VA]

    A voltage is known to 2⁻⁵² of itself, so the current through an impedance z, and with it the power,
    to a few 2⁻⁵² V²/z: a tenth of a volt-ampere over a microohm.
    """
    return float(4.0 * EPSILON * system.base_voltage_v**2 / impedance_ohm)


def gap_weight(impedance_ohm: float, system: System) -> float:
    """Square of the power that a gap of the base voltage causes at an impedance's ends. [p.u.]"""
    return float((system.base_voltage_v**2 / impedance_ohm / system.base_power_va) ** 2)
