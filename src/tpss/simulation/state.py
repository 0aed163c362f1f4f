"""What the clock reads and writes: the model in SI units, the state of the trains, the recording."""

from collections.abc import Callable
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.kernel import blank_records, copy_of_records, inlined, record_type
from tpss.physics.locomotive import DEMAND
from tpss.powerflow.network import Flow, Network, new_flow
from tpss.simulation.recorded import row_of

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]


class Status(IntEnum):
    """How a call of the clock ended."""

    RUNNING = 0
    FINISHED = 1
    COLLAPSED = 2
    STALLED = 3


CONTROL_PERIOD_S = 180.0
"""Time between two actions of the converter control. [s] [Boullanger2009]_, section 3.5."""

# Phases of a train.
PENDING = 0
DRIVING = 1
PLANNED = 2
DWELLING = 3
ARRIVED = 4
GONE = 5

# Drivers.
REGULATED = 0
AGGRESSIVE = 1

# Braking to stops.
WHOLE_STEPS = 0
WITHIN_STEP = 1

# Course of a train in a step, where it brakes within steps.
USUAL = 0
LATEST = 1
EVEN = 2
LIMIT_FIRST = 3
TO_LIMIT = 4
TO_LIMIT_UNIFORMLY = 5

# Codes of `train_state` in the result.
ABSENT = -1
STATE_WAITING = 0
STATE_MOTORING = 1
STATE_COASTING = 2
STATE_BRAKING = 3
STATE_DWELLING = 4
STATE_ARRIVED = 5


@inlined
def is_on_course(course: int) -> bool:
    """Whether a train may brake for a part of the step only."""
    return course in (LATEST, EVEN, TO_LIMIT)


STOP = np.dtype(
    [("position_m", float), ("dwell_steps", np.int64), ("destination", np.bool_)], align=True
)
"""A stop of a route."""

TRAIN = np.dtype(
    [
        ("train_type", np.int64),
        ("route", np.int64),
        ("departure_step", np.int64),
        ("arrival_step", np.int64),  # -1 until it arrives
        ("phase", np.int64),
        ("position_m", float),
        ("stair", np.int64),  # of the gradients, under it
        ("next_stop", np.int64),
        ("dwell_left", np.int64),
        ("plan_step", np.int64),
        ("plan_hold", np.int64),
        ("plan_first", float),
        ("plan_full", np.int64),
        ("plan_last", float),
        ("decided", np.bool_),  # whether its driver has decided about the present step
        ("course", np.int64),  # braking within steps; the next three are of the present step
        ("hold_s", float),  # at constant speed
        ("brake_s", float),  # then braking
        ("moving_share", float),  # of the step; the train stands for the rest
        ("stood_s", float),  # at its destination, before the instant of its arrival
        ("voltage_v", float),  # at the pantograph, in this step or the one before
        ("target_speed_m_s", float),  # what the driver wants after this step
        ("wanted_force_n", float),
        ("running_resistance_n", float),
        ("gradient_force_n", float),
        ("force_n", float),  # what came of it: passed on by the rails
        ("braking_force_n", float),
        ("next_speed_m_s", float),
        *((name, DEMAND[name]) for name in DEMAND.names or ()),
    ],
    align=True,
)
"""State of a train, and its forces in the present step."""

JOURNEY = np.dtype(
    [
        (name, TRAIN[name])
        for name in (
            "phase", "position_m", "speed_m_s", "next_stop", "dwell_left",
            "plan_step", "plan_hold", "plan_first", "plan_full", "plan_last",
        )
    ],
    align=True,
)  # fmt: skip
"""What a train has to know to go on from an instant."""

CLOCK = np.dtype(
    [
        ("loading_steps", np.int64),  # since the last action of the converter control
        ("next_action_s", float),
        ("stop_error_m", float),  # largest distance between the end of a plan and its stop
        ("stalled_train", np.int64),
        ("force_needed_n", float),
        ("force_available_n", float),
        ("carried_share", float),  # of the load, where the line cannot carry all of it
    ],
    align=True,
)
"""What the clock keeps from step to step, and why it stopped."""


class Counter(IntEnum):
    """What was limited or left its range, counted in steps of one train."""

    EFFORT_EXTRAPOLATED = 0
    EFFORT_CLIPPED = 1
    BRIDGE_EXTRAPOLATED = 2
    BRIDGE_CLIPPED = 3
    POWER_FACTOR_EXTRAPOLATED = 4
    SHORT_PIECE = 5
    EFFICIENCY_EXTRAPOLATED = 6
    CURRENT_LIMITED = 7


class Profile(NamedTuple):
    """A staircase over position: each value holds from its position to the next one's."""

    from_m: Floats
    value: Floats


