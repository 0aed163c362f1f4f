"""The supply network as records: fixed nodes, lumped branches, contact-line sections, sources.

Constant parts stand in a `Network`, what a solution finds in a `Flow`.  Records keep what belongs to
one node or section together; to compiled code an array of them is one argument.
"""

import math
from enum import IntEnum
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.driving.data import (
    SLOPE_CHANGE,
    WITH_POWER,
    Braking,
    Driver,
    DrivingData,
    MotionModel,
    Options,
    Profiles,
    Stop,
)
from tpss.kernel import switch
from tpss.numerics.block_lu import Block, Pattern, Unknown
from tpss.numerics.curve import CurvePoint, Points
from tpss.numerics.series import SCRATCH_SHAPE
from tpss.physics.adhesion import Rail
from tpss.powerflow.bundles import (
    BundleFlow,
    Bundles,
)
from tpss.powerflow.groups import GroupFlow, Groups
from tpss.powerflow.links import Links
from tpss.powerflow.shared_grids import (
    SharedGrids,
)
from tpss.powerflow.system import System
from tpss.record import Record, Records
from tpss.sources.kinds import Source
from tpss.storage.store import Stored
from tpss.storage.wayside import StoreLaw
from tpss.vehicle.train import Train
from tpss.vehicle.train_type import TrainType

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]
Indices = npt.NDArray[np.int64]

TOLERANCE = 1e-10
"""Largest mismatch of a solution, in per unit of base power or base voltage."""

SHORTEST_PIECE_M = 1.0
"""Trains closer than this to each other or to a node count as this far away. [m]"""

UNFED = -2
"""In `Network.source_of_node`: a node that no source reaches; its voltage is 0."""


class Ending(IntEnum):
    """How a search for a solution ended that no usual start has found."""

    FOUND = 0
    """With a solution, or there was no search."""
    TURNED = 1
    """The branch of solutions turns back at the share of the load that is told."""
    LEFT_BAND = 2
    """There a voltage leaves the plausible band."""
    OUT_OF_STEP = 3
    """There a source leaves the states that its law admits."""
    LOST = 4
    """The branch was followed no further, and no end of it was seen."""


class Request(IntEnum):
    """What a load flow asks of the search that few of them need."""

    NOTHING = 0
    SOLUTION = 1
    """A solution, as no usual start has found any."""
    CONFIRMATION = 2
    """Whether the solution is the one to which the path from no load leads."""
    ANSWERED = 3
    """Nothing more: the search is done."""


class Section(Record):
    """A stretch of contact line between two fixed nodes, from its smaller to its larger position."""

    start_node: int
    """Node at which it begins."""
    end_node: int
    """Node at which it ends."""
    start_m: float
    """Where it begins. [m]"""
    end_m: float
    """Where it ends. [m]"""
    impedance_ohm_per_m: complex
    """Series impedance. [Ω/m]"""
    susceptance_s_per_m: float
    """Shunt susceptance. [S/m]"""
    block_aa: int
    """Place of the block (start node, start node)."""
    block_ab: int
    """Place of the block (start node, end node)."""
    block_ba: int
    """Place of the block (end node, start node)."""
    block_bb: int
    """Place of the block (end node, end node)."""
    gap_weight: float
    """Square of the power at its ends that a gap causes, both in per unit. [1]"""


class Branch(Record):
    """A lumped impedance."""

    start_node: int
    """Node at its start."""
    end_node: int
    """Node at its end."""
    impedance_ohm: complex
    """Series impedance. [Ω]"""
    admittance_s: complex
    """Its reciprocal. [S]"""


class NodeFlow(Unknown):
    """State of a fixed node."""

    voltage_v: complex
    """Voltage. [V]"""
    leaving_current_a: complex
    """Current into sections and branches. [A]"""
    base_v: complex
    """Where a Newton step starts. [V]"""
    direction_v: complex
    """The whole step. [V]"""
    good_v: complex
    """Voltage of the last solution that is known to be good. [V]"""
    last_v: complex
    """Voltage of the last time step. [V]"""
    before_v: complex
    """Voltage of the one before. [V]"""
    last_leaving_a: complex
    """Current into sections and branches in the last time step. [A]"""
    passed_v: complex
    """Voltage at the point before the last good one on a path of solutions. [V]"""
    aside_v: complex
    """Voltage of a solution that is put aside while another one is looked for. [V]"""


class SectionFlow(Record):
    """State of a section."""

    current_a: complex
    """Current that enters the section at its start. [A]"""
    end_current_a: complex
    """Current that leaves it at its end. [A]"""
    gap_v: complex
    """Voltage between the end of the chain and the end node. [V]"""
    inverse_p: complex
    """Pair that gives a change of the entering current. [S]"""
    inverse_q: complex
    transfer_p: complex
    """Pair by which the end voltage follows the start voltage. [1]"""
    transfer_q: complex
    base_a: complex
    """Current where a Newton step starts. [A]"""
    direction_a: complex
    """The whole step. [A]"""
    good_a: complex
    """Current of the last solution that is known to be good. [A]"""
    last_a: complex
    """Current of the last time step. [A]"""
    before_a: complex
    """Current of the one before. [A]"""
    passed_a: complex
    """Current at the point before the last good one on a path of solutions. [A]"""
    aside_a: complex
    """Current of a solution that is put aside while another one is looked for. [A]"""
    first: int
    """Bounds of its trains in `Flow.standing`."""
    end: int
    closing_m: float
    """Line between its last train and its end node. [m]"""


