"""One step's forces, voltages and powers, solved together until every driver's decision stands.

Whether a train must start to brake for its stop depends on the acceleration that the solution gives
it.  So the step is solved, trains that would come too near to their stop are put on their braking
plan, and the step is solved again; each round puts at least one more train on its plan.
"""

from tpss.driving.data import DrivingData
from tpss.driving.driver import aim
from tpss.driving.manners import apply_solution, must_replan, replan
from tpss.kernel import at, inlined, kernel
from tpss.numerics.pairs import magnitude
from tpss.powerflow.network import Loads, Standing
from tpss.powerflow.solve import solve
from tpss.record import Records
from tpss.step.model import Model, driving_data
from tpss.step.state import State
from tpss.vehicle.demand import electrical_demand
from tpss.vehicle.train import Phase, Train


@inlined
def solve_step(count: int, warm: bool, model: Model, state: State) -> tuple[float, int]:
    """Solve this step for the first `count` trains of `state.flow.standing`.

    Parameters
    ----------
    count : int
        Number of trains on the line.
    warm : bool
        Whether the state of the step before may serve as a start.

    Returns
    -------
    share : float
        1.0, or the share of the load that the line can carry.
    passes : int
        Evaluations of the network.
    """
    passes = 0
    while True:
        decide(count, state.flow.standing, state.trains, driving_data(model))
        share, more = solve_network(count, warm, model, state)
        passes += more
        if share < 1.0 or apply_solutions(count, model, state):
            return share, passes
        warm = True


@kernel
def decide(
    count: int, standing: Records[Standing], trains: Records[Train], data: DrivingData
) -> None:
    """Let those drivers decide who have not done so in this step, of the first `count` trains."""
    for k in range(count):
        train = trains[at(standing[at(k)].train)]
        if not train.decision.decided:
            aim(train, data)
            train.decision.decided = True


@inlined
def apply_solutions(count: int, model: Model, state: State) -> bool:
    """Apply the voltages of a solution to the trains; return whether every decision stands.

    If not, some trains are to brake otherwise, and the step has to be solved again.
    """
    stands, data = True, driving_data(model)
    for k in range(count):
        train = state.trains[at(state.flow.standing[at(k)].train)]
        kind = model.types[at(train.train_type)]
        # Of the last pass, as the powers: near a knee the last roundings of the voltage count.
        train.forces.tractive_n = min(train.demand.wheel_force_n, train.demand.adhesion_n)
        train.forces.braking_n = 0.0
        if train.motion.phase == Phase.DWELLING:
            train.forces.next_speed_m_s = 0.0
            continue
        apply_solution(train, kind, model.options)
        if must_replan(train, kind, data):
            replan(train, kind, data)
            train.decision.decided = False
            stands = False
    return stands


@inlined
def solve_network(count: int, warm: bool, model: Model, state: State) -> tuple[float, int]:
    """Voltages at all pantographs: by the load flow, or fixed if the model says so."""
    fixed_v, flow = model.control.fixed_voltage_v, state.flow
    if fixed_v > 0.0:
        for k in range(count):
            train = state.trains[at(flow.standing[at(k)].train)]
            train.demand.voltage_v = fixed_v
            flow.standing[at(k)].voltage_v = fixed_v
            kind = model.types[at(train.train_type)]
            electrical_demand(fixed_v, kind, train.demand, state.scratch)
        return 1.0, 0
    loads = Loads(state.trains, model.types, state.scratch)
    share, passes = solve(warm, model.network, flow, loads)
    for k in range(count):
        place = flow.standing[at(k)]
        state.trains[at(place.train)].demand.voltage_v = magnitude(place.voltage_v)
    return share, passes
