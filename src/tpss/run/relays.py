"""What equipment bears for a while, and what has tripped because it bore more."""

from typing import NamedTuple


class Protected(NamedTuple):
    """What trips: one of these by its number, -1 of the others."""

    name: str
    station: int = -1
    """Feeding station, by its source."""
    transformer: int = -1
    """Transformer of a high-voltage line, by its branch."""
    section: int = -1
    """Section of the contact line."""


class Relay(NamedTuple):
    """What equipment bears over a window."""

    protected: Protected
    window_s: float
    highest: float
    """R.m.s. load, over the rated one. [1]"""
    current: int = -1
    """Number of the recorded current that is the load; -1: it is that of a unit of the station."""
    rated_a: float = 1.0
    """Rated current. [A]"""
    type_number: int = -1
    """Type of the units in a station with several; -1: it has one."""
    rated_va: float = 1.0
    """Rated power of all units of that type. [VA]"""
    group_current_a: tuple[float, ...] = ()
    """Currents at the points of the characteristic of a group of rectifiers; none: no rectifiers. [A]"""
    group_voltage_v: tuple[float, ...] = ()
    """Voltages at these points. [V]"""


class Trip(NamedTuple):
    """Equipment that has tripped."""

    protected: Protected
    time_s: float
    load: float
    """R.m.s. load over the window, over the rated one. [1]"""
    relay: Relay
    """What it has passed."""
