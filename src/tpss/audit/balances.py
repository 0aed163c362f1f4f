"""The audit's figures: balances recomputed from what was recorded, by other equations than the solver's.

The network's are those of `audit.network`, the trains' those of `audit.motion`.
"""

import math
from typing import NamedTuple, cast

import numpy as np
import numpy.typing as npt

from tpss.kernel import inlined, kernel
from tpss.numerics.pairs import magnitude
from tpss.powerflow.bundles import NO_BUNDLES
from tpss.powerflow.groups import NO_GROUPS
from tpss.powerflow.network import Network
from tpss.record import Record, Records
from tpss.step.recording import Recording
from tpss.storage.store import Stored

ALLOWED_BALANCE = 1e-9
"""Energy that may be missing from the network's balance, relative to what the stations feed. [1]"""


class Balances(Record):
    """Figures of an audit, and the sums that they are made of."""

    power_mismatch_va: float
    """Largest power mismatch over nodes, trains and steps. [VA]"""
    converter_residual: float
    """Largest residual of a source's law. [p.u.]"""
    network_balance: float
    """Energy of the stations less that of trains, stores and losses, relative to the first. [1]"""
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
    stored_j: float
    """Energy that stores at the line take. [J]"""


class Conductor(Record):
    """Where a conductor of a group of coupled sections stands; see `audit.coupled`."""

    section: int
    """Its section."""
    next: int
    """Its next train, in the order of `Scratch.order`."""
    is_open: bool
    """Whether its end is not reached yet."""
    ahead_m: float
    """What is left of its piece. [m]"""
    length_m: float
    """Length of its piece. [m]"""
    begin_v: complex
    """Voltage where its piece begins. [V]"""
    current_a: complex
    """Current in its piece, then in the one before. [A]"""
    leaving_a: complex
    """Current that leaves its point into the piece behind. [A]"""


class Piece(Record):
    """A piece of a conductor, between two of its own points."""

    conductor: int
    train: int
    """Train at its end; -1: the end node."""
    length_m: float
    begin_v: complex
    """Voltage where it begins. [V]"""
    end_v: complex
    """Voltage where it ends. [V]"""


class GroupScratch(NamedTuple):
    """Scratch for groups of coupled sections; an empty tuple if there are none."""

    first: npt.NDArray[np.int64]
    """First train of each section of the network, in the order of `Scratch.order`."""
    conductors: Records[Conductor]
    front: npt.NDArray[np.complex128]
    """Equations of the pieces that have begun and not ended, shape (widest, widest + 1)."""
    pieces: Records[Piece]
    """In the order in which they end."""
    factors: npt.NDArray[np.complex128]
    """What is left of the equation of each when it is eliminated, shape (pieces, widest + 1)."""


class BundleScratch(NamedTuple):
    """Scratch for bundles of conductors; an empty tuple if there are none."""

    first: npt.NDArray[np.int64]
    """First train of each section of the network, in the order of `Scratch.order`."""
    end: npt.NDArray[np.int64]
    """The one after the last."""
    next: npt.NDArray[np.int64]
    """Next train under each conductor."""
    before_v: npt.NDArray[np.complex128]
    """Voltages of the conductors where a piece begins. [V]"""
    after_v: npt.NDArray[np.complex128]
    """Where it ends. [V]"""
    leaving_a: npt.NDArray[np.complex128]
    """Currents that leave into a piece. [A]"""
    ahead_a: npt.NDArray[np.complex128]
    """Those that arrive at its end. [A]"""
    arriving_a: npt.NDArray[np.complex128]
    """Those that arrive at its beginning. [A]"""


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
    groups: GroupScratch
    bundles: BundleScratch
    stored: Records[Stored]
    """One record."""


def new_scratch(network: Network, trains: int) -> Scratch:
    """Scratch for a network and so many trains."""
    nodes = network.source_of_node.size
    return Scratch(
        balances=Balances.blank(1),
        leaving_a=np.zeros(nodes, dtype=complex),
        node_v=np.zeros(nodes, dtype=complex),
        order=np.arange(trains),
        section=np.zeros(trains, dtype=np.int64),
        place_m=np.zeros(trains),
        groups=_group_scratch(network, trains),
        bundles=_bundle_scratch(network),
        stored=Stored.blank(1),
    )


def _group_scratch(network: Network, trains: int) -> GroupScratch:
    if network.groups == NO_GROUPS:
        return cast("GroupScratch", ())
    widest = network.groups.section.shape[1]
    return GroupScratch(
        first=np.zeros(network.sections.size, dtype=np.int64),
        conductors=Conductor.blank(widest),
        front=np.zeros((widest, widest + 1), dtype=complex),
        pieces=Piece.blank(trains + widest),
        factors=np.zeros((trains + widest, widest + 1), dtype=complex),
    )


def _bundle_scratch(network: Network) -> BundleScratch:
    if network.bundles == NO_BUNDLES:
        return cast("BundleScratch", ())
    sections, widest = network.sections.size, network.bundles.section.shape[1]

    def of_conductors() -> npt.NDArray[np.complex128]:
        return np.zeros(widest, dtype=complex)

    return BundleScratch(
        first=np.zeros(sections, dtype=np.int64),
        end=np.zeros(sections, dtype=np.int64),
        next=np.zeros(widest, dtype=np.int64),
        before_v=of_conductors(),
        after_v=of_conductors(),
        leaving_a=of_conductors(),
        ahead_a=of_conductors(),
        arriving_a=of_conductors(),
    )


@kernel
def worst(largest: float, value: float) -> float:
    """The larger magnitude; NaN, which no limit admits, once there has been one."""
    size = abs(value)
    return largest if largest >= size or math.isnan(largest) else size


@inlined
def audit_demand(
    step: int, i: int, voltage: complex, current: complex, recording: Recording, figures: Balances
) -> None:
    """Mismatch between what a train draws and what flows into it."""
    row = recording.trains[step, i]
    drawn = complex(row.active_power, row.reactive_power)
    mismatch = magnitude(voltage * current.conjugate() - drawn)
    figures.power_mismatch_va = worst(figures.power_mismatch_va, mismatch)
