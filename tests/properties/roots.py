"""The root that loads raised from zero in small steps lead to: a second opinion on a run."""

import copy
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from tpss import Scenario
from tpss.kernel import plain
from tpss.model import build_model
from tpss.model.start import start_of
from tpss.powerflow.bundles import NO_BUNDLE_FLOW, NO_BUNDLES
from tpss.powerflow.chain import FLAT, WARM
from tpss.powerflow.network import UNFED
from tpss.powerflow.newton import MOST_PASSES, Solution, newton
from tpss.powerflow.raising import start_flat
from tpss.run.already_running import trains_on_line
from tpss.run.relays import Trip
from tpss.run.run import Run, run_of, switch
from tpss.run.services import departing_trains
from tpss.step.advance import begin_step, change_length, prepare_step
from tpss.step.coupling import apply_solutions, decide, pass_unfed, prepare_unfed
from tpss.step.model import Model, driving_data, with_step
from tpss.step.sparing import allow_currents
from tpss.step.state import State, loads_in_python

from benchmarks.continuation import Equations
from benchmarks.homotopy import End, is_sound, loads_last, sources_last

Raising = Callable[[Model, State], float]
"""A way to raise all loads from zero; gives the share that is carried."""

RISE = 0.04
"""Share of the load by which it is raised at a time. [1]"""

FINEST = 2e-4
"""Where not even this much more can be carried, the branch has ended. [1]"""

MOST_TRAINS = 200
"""On more, another load flow's paths are not followed: its matrices are dense.  Nor does it know nodes
without a source, or that follow others, conductors beside the contact line, or stores of energy."""


class Replay:
    """A scenario's run, done again, to look into single steps of it in ascending order."""

    def __init__(self, scenario: Scenario, steps: int, trips: Sequence[Trip] = ()) -> None:
        model, _ = build_model(scenario)
        start = start_of(scenario, model)
        if trips:
            start = start.with_trips(trips)
        self.switchings = start.switchings
        self.control = start.model.control
        control = self.control._replace(studied_train=model.control.studied_train)
        model = start.model._replace(control=control)  # with types that use spare time
        if start.turns is not None:  # for the trains of the run, no others
            self.run = run_of(replace(start, model=model))
            return
        trains = trains_on_line(model, start.services)
        trains += departing_trains(start.services, model.options, 0, steps)
        self.run = Run(model, trains, steps)

    def root_of_step(
        self, step: int, step_s: float, raising: Raising | None = None
    ) -> tuple[float, npt.NDArray[np.float64]]:
        """Share of a step's load that is carried, and each train's pantograph voltage.

        NaN where the share is not known, or a train draws nothing.  The step may be shorter than the
        others; a train that would depart later is not on the line.
        """
        run = self.run
        self.go_to(step)
        untouched = copy.deepcopy(run.state)
        clock = run.state.clock[0]
        if run.model.control.spares_motors:
            allow_currents(step, run.model.options.step_s, run.model, run.state)
        clock.on_line = begin_step(step, run.model, run.state, run.recording)
        change_length(step, step_s, run.model, run.state, run.recording)
        count, model = clock.on_line, plain(with_step)(run.model, step_s)
        prepare_step(count, model, run.state)
        share = solve_step_slowly(count, model, run.state, raising or raise_loads)
        places = run.state.flow.standing[:count]
        voltages = np.full(len(run.trains), np.nan)
        voltages[places.train] = np.abs(places.voltage_v)
        run.state = untouched
        return share, voltages

    def go_to(self, step: int) -> None:
        """Bring the run to the beginning of a step."""
        while (until := switch(self.run, self.switchings, step)) > self.run.step:
            self.run.advance_to(until)

    def tried_s(self, step: int) -> float:
        """Length at which a step was given up: one that would end with an arrival is tried shorter. [s]

        Means over less time are higher, so it may be that only the shorter step has no solution.
        """
        run = self.run
        self.go_to(step)
        untouched = copy.deepcopy(run.state)
        model = run.model._replace(control=self.control)
        run.clock(step, step + 1, model, run.state, run.recording)
        length_s = float(run.state.clock[0].last_step_s)
        run.state = untouched
        return length_s


def solve_step_slowly(count: int, model: Model, state: State, raising: Raising) -> float:
    """As the clock does it, but every load flow begins without load; return the share carried."""
    if state.clock[0].unfed > 0:
        prepare_unfed(count, model, state)
    while True:
        decide(count, state.flow.standing, state.trains, plain(driving_data)(model), model.points)
        share = raising(model, state)
        if share != 1.0:
            return share
        for place in state.flow.standing[:count]:
            state.trains[place.train].demand.voltage_v = abs(place.voltage_v)
        if state.clock[0].unfed > 0:
            pass_unfed(count, model, state)
        if apply_solutions(count, model, state):
            return share


def raise_loads(model: Model, state: State) -> float:
    """Raise all loads from zero; return the share that is carried."""
    share = raise_loads_within_the_band(model, state)
    return share if share == 1.0 else raise_loads_by_homotopy(share, model, state)


def follow_paths(model: Model, state: State) -> float:
    """Follow the paths of another load flow, whatever is found within the band."""
    return raise_loads_by_homotopy(math.nan, model, state)


def raise_loads_by_homotopy(share: float, model: Model, state: State) -> float:
    """Follow the paths of another load flow, from stations made alike, where those above have ended.

    Stations far apart have no solution without load near base voltage.  What filters feed into a weak
    line may lift the voltages out of the band at some part of the load, and back at the whole of it.
    Return NaN where these have lost their way, and so know nothing, or would take minutes.
    """
    standing = state.flow.standing[: state.flow.sections.end[-1]]
    if standing.size > MOST_TRAINS or (model.network.source_of_node <= UNFED).any():
        return math.nan
    if model.network.bundles != NO_BUNDLES or model.network.stores.size:
        return math.nan
    loads = loads_in_python(model, state)
    equations = Equations.of(model.network, state.flow._replace(standing=standing), loads)
    ends = [loads_last(equations), sources_last(equations)]
    for found in ends:
        if found.voltage is not None and is_sound(equations, found.voltage):
            nodes, base_v = equations.nodes, model.network.system.base_voltage_v
            state.flow.nodes.voltage_v = base_v * found.voltage[:nodes]
            standing.voltage_v = base_v * found.voltage[nodes:]
            return 1.0
    return math.nan if all(found.end == End.LOST for found in ends) else share


def raise_loads_within_the_band(model: Model, state: State) -> float:
    """Raise all loads little by little, while all voltages are plausible."""
    flow = state.flow
    loads = loads_in_python(model, state)
    start_flat(model.network, flow)
    share, rise, start = 0.0, RISE, FLAT
    while share < 1.0 and rise > FINEST:
        before: list[Any] = [flow.nodes.voltage_v.copy(), flow.sections.current_a.copy()]
        bundled = flow.bundles.voltage_v.copy() if flow.bundles != NO_BUNDLE_FLOW else None
        target = min(1.0, share + rise)
        status, _ = newton(target, start, MOST_PASSES, model.network, flow, loads)
        if status == Solution.SOLVED:
            share, start = target, WARM
        else:
            flow.nodes.voltage_v, flow.sections.current_a = before
            if bundled is not None:
                flow.bundles.voltage_v[:] = bundled
            rise /= 2.0
    return share