class Options(NamedTuple):
    """Choices of the simulation."""

    step_s: float
    mean_power: bool
    mean_gradient: bool
    adhesion_in_km_h: bool
    rail: int
    driver: int
    """`REGULATED`, or `AGGRESSIVE` as in the original program."""
    braking: int
    """To stops: `WHOLE_STEPS`, or `WITHIN_STEP`."""
    fixed_voltage_v: float
    """Voltage at every pantograph without a load flow, or 0 for the coupled simulation."""
    studied_train: int
    """The run ends with its arrival; -1: it does not."""


class Model(NamedTuple):
    """Everything that stays as it is during a run."""

    options: Options
    gradients: Profile
    """Rise over run. [1]"""
    limits: Profile
    """Speed limits. [m/s]"""
    stops: Any
    """Records of `STOP`, shape (routes, most stops)."""
    types: Any
    """Records of `TRAIN_TYPE`."""
    machine: Any
    """One record of `MACHINE`, from which each `State` has its own."""
    points: Any
    """Records of `CURVE_POINT`, of all curves of the trains."""
    network: Network


class Sight(NamedTuple):
    """What a driver looks at: a `Model` without its network and machines.

    To compiled code each array costs a call something; a whole model costs as much as driving does.
    """

    options: Options
    gradients: Profile
    limits: Profile
    stops: Any
    types: Any


@inlined
def sight_of(model: Model) -> Sight:
    """The part of a model that drivers look at."""
    return Sight(model.options, model.gradients, model.limits, model.stops, model.types)


class State(NamedTuple):
    """Everything that a step changes."""

    trains: Any
    """Records of `TRAIN`."""
    machine: Any
    """One record of `MACHINE`, with room of its own: runs of one model may go on at the same time."""
    flow: Flow
    clock: Any
    """One record of `CLOCK`."""


TRAIN_ROW, NODE_ROW, STATION_ROW = row_of("train"), row_of("node"), row_of("station")
"""What is recorded of each at an instant and over the interval that follows."""


class Recording(NamedTuple):
    """Everything that is kept, one row a step; NaN where there is nothing."""

    trains: Any
    """Records of `TRAIN_ROW`, shape (instants, trains)."""
    train_state: npt.NDArray[np.int8]
    nodes: Any
    """Records of `NODE_ROW`, shape (instants, nodes)."""
    stations: Any
    """Records of `STATION_ROW`, shape (instants, stations)."""
    branch_current: Floats
    """Lumped branches first, then the start and the end of each section."""
    network_losses: Floats
    passes: Indices
    """Evaluations of the network."""
    counters: Indices
    """By `Counter`."""
    journeys: Any
    """Records of `JOURNEY`, shape (instants, trains); empty unless they are asked for."""


def new_state(model: Model, trains: Any) -> State:
    """State before the first step."""
    clock = blank_records(1, CLOCK)
    clock["next_action_s"] = CONTROL_PERIOD_S
    clock["stalled_train"] = -1
    clock["carried_share"] = 1.0
    return State(
        trains=trains,
        machine=copy_of_records(model.machine),
        flow=new_flow(model.network, trains.size),
        clock=clock,
    )


def recording_bytes(model: Model, steps: int, trains: int) -> int:
    """Memory that a recording takes. [byte]"""
    network = model.network
    row = trains * (TRAIN_ROW.itemsize + 1)
    row += network.source_of_node.size * NODE_ROW.itemsize
    row += network.sources.size * STATION_ROW.itemsize
    row += 8 * (network.branches.size + 2 * network.sections.size + 2)
    return (steps + 1) * row


Memory = Callable[[int], Floats]
"""What gives an array of so many numbers, whatever they are."""


def new_recording(
    model: Model, steps: int, trains: int, memory: Memory = np.empty, with_journeys: bool = False
) -> Recording:
    """Recording with room for `steps` steps and one instant more.

    Parameters
    ----------
    memory : callable
        What gives the room.
    with_journeys : bool
        Whether it is also kept how each train would go on.
    """
    network, rows = model.network, steps + 1

    def unknown(size: int) -> Floats:
        room = memory(size)
        room.fill(np.nan)
        return room

    def blank(columns: int, dtype: np.dtype[Any]) -> Any:
        size = rows * columns * len(dtype.names or ())
        return unknown(size).view(record_type(dtype)).reshape(rows, columns).view(np.recarray)

    ends = network.branches.size + 2 * network.sections.size
    kept = rows if with_journeys else 0

    return Recording(
        trains=blank(trains, TRAIN_ROW),
        train_state=np.full((rows, trains), ABSENT, dtype=np.int8),
        nodes=blank(network.source_of_node.size, NODE_ROW),
        stations=blank(network.sources.size, STATION_ROW),
        branch_current=unknown(rows * ends).reshape(rows, ends),
        network_losses=unknown(rows),
        passes=np.zeros(rows, dtype=np.int64),
        counters=np.zeros(len(Counter), dtype=np.int64),
        journeys=blank_records(kept * trains, JOURNEY).reshape(kept, trains),
    )
