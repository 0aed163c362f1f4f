"""TPSS: a loop in compiled code, as a simulation runs it, and one in Python.

As in a simulation, a solve starts from the straight line through the last two solutions.
"""

import math
from dataclasses import replace

import numpy as np

from tpss.kernel import kernel
from tpss.physics.reactive_power import ReactiveModel
from tpss.powerflow.assembly import new_flow
from tpss.powerflow.chain import WARM
from tpss.powerflow.network import Flow, Loads, Network, loads_alone
from tpss.powerflow.newton import MOST_PASSES, Solution, newton
from tpss.powerflow.placing import locate_trains, measure_pieces
from tpss.powerflow.raising import start_flat
from tpss.powerflow.solve import predict, remember
from tpss.record import Records
from tpss.track.leg import Leg, along_one_line
from tpss.vehicle.train import Train
from tpss.vehicle.train_type import TrainType

from load_flow.case import BASE_VOLTAGE_V, TOLERANCE, Case, Complexes, Floats, Run, build_network


@kernel
def take_step(step: int, position_m: Floats, power_va: Complexes, loads: Loads) -> None:
    """Put all trains to their places in a step, with their loads of that step."""
    for k in range(loads.trains.size):
        train = loads.trains[k]
        train.motion.position_m = position_m[step, k]
        train.demand.cap_power_w = power_va[step, k].real
        train.demand.reactive_ratio = power_va[step, k].imag / power_va[step, k].real


@kernel
def note_voltages(flow: Flow, voltage: Complexes) -> None:
    nodes = flow.nodes.size
    for n in range(nodes):
        voltage[n] = flow.nodes[n].voltage_v / BASE_VOLTAGE_V
    for k in range(flow.standing.size):
        voltage[nodes + k] = flow.standing[k].voltage_v / BASE_VOLTAGE_V


@kernel
def remember_flat(flow: Flow) -> None:
    remember(True, flow)


@kernel
def solve_steps(
    position_m: Floats, power_va: Complexes, legs: Records[Leg], network: Network, flow: Flow,
    loads: Loads, voltage: Complexes,
) -> int:  # fmt: skip
    """Solve all steps; return the number of passes over the network, or -1 after a failure."""
    total = 0
    for step in range(position_m.shape[0]):
        take_step(step, position_m, power_va, loads)
        locate_trains(loads.trains.size, loads.trains, legs, network, flow)
        measure_pieces(loads.trains.size, network, flow)
        predict(flow)
        status, passes = newton(1.0, WARM, MOST_PASSES, network, flow, loads)
        if status != Solution.SOLVED:
            return -1
        total += passes
        remember(False, flow)
        note_voltages(flow, voltage[step])
    return total


def constant_loads(trains: int) -> Loads:
    """Trains that nothing but their driver limits, so that each draws a power of its own."""
    kind, rows = TrainType.blank(1), Train.blank(trains)
    kind.reactive_model, demand = ReactiveModel.POWER_FACTOR, rows.demand
    demand.per_efficiency, demand.force_cap_n, demand.free_band_v = 1.0, 1.0, math.inf
    return loads_alone(rows, kind)


def start(case: Case) -> tuple[Records[Leg], Network, Flow, Loads]:
    """The state without load, which the first run of a loop begins from."""
    flow, loads = new_flow(case.network, case.trains), constant_loads(case.trains)
    start_flat(case.network, flow)
    remember_flat(flow)
    legs = along_one_line(case.network.sections.size)
    return legs, case.network._replace(tolerance=TOLERANCE), flow, loads


def prepare_compiled(case: Case) -> Run:
    """All steps in one call."""
    state, voltage = start(case), np.zeros((case.steps, case.buses), dtype=complex)

    def run() -> Complexes:
        passes = solve_steps(case.position_m, case.power_va, *state, voltage)
        assert passes > 0
        return voltage

    return run


def prepare_called(case: Case) -> Run:
    """A call from Python for each step."""
    state, voltage = start(case), np.zeros((case.steps, case.buses), dtype=complex)

    def run() -> Complexes:
        for step in range(case.steps):
            one = slice(step, step + 1)
            passes = solve_steps(case.position_m[one], case.power_va[one], *state, voltage[one])
            assert passes > 0
        return voltage

    return run


def prepare_with_converters(case: Case) -> Run:
    """All steps in one call, with the converter law in place of the ideal sources."""
    return prepare_compiled(replace(case, network=build_network()))


def passes_a_step(case: Case) -> float:
    """Mean number of passes over the network, from the solution of the step before."""
    state, voltage = start(case), np.zeros((case.steps, case.buses), dtype=complex)
    solve_steps(case.position_m, case.power_va, *state, voltage)
    return solve_steps(case.position_m, case.power_va, *state, voltage) / case.steps
