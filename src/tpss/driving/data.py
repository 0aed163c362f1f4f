"""What a driver knows of the line and of the simulation: limits, gradients, stops, and the choices made.

To compiled code each array costs a call something; the whole model would cost as much as driving does.
"""

from enum import IntEnum
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.physics.adhesion import Rail
from tpss.record import Record, Records
from tpss.vehicle.train_type import TrainType

Floats = npt.NDArray[np.float64]


class Driver(IntEnum):
    """Drivers."""

    REGULATED = 0
    AGGRESSIVE = 1
    """That of the original program."""


class Braking(IntEnum):
    """Manners of braking."""

    WHOLE_STEPS = 0
    WITHIN_STEP = 1


class MotionModel(IntEnum):
    """How trains move within a step."""

    STEPPED = 0
    """At one acceleration, from the forces at its start; departures and dwells take whole steps."""
    CONTINUOUS = 1
    """Phase by phase, with the forces of each phase's mean speed; see `driving.passage`."""


class Stop(Record):
    """A stop of a route."""

    position_m: float
    """Where it is. [m]"""
    dwell_steps: int
    """Steps that a train stands there, if it moves in steps."""
    dwell_s: float
    """Time that it stands there, if it moves continuously. [s]"""
    leaves_after_s: float
    """A train does not leave before this time since it should have departed; 0: whenever. [s]"""
    destination: bool
    """Whether the route ends there."""


class Profile(NamedTuple):
    """A staircase over position: each value holds from its position to the next one's."""

    from_m: Floats
    value: Floats


class Profiles(NamedTuple):
    """Staircases over position, a row for each length of train; what is left of a row begins nowhere."""

    from_m: Floats
    """Shape (lengths, n); infinite in what is left of a row. [m]"""
    value: Floats
    """Shape (lengths, n)."""


SLOPE_CHANGE = 1e-5
"""Relative change of the voltage that usually gives the slopes of a demand. [1]"""


class Options(NamedTuple):
    """Choices of the simulation."""

    step_s: float
    """Time step. [s]"""
    mean_power: bool
    """Whether motor power is billed with the mean speed of a step, not with that at its start."""
    mean_gradient: bool
    """Whether the gradient of a step is the mean over its distance, not that at its start."""
    adhesion_in_km_h: bool
    """Whether the adhesion law takes the speed in km/h."""
    rail: Rail
    driver: Driver
    braking: Braking
    motion: MotionModel
    slope_change: float
    """Relative change of a voltage by which slopes of a train's demand are found, where it is on its
    passage: below the voltage if it is negative. [1]"""


WITH_POWER = -1.0
"""In `DrivingData.neutral`: trains have power there. [s]"""


class DrivingData(NamedTuple):
    """What drivers know."""

    options: Options
    gradients: Profiles
    """Rise over run, as trains of each length feel it. [1]"""
    limits: Profiles
    """Speed limits, as trains of each length have to keep them. [m/s]"""
    neutral: Profiles
    """In neutral sections how long power stays off behind them, else `WITH_POWER`. [s]"""
    coasting: Profiles
    """Speed down to which trains coast; infinite: they do not. [m/s]"""
    stops: Records[Stop]
    """Shape (routes, most stops)."""
    types: Records[TrainType]