class SourceFlow(Record):
    """State of a source."""

    running: float
    """Number of its units that run."""
    loading_sum: float
    """Loading, summed over the steps since the last action of the converter control. [1]"""


class Standing(Record):
    """A train's place in the order along the sections."""

    train: int
    section: int
    """Section under which it stands."""
    place_m: float
    """Where, on the axis of the section. [m]"""
    piece_m: float
    """Line between the train and the train or node before it. [m]"""
    voltage_v: complex
    """Voltage at its pantograph. [V]"""
    good_v: complex
    """The one at the last good point of a path of solutions. [V]"""
    passed_v: complex
    """The one at the point before that. [V]"""


class Search(Record):
    """The search for a solution that no usual start has found: what is asked, how the last one ended."""

    ending: Ending
    """How it ended."""
    without_load: bool
    """Whether it ended so before there was any load: the sources of a network alone have no state."""
    moved_v: float
    """Largest change of a train's voltage by the last linked step. [V]"""
    drawn_va: float
    """Powers that the trains draw at the last solution, summed without sign. [VA]"""
    last_drawn_va: float
    """The same in the last time step. [VA]"""
    request: Request
    """What is asked of a search."""
    warm: bool
    """Whether there is a last time step from which it may begin."""
    share: float
    """Share of the load that is carried, as the search has found it. [1]"""
    passes: int
    """Evaluations of the network that it took."""


class Network(NamedTuple):
    """A supply network; all impedances are referred to the contact line's voltage."""

    system: System
    sections: Records[Section]
    branches: Records[Branch]
    sources: Records[Source]
    source_of_node: Indices
    """Index of the source at each node; -1: none, `UNFED`: none there or anywhere it is joined to,
    `following.FOLLOWS` less the index of another node: it has the voltage of that one."""
    pattern: Pattern
    admittance_s: Complexes
    """With what each block of the linear system begins: what the branches, and grids of several sources,
    put into it, once the passive nodes are eliminated; in their places it has their factors, see
    `block_lu.eliminate_passive`. [S]"""
    tolerance: float
    """Largest mismatch of a solution, in per unit of base power or base voltage."""
    groups: Groups
    """Of coupled sections."""
    links: Links
    """Lumped elements between several nodes."""
    bundles: Bundles
    """Of sections that are conductors side by side."""
    shared: SharedGrids
    """Grids of several sources."""
    stores: Records[StoreLaw]
    """Stores of energy at its nodes."""


class Flow(NamedTuple):
    """State of a load flow, and scratch; the unknowns are node voltages and entering currents."""

    nodes: Records[NodeFlow]
    sections: Records[SectionFlow]
    standing: Records[Standing]
    """Trains on the line by section and place, then the others in any order."""
    sources: Records[SourceFlow]
    blocks: Records[Block]
    sensitivity: Complexes
    """Of a chain's voltage and current to its start voltage and current, shape (2, 2, 2)."""
    laws: Records[Source]
    """The sources as they are while they are brought apart from like ones."""
    search: Records[Search]
    """One record."""
    groups: GroupFlow
    bundles: BundleFlow
    stores: Records[Stored]


class Loads(NamedTuple):
    """The trains, as far as the load flow is concerned."""

    trains: Records[Train]
    types: Records[TrainType]
    scratch: Floats
    """Scratch of the trains' networks, shape `SCRATCH_SHAPE`."""
    driving: DrivingData
    """What their drivers know, as they find their way through the step at each voltage."""
    points: Points
    """Of all curves of the trains."""


def loads_alone(trains: Records[Train], types: Records[TrainType]) -> Loads:
    """Trains of which all is known but the voltage, for a load flow without a line to drive on."""
    nowhere, value = np.zeros((1, 1)), np.zeros((1, 1))
    options = Options(
        step_s=1.0,
        mean_power=True,
        mean_gradient=True,
        adhesion_in_km_h=False,
        rail=switch(Rail.DRY),
        driver=switch(Driver.REGULATED),
        braking=switch(Braking.WITHIN_STEP),
        motion=switch(MotionModel.CONTINUOUS),
        slope_change=SLOPE_CHANGE,
    )
    profiles, neutral = Profiles(nowhere, value), Profiles(nowhere, np.array([[WITH_POWER]]))
    coasting = Profiles(nowhere, np.array([[math.inf]]))
    driving = DrivingData(options, profiles, profiles, neutral, coasting, Stop.blank(1, 1), types)
    return Loads(trains, types, np.zeros(SCRATCH_SHAPE), driving, CurvePoint.blank(1))
