"""The kernels of a step in two parts that can be compiled at the same time, by two processes.

What they have in common is little; what calls both, the clock, is compiled after them.
"""

from typing import Any

import numba

from tpss.driving.braking import shortest_stop
from tpss.kernel import switch
from tpss.physics.locomotive import take_speed
from tpss.powerflow.chain import WARM
from tpss.powerflow.network import Loads
from tpss.powerflow.newton import newton
from tpss.powerflow.solve import continue_from_zero
from tpss.simulation.driver import decide
from tpss.simulation.record import record_instant
from tpss.simulation.state import Model, new_recording, new_state, sight_of
from tpss.simulation.stopping import move_on_course
from tpss.simulation.timetable import Train, train_records
from tpss.simulation.traffic import begin_plan, list_trains, stand_at_stop

Call = tuple[Any, tuple[Any, ...]]
"""A kernel, and arguments of the types with which the clock calls it."""


def load_flow(model: Model) -> list[Call]:
    """Kernels that solve a load flow."""
    flow, trains = start(model)
    loads = Loads(trains, model.types, model.machine)
    return [
        (newton, (1.0, WARM, model.network, flow, loads)),
        (continue_from_zero, (model.network, flow, loads)),
    ]


def driving(model: Model) -> list[Call]:
    """Kernels that prepare a step, and that carry it out."""
    flow, trains = start(model)
    state, recording = new_state(model, trains), new_recording(model, 0, trains.size)
    train, kind, step = trains[0], model.types[0], switch(0)
    return [
        (decide, (step, flow.standing, trains, sight_of(model))),
        (take_speed, (1.0, kind, train, model.machine[0], model.points)),
        (shortest_stop, (1.0, 1.0, 1.0)),
        (begin_plan, (train, model)),
        (move_on_course, (step, train, model, state)),
        (stand_at_stop, (step, train, model)),
        (list_trains, (trains, flow)),
        (record_instant, (step, trains, recording)),
    ]


def start(model: Model) -> tuple[Any, Any]:
    """A load flow's state and a train, as they are before a run."""
    trains = train_records([Train("", "", train_type=0, route=0, departure_step=0)], 0.0)
    return new_state(model, trains).flow, trains


def compile_calls(calls: list[Call]) -> None:
    """Compile each kernel for its arguments, or load it from the cache, without running it."""
    for function, arguments in calls:
        if hasattr(function, "compile"):  # not if compilation is switched off
            function.compile(tuple(numba.typeof(argument) for argument in arguments))
