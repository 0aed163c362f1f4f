"""Compiled kernels before the first step: a cold start on two cores.

The kernels are compiled by two processes at once: first the load flow, and what prepares and carries
out a step, which have little in common; then the clock, which calls both, and the audit.  The search
for a solution that no usual start finds is not among them: it is compiled when a line needs it.

The second process keeps what it compiles in a cache folder of its own, as two that write into one may
spoil each other's entries.  The first one adopts from it whatever itself does not have.  Where a second
process is of no use or does not succeed, the first one compiles everything, a little later.
"""

import os
import pickle
import subprocess
import sys
import tempfile
import threading
from pathlib import Path
from typing import Any

import numpy as np

from tpss.audit.aggregate import gather, new_figures
from tpss.driving.braking import shortest_stop
from tpss.driving.stops import stand_at_stop
from tpss.driving.whole_steps import replan
from tpss.driving.within_step import replan as replan_within
from tpss.events import tell
from tpss.kernel import (
    cache_folder,
    compile_for,
    kernels_are_compiled,
    plain,
    switch,
)
from tpss.powerflow.chain import WARM
from tpss.powerflow.network import Network
from tpss.powerflow.newton import MOST_PASSES, newton
from tpss.powerflow.solve import answer
from tpss.run.run import Clock, Run
from tpss.run.services import ScheduledTrain, train_records
from tpss.step.advance import advance, change_length, prepare_trains, separate_trains
from tpss.step.coupling import decide
from tpss.step.model import Model, driving_data
from tpss.step.record import record_instant, record_trains
from tpss.step.recording import new_recording
from tpss.step.state import State, loads_in_python, new_state
from tpss.vehicle.demand import update_speed_terms

Call = tuple[Any, tuple[Any, ...]]
"""A kernel, and arguments of the types with which the clock calls it."""


_ready: set[tuple[Clock, tuple[bool, ...]]] = set()
"""Clocks all of whose kernels this process has compiled or loaded, and with which `optional_parts`."""

_one_at_a_time = threading.Lock()


def optional_parts(network: Network) -> tuple[bool, ...]:
    """Which parts that most networks lack one has: kernels are compiled without or with them."""
    return tuple(len(part) > 0 for part in network if isinstance(part, tuple))


def make_ready(model: Model, clock: Clock = advance) -> None:
    """Compile all kernels of a run, or load them from the cache, once in this process.

    What another clock than `advance` calls one by one is compiled by a step without trains.

    Parameters
    ----------
    model : Model
        Any: all have the same types, but for parts of the network that most lack, see
        `kernel.where_any`.
    clock : callable
        What runs the steps.
    """
    kernels = clock, optional_parts(model.network)
    with _one_at_a_time:
        if kernels in _ready:
            return
        if not are_ready():
            tell("compiling")
        if not are_ready() and (os.cpu_count() or 1) > 1 and sys.executable:
            _compile_in_parts(model)
        Run(model, [], 0).advance_to(0)
        if clock is not advance:
            Run(model, [], 1, clock).advance_to(1)
        compile_calls(figures_calls(model))
        _ready.add(kernels)


def are_ready() -> bool:
    """Whether all kernels of exactly this source are compiled; those of the audit are the last."""
    return kernels_are_compiled(gather.__name__)


def load_flow_calls(model: Model) -> list[Call]:
    """The kernel that solves a load flow, with all that it calls."""
    state = _start(model)
    loads = loads_in_python(model, state)
    return [(newton, (1.0, WARM, MOST_PASSES, model.network, state.flow, loads))]


def search_calls(model: Model) -> list[Call]:
    """The kernel that searches for a solution which no usual start finds."""
    ((_, arguments),) = load_flow_calls(model)
    return [(answer, arguments[-3:])]


