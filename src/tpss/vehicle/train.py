"""The state of a train, nested by who writes it: a function is handed the part that it may touch."""

from enum import IntEnum

from tpss.kernel import inlined, kernel
from tpss.record import Record
from tpss.vehicle.terms import Demand


class Phase(IntEnum):
    """Where a train is in its course from departure to arrival."""

    PENDING = 0
    DRIVING = 1
    PLANNED = 2
    """Braking to its stop by a plan."""
    DWELLING = 3
    ARRIVED = 4
    GONE = 5


class Course(IntEnum):
    """How a train moves within a step."""

    UNIFORM = 0
    """At constant acceleration."""
    LATEST = 1
    """To its stop: at constant speed, then with the highest retardation."""
    EVEN = 2
    """To its stop: with constant retardation from the start of the step."""
    LIMIT_FIRST = 3
    """At constant acceleration, as a lower limit before the stop asks for less speed."""
    TO_LIMIT = 4
    """To a lower limit: at constant speed, then with the highest retardation."""
    TO_LIMIT_UNIFORMLY = 5
    """To a lower limit, by a train that cannot hold its speed before it brakes."""


class Timetable(Record):
    """When a train departs and arrives."""

    departure_step: int
    """Step at which it departs."""
    arrival_step: int
    """Instant at which it stands at its destination; -1 until then."""
    stood_s: float
    """Time that it stood at its destination before that instant. [s]"""


class Motion(Record):
    """Where a train is; with its `Plan` all that it needs to continue from an instant."""

    phase: Phase
    position_m: float
    """Position on the line. [m]"""
    speed_m_s: float
    """Speed. [m/s]"""
    gradient: int
    """Index of the gradient under it."""
    next_stop: int
    """Index of its next stop on its route."""
    dwell_steps_left: int
    """Steps until it leaves the stop at which it stands."""


class Plan(Record):
    """Braking in whole steps, and how far it has come; see `driving.braking`."""

    step: int
    """Steps of the plan that are done."""
    hold_steps: int
    """Steps at constant speed."""
    first: float
    """Share of the highest retardation in the step after these. [1]"""
    full_steps: int
    """Then steps with all of it."""
    last: float
    """Then, unless it is 0, a step with this share of it. [1]"""


class Decision(Record):
    """What the driver of a train wants in the present step."""

    decided: bool
    """Whether the driver has decided about the present step."""
    course: Course
    hold_s: float
    """Time at constant speed. [s]"""
    brake_s: float
    """Time of braking after it. [s]"""
    moving_share: float
    """Share of the step in which the train moves. [1]"""
    target_speed_m_s: float
    """Speed after the step. [m/s]"""
    force_n: float
    """Force at the wheel rim; negative: the brakes give it. [N]"""


class Forces(Record):
    """Forces on a train in the present step, means of it, and what comes of them."""

    running_resistance_n: float
    """Running resistance. [N]"""
    gradient_n: float
    """Gradient force, positive uphill. [N]"""
    tractive_n: float
    """Tractive force that the rails pass on. [N]"""
    braking_n: float
    """Force of the brakes. [N]"""
    next_speed_m_s: float
    """Speed after the step. [m/s]"""


class Train(Record):
    """A train on its route."""

    train_type: int
    """Index of its type."""
    route: int
    """Index of its route."""
    timetable: Timetable
    motion: Motion
    plan: Plan
    decision: Decision
    forces: Forces
    demand: Demand


class Journey(Record):
    """What a train needs to continue from an instant."""

    motion: Motion
    plan: Plan


@kernel
def is_on_line(phase: Phase) -> bool:
    """Whether a train of this phase draws power."""
    return phase in (Phase.DRIVING, Phase.PLANNED, Phase.DWELLING)


@inlined
def brakes_within_step(course: Course) -> bool:
    """Whether a train of this course may brake for a part of the step only."""
    return course in (Course.LATEST, Course.EVEN, Course.TO_LIMIT)
