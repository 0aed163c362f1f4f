"""The audit's figures: balances recomputed from what was recorded, by other equations than the solver's.

The network's are those of `audit.network`, the trains' those of `audit.motion`.
"""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.kernel import kernel
from tpss.record import Record, Records

ALLOWED_BALANCE = 1e-9
"""Energy that may be missing from the network's balance, relative to what the stations feed. [1]"""


class Balances(Record):
    """Figures of an audit, and the sums that they are made of."""

    power_mismatch_va: float
    """Largest power mismatch over nodes, trains and steps. [VA]"""
    converter_residual: float
    """Largest residual of a source's law. [p.u.]"""
    network_balance: float
    """Energy of the stations less that of trains and losses, relative to the first. [1]"""
    traction_balance: float
    """Work of the motors less where it went, relative. [1]"""
    force_balance: float
    """Largest difference between the forces on a train and its inertia, relative to its weight. [1]"""
    motion_error_m: float
    """Largest difference between a train's movement in a step and that of its speeds. [m]"""
    fed_j: float
    """Energy of the stations. [J]"""
    drawn_j: float
    """Energy of the trains. [J]"""
    lost_j: float
    """Losses of the network. [J]"""
    work_j: float
    """Work of the motors. [J]"""
    moving_j: float
    """Work against rotors, resistance, gradients and brakes. [J]"""
    kinetic_j: float
    """Gain of kinetic energy. [J]"""
    fallen_j: float
    """Work of gravity downhill. [J]"""
    slowed_j: float
    """Loss of kinetic energy where there is one. [J]"""


class Scratch(NamedTuple):
    """Scratch arrays, and the result."""

    balances: Records[Balances]
    """One record."""
    leaving_a: npt.NDArray[np.complex128]
    """Current that leaves each node into contact line and branches. [A]"""
    node_v: npt.NDArray[np.complex128]
    order: npt.NDArray[np.int64]
    """Trains on the line by section and position."""
    section: npt.NDArray[np.int64]
    """Section under which each train stands."""
    place_m: npt.NDArray[np.float64]
    """Its place on the line. [m]"""


def new_scratch(nodes: int, trains: int) -> Scratch:
    """Scratch for so many nodes and trains."""
    return Scratch(
        balances=Balances.blank(1),
        leaving_a=np.zeros(nodes, dtype=complex),
        node_v=np.zeros(nodes, dtype=complex),
        order=np.arange(trains),
        section=np.zeros(trains, dtype=np.int64),
        place_m=np.zeros(trains),
    )


@kernel
def worst(largest: float, value: float) -> float:
    """The larger magnitude; NaN, which no limit admits, once there has been one."""
    size = abs(value)
    return largest if largest >= size or math.isnan(largest) else size