def step_calls(model: Model) -> list[Call]:
    """Kernels that prepare a step, and that carry it out."""
    state, data = _start(model), plain(driving_data)(model)
    recording = new_recording(model, 0, state.trains.size)
    train, kind, step = state.trains[0], model.types[0], switch(0)
    on_line = (state.flow.standing, state.trains)
    of_trains = (recording.trains, recording.train_state, recording.calls, recording.counters)
    besides = recording.without_power_s, recording.regeneration
    return [
        (decide, (step, *on_line, data, model.points)),
        (update_speed_terms, (1.0, kind, train.demand, model.points, state.scratch)),
        (shortest_stop, (1.0, 1.0, 1.0)),
        (replan, (train, kind, data)),
        (replan_within, (train, kind, data)),
        (stand_at_stop, (step, 1.0, train, model.stops)),
        (separate_trains, (step, step, model, state, recording)),
        (change_length, (step, 1.0, model, state, recording)),
        (prepare_trains, (step, *on_line, data, model.points, state.scratch)),
        (
            record_trains,
            (step, step, 1.0, 1.0, model.types, model.points, *on_line, *of_trains, *besides),
        ),
        (record_instant, (step, state.trains, recording)),
    ]


def figures_calls(model: Model) -> list[Call]:
    """Kernels that gather the figures of a run and audit it."""
    trains = _start(model).trains
    recording, blank = new_recording(model, 0, trains.size), new_figures(model, trains.size, [])
    at_line_level = np.zeros(model.network.source_of_node.size, dtype=bool)
    return [(gather, (0, 0, 0, 0.0, 0, 0, at_line_level, trains, model, recording, blank))]


def _start(model: Model) -> State:
    """State of a run with one train."""
    trains = [ScheduledTrain("", "", train_type=0, route=0, departure_step=0)]
    return new_state(model, train_records(trains, 0.0))


def compile_calls(calls: list[Call], by_kernels: bool = False) -> None:
    """Compile each kernel for its arguments, or load it from the cache, without running it.

    Parameters
    ----------
    by_kernels : bool
        Only other kernels call it, not Python.
    """
    for function, arguments in calls:
        compile_for(function, arguments, by_kernels)


def _compile_in_parts(model: Model) -> None:
    """Compile all kernels with the help of a second process."""
    folder = cache_folder()
    with tempfile.TemporaryDirectory(prefix="part-", dir=folder) as apart:
        environment = {**os.environ, "NUMBA_CACHE_DIR": apart}
        command = [sys.executable, "-m", "tpss.run.kernels"]
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
        theirs = Path(apart) / "tpss" / folder.name
        with subprocess.Popen(command, env=environment, **pipes) as second:  # type: ignore[call-overload]
            try:
                _send(model, second)
                compile_calls(load_flow_calls(model), by_kernels=True)
                second.stdout.readline()  # it has compiled what the clock calls, or has ended
                adopt(theirs, folder)
                Run(model, [], 0).advance_to(0)
                second.wait()
            finally:
                second.kill()
        adopt(theirs, folder)


def _help(model: Model) -> None:
    """The second process: compile what the clock calls, say so, then what audits a run."""
    compile_calls(step_calls(model), by_kernels=True)
    print("step", flush=True)
    compile_calls(figures_calls(model))


def _send(model: Model, process: "subprocess.Popen[bytes]") -> None:
    assert process.stdin is not None
    try:
        with process.stdin as stdin:
            pickle.dump(model, stdin)
    except BrokenPipeError:
        pass  # it has ended already; all is compiled here


def adopt(apart: Path, folder: Path) -> None:
    """Move compiled kernels into a cache folder that does not know them.

    Of a kernel that both know, nothing is moved: entries of one index must be of one origin.
    """
    for index in sorted(apart.rglob("*.nbi")):
        target = folder / index.relative_to(apart)
        if not target.exists():
            target.parent.mkdir(parents=True, exist_ok=True)
            for code in index.parent.glob(f"{index.stem}.*.nbc"):
                code.replace(target.parent / code.name)
            index.replace(target)


if __name__ == "__main__":
    _help(pickle.load(sys.stdin.buffer))
