"""The state of a train, nested by who writes it: a function is handed the part that it may touch."""

from enum import IntEnum
from typing import Annotated

import numpy as np
import numpy.typing as npt

from tpss.kernel import inlined, kernel
from tpss.record import Record
from tpss.storage.store import Stored
from tpss.vehicle.terms import Demand

Floats = npt.NDArray[np.float64]

MOST_CALLS = 32
"""Stops of one step whose times are kept: more than a train makes in ten minutes."""


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
    PASSAGE = 6
    """Phase by phase, whatever comes; see `driving.passage`."""


class Timetable(Record):
    """When a train departs and arrives."""

    departure_step: int
    """Step at which it departs, or in which, if it moves continuously."""
    departure_wait_s: float
    """Time in that step until it departs. [s]"""
    delay_s: float
    """By what it departs later than scheduled. [s]"""
    arrival_step: int
    """Instant at which it stands at its destination; -1 until then."""
    stood_s: float
    """Time that it stood at its destination before that instant. [s]"""


class Motion(Record):
    """Where a train is; with its `Plan` all that it needs to continue from an instant."""

    phase: Phase
    position_m: float
    """Position along its route, which grows. [m]"""
    speed_m_s: float
    """Speed. [m/s]"""
    gradient: int
    """Index of the gradient under it."""
    next_stop: int
    """Index of its next stop on its route."""
    dwell_steps_left: int
    """Steps until it leaves the stop at which it stands."""
    wait_s: float
    """Time until it departs, if it moves continuously. [s]"""
    under_way_s: float
    """Time since it departed at its origin, or should have; infinite: not known. [s]"""
    power_off_s: float
    """Time until it has power again, behind a neutral section. [s]"""
    authority_m: float
    """Position that it may not pass in this step, because of others; infinite: any. [m]"""
    ceiling_m_s: float
    """Speed that it may not exceed in this step, because of others; infinite: any. [m/s]"""


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
    acceleration_m_s2: float
    """Acceleration at the end of the step before, if it moves continuously. [m/s²]"""
    resistance_n: float
    """Resistances then. [N]"""
    cruise_m_s: float
    """Highest speed where it is, at the start of the step, if it moves continuously. [m/s]"""
    braking_square_m2_s2: float
    """Square of the speed from which it has to brake, at the start of the step. [m²/s²]"""
    wanted_m_s: float
    """Speed that a driver by a law of his own wants in the step; infinite: any. [m/s]"""


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


class Passage(Record):
    """The way of a train through a step, phase by phase: where it ends, and sums over the phases."""

    motion: Motion
    """How the train would continue."""
    acceleration_m_s2: float
    """Acceleration in the last phase. [m/s²]"""
    resistance_n: float
    """Resistances in it. [N]"""
    left_s: float
    """What is left of the step. [s]"""
    stood_s: float
    """Time that it stood at its destination. [s]"""
    without_power_s: float
    """Time that it had its power off, in neutral sections and behind them. [s]"""
    stop_error_m: float
    """Largest distance between where it came to stand and its stop. [m]"""
    arrival_s: Annotated[Floats, (MOST_CALLS,)]
    """When it came to stand at the stop before its next one at the start, and at the stops that follow,
    from the start of the step; of the first of these nothing is known. [s]"""
    departure_s: Annotated[Floats, (MOST_CALLS,)]
    """When it went on from there; NaN: it has not. [s]"""
    breaches: int
    """What of its machine was limited or left its range, a bit each `Breach`."""
    stalled: bool
    """Whether it would roll back, or stands with no force to start."""
    needed_n: float
    """Force that this would take. [N]"""
    available_n: float
    """Force that it has. [N]"""
    by_voltage: bool
    """Whether the line voltage decides about its force in any phase."""
    at_any_voltage: bool
    """Whether forces and powers are known to be the same at any line voltage."""
    stays: bool
    """Whether it is the train's way through the present step, whatever the line voltage."""
    tried_v: float
    """Line voltage at which it is the way through the present step, and the demand that of its end; 0:
    none. [V]"""
    traction_ns: float
    """Impulse of the tractive force. [N s]"""
    braking_ns: float
    """Of the brakes. [N s]"""
    running_ns: float
    """Of the running resistance. [N s]"""
    gradient_ns: float
    """Of the gradient force. [N s]"""
    traction_j: float
    """Work of the tractive force. [J]"""
    braking_j: float
    """Of the brakes. [J]"""
    running_j: float
    """Against the running resistance. [J]"""
    gradient_j: float
    """Against the gradient force. [J]"""
    motor_j: float
    """Work of the motors. [J]"""
    active_j: float
    """Energy drawn. [J]"""
    reactive_vars: float
    """Reactive energy drawn. [var s]"""
    reactive_slope_vars: float
    """Slope of the reactive energy over the line voltage, as long as no force changes. [var s/V]"""
    current_as: float
    """Charge of the motors' current. [A s]"""
    electric_j: float
    """Work of the electric brakes at the wheel rim. [J]"""
    offered_j: float
    """Energy that they offer the line, auxiliaries included. [J]"""


class Train(Record):
    """A train on its route."""

    train_type: int
    """Index of its type."""
    route: int
    """Index of its route."""
    leg: int
    """Leg of the route on which it is."""
    timetable: Timetable
    motion: Motion
    plan: Plan
    decision: Decision
    forces: Forces
    demand: Demand
    line_voltage_v: complex
    """Voltage at its pantograph in the last solution, at first the nominal one. [V]"""
    passage: Passage
    """Its way through the present step, at the voltage last tried."""
    trial: Passage
    """The same at a voltage close by, for the slopes."""
    allowed_current_a: float
    """Armature current that its driver allows its motors in this step; infinite: any. [A]"""
    motor_state: float
    """Thermal state of its motors, if its driver spares them. [1]"""
    stored: Stored
    """Its store of energy."""
    stands: bool
    """Whether it stands at a stop all through the present step, and may charge its store."""


@kernel
def copy_motion(source: Motion, target: Motion) -> None:
    """Copy field by field; copying a whole record at once takes seconds to compile."""
    target.phase = source.phase
    target.position_m = source.position_m
    target.speed_m_s = source.speed_m_s
    target.gradient = source.gradient
    target.next_stop = source.next_stop
    target.dwell_steps_left = source.dwell_steps_left
    target.wait_s = source.wait_s
    target.under_way_s = source.under_way_s
    target.power_off_s = source.power_off_s
    target.authority_m = source.authority_m
    target.ceiling_m_s = source.ceiling_m_s


@kernel
def is_on_line(phase: Phase) -> bool:
    """Whether a train of this phase draws power."""
    return phase in (Phase.DRIVING, Phase.PLANNED, Phase.DWELLING)


@inlined
def brakes_within_step(course: Course) -> bool:
    """Whether a train of this course may brake for a part of the step only."""
    return course in (Course.LATEST, Course.EVEN, Course.TO_LIMIT)
