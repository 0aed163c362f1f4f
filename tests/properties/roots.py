"""The root that loads raised from zero in small steps lead to: a second opinion on a run."""

import copy
from typing import Any

import numpy as np
import numpy.typing as npt

from tpss import Scenario
from tpss.model import build_model
from tpss.model.traffic import build_services
from tpss.physics.constants import BASE_VOLTAGE_V
from tpss.powerflow.chain import FLAT, WARM
from tpss.powerflow.network import Loads
from tpss.powerflow.newton import HIGHEST_VOLTAGE, SOLVED, newton
from tpss.powerflow.solve import start_flat
from tpss.simulation.advance import begin_step
from tpss.simulation.coupling import settle
from tpss.simulation.driver import decide
from tpss.simulation.run import Run, trains_on_line
from tpss.simulation.state import Model, State, sight_of
from tpss.simulation.timetable import departing_trains
from tpss.simulation.traffic import begin_plan, must_plan

from benchmarks.continuation import Equations, carry

RISE = 0.04
"""Share of the load by which it is raised at a time. [1]"""

FINEST = 2e-4
"""Where not even this much more can be carried, the branch has ended. [1]"""

ALMOST = 0.99
"""Of the highest plausible voltage: from here on, it was too high a voltage that ended the branch."""


class Replay:
    """A scenario's run, done again, to look into single steps of it in ascending order."""

    def __init__(self, scenario: Scenario, steps: int) -> None:
        model, _ = build_model(scenario)
        services = build_services(scenario, model)
        trains = trains_on_line(model, services)
        trains += departing_trains(services, model.options.step_s, 0, steps)
        self.run = Run(model, trains, steps)

    def root_of_step(self, step: int) -> tuple[float, npt.NDArray[np.float64]]:
        """Share of a step's load that is carried, and each train's pantograph voltage (NaN: none)."""
        run = self.run
        run.advance_to(step)
        untouched = copy.deepcopy(run.state)
        count = begin_step(step, run.model, run.state, run.recording)
        share = solve_step_slowly(count, run.model, run.state)
        places = run.state.flow.standing[:count]
        voltages = np.full(len(run.trains), np.nan)
        voltages[places.train] = np.abs(places.voltage_v)
        run.state = untouched
        return share, voltages


def solve_step_slowly(count: int, model: Model, state: State) -> float:
    """As the clock does it, but every load flow begins without load; return the share carried."""
    while True:
        decide(count, state.flow.standing, state.trains, sight_of(model))
        share = raise_loads(model, state)
        if share < 1.0:
            return share
        planned = False
        for place in state.flow.standing[:count]:
            train = state.trains[place.train]
            train.voltage_v = abs(place.voltage_v)
            settle(train, model)
            if must_plan(train, model):
                begin_plan(train, model)
                train.decided = False
                planned = True
        if not planned:
            return share


def raise_loads(model: Model, state: State) -> float:
    """Raise all loads from zero; return the share that is carried."""
    share = raise_loads_within_the_band(model, state)
    flow = state.flow
    standing = flow.standing[: flow.sections.end[-1]]
    voltage_v = np.concatenate([flow.nodes.voltage_v, standing.voltage_v])
    if share < 1.0 and np.abs(voltage_v).max() > ALMOST * HIGHEST_VOLTAGE * BASE_VOLTAGE_V:
        return raise_loads_beyond_the_band(share, standing, model, state)
    return share


def raise_loads_beyond_the_band(share: float, standing: Any, model: Model, state: State) -> float:
    """Follow the path of another load flow, past voltages too high; a whole load has to return.

    What filters feed into a weak line lifts the voltages most at some part of the load, and the whole of
    it may bring them back into the plausible band.
    """
    loads = Loads(state.trains, model.types, model.machine)
    equations = Equations.of(model.network, state.flow._replace(standing=standing), loads)
    whole, voltage = carry(equations, highest=np.inf)
    if whole < 1.0 or np.abs(voltage).max() > HIGHEST_VOLTAGE:
        return share
    standing.voltage_v = BASE_VOLTAGE_V * voltage[equations.nodes :]
    return whole


def raise_loads_within_the_band(model: Model, state: State) -> float:
    """Raise all loads little by little, while all voltages are plausible."""
    flow = state.flow
    loads = Loads(state.trains, model.types, model.machine)
    start_flat(flow)
    share, rise, start = 0.0, RISE, FLAT
    while share < 1.0 and rise > FINEST:
        before: list[Any] = [flow.nodes.voltage_v.copy(), flow.sections.current_a.copy()]
        target = min(1.0, share + rise)
        status, _ = newton(target, start, model.network, flow, loads)
        if status == SOLVED:
            share, start = target, WARM
        else:
            flow.nodes.voltage_v, flow.sections.current_a = before
            rise /= 2.0
    return share
