"""The electrification system of a network: its voltages, its frequency, its band of voltages."""

from typing import NamedTuple


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
