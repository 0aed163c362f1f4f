"""What stations bear for a while, and stations that have tripped because they bore more."""

from typing import NamedTuple


class Relay(NamedTuple):
    """What a station bears over a window."""

    station: int
    """Index of its source."""
    window_s: float
    highest: float
    """R.m.s. load of a unit, over its rating. [1]"""


class Trip(NamedTuple):
    """A station that has tripped."""

    station: int
    time_s: float
    load: float
    """R.m.s. load of a unit over the window, over its rating. [1]"""
    relay: Relay
    """What it has passed."""
