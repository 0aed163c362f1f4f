"""What the clock reads and writes: the state of trains, network and converter control."""

from enum import IntEnum
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.kernel import inlined, plain
from tpss.numerics.series import SCRATCH_SHAPE
from tpss.powerflow.assembly import new_flow
from tpss.powerflow.network import Flow, Indices, Loads
from tpss.record import Record, Records
from tpss.step.model import Model, driving_data
from tpss.step.separation import Occupancy, tracks_of
from tpss.step.turns import Turn, Turns, new_turns
from tpss.vehicle.breaches import BREACHES, Breach
from tpss.vehicle.train import Train

Floats = npt.NDArray[np.float64]

CONTROL_PERIOD_S = 180.0
"""Time between two actions of the converter control. [s] [Boullanger2009]_, section 3.5."""


class Status(IntEnum):
    """How a call of the clock ended."""

    RUNNING = 0
    FINISHED = 1
    COLLAPSED = 2
    STALLED = 3
    SEARCHING = 4
    """A step waits for the answer of a search."""
    DEADLOCKED = 5
    """Trains wait for each other in a circle."""


class TrainState(IntEnum):
    """Codes of `train_state` in the result."""

    ABSENT = -1
    WAITING = 0
    MOTORING = 1
    COASTING = 2
    BRAKING = 3
    DWELLING = 4
    ARRIVED = 5


class Counter(IntEnum):
    """What was limited or left its range, counted in steps of one train."""

    EFFORT_EXTRAPOLATED = Breach.EFFORT_EXTRAPOLATED
    EFFORT_CLIPPED = Breach.EFFORT_CLIPPED
    BRIDGE_EXTRAPOLATED = Breach.BRIDGE_EXTRAPOLATED
    BRIDGE_CLIPPED = Breach.BRIDGE_CLIPPED
    POWER_FACTOR_EXTRAPOLATED = Breach.POWER_FACTOR_EXTRAPOLATED
    EFFICIENCY_EXTRAPOLATED = Breach.EFFICIENCY_EXTRAPOLATED
    CURRENT_LIMITED = Breach.CURRENT_LIMITED
    SHORT_PIECE = BREACHES
    TOO_NEAR = BREACHES + 1
    MOTORS_SPARED = BREACHES + 2
    LEAST_WISH = BREACHES + 3


class Clock(Record):
    """What the clock keeps from step to step, and why it stopped."""

    loading_steps: int
    """Steps since the last action of the converter control."""
    next_action_s: float
    """When it acts next. [s]"""
    stop_error_m: float
    """Largest distance between where a train came to stand and its stop. [m]"""
    stalled_train: int
    """Train that has stalled, or -1."""
    force_needed_n: float
    """Force that it would take. [N]"""
    force_available_n: float
    """Force that it has. [N]"""
    begin_s: float
    """When the present step begins. [s]"""
    short_pieces: int
    """Pieces of line between trains and nodes that were too short, in the present step."""
    last_step_s: float
    """Length of the step that was carried out last, or is tried now. [s]"""
    lengths_tried: int
    """Lengths tried of a step before."""
    passes: int
    """Evaluations of the network in a step so far."""
    on_line: int
    """Trains on the line in it."""
    fresh_step: int
    """Step whose load flow knows of none before it: the first one, or that of a switching."""
    unfed: int
    """Trains on the line that no station reaches."""
    carried_share: float
    """Share of the load that the line carries, where it cannot carry all of it. [1]"""
    deadlocked_train: int
    """A train that waits in a circle, or -1."""


class State(NamedTuple):
    """Everything that a step changes."""

    trains: Records[Train]
    scratch: Floats
    """Scratch of the trains' networks: runs of one model may proceed at the same time."""
    flow: Flow
    clock: Records[Clock]
    """One record."""
    occupancies: Records[Occupancy]
    """Parts of tracks that trains stand on: of each one below its head, and one on the leg before."""
    first_on_track: Indices
    """First one on each track; -1: none."""
    turns: Turns
    """What trains hold of gates, and whom they wait for."""


@inlined
def loads_of(model: Model, state: State) -> Loads:
    """The trains, as far as the load flow is concerned."""
    return Loads(state.trains, model.types, state.scratch, driving_data(model), model.points)


def loads_in_python(model: Model, state: State) -> Loads:
    """`loads_of` for Python, to which kernels give no arrays back."""
    data = plain(driving_data)(model)
    return Loads(state.trains, model.types, state.scratch, data, model.points)


def new_state(model: Model, trains: Records[Train], turns: Records[Turn] | None = None) -> State:
    """State before the first step.

    Parameters
    ----------
    turns : records of Turn, optional
        The planned order at gates.
    """
    clock = Clock.blank(1)
    clock[0].next_action_s = CONTROL_PERIOD_S
    clock[0].stalled_train = clock[0].deadlocked_train = -1
    clock[0].carried_share = 1.0
    return State(
        trains=trains,
        scratch=np.empty(SCRATCH_SHAPE),
        flow=new_flow(model.network, trains.size),
        clock=clock,
        occupancies=Occupancy.blank(2 * trains.size),
        first_on_track=np.full(tracks_of(model.legs), -1, dtype=np.int64),
        turns=new_turns(trains.size, model.rules, turns),
    )
