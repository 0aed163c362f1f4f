"""One step's forces, voltages and powers, solved together until every driver's decision stands.

Whether a train must start to brake for its stop depends on the acceleration that the solution gives
it.  So the step is solved, trains that would come too near to their stop are put on their braking
plan, and the step is solved again; each round puts at least one more train on its plan.
"""

from tpss.driving.continuous import apply_passage, must_pass, pass_instead
from tpss.driving.data import DrivingData, MotionModel
from tpss.driving.driver import aim
from tpss.driving.manners import apply_solution, must_replan, replan
from tpss.kernel import at, inlined, kernel
from tpss.numerics.curve import Points
from tpss.numerics.pairs import magnitude
from tpss.powerflow.load import WITHOUT_SLOPES, find_demand, runs_on_store
from tpss.powerflow.network import Loads, Standing
from tpss.powerflow.placing import is_unfed
from tpss.powerflow.solve import ASKS, solve_or_ask
from tpss.record import Records
from tpss.step.model import Model, driving_data
from tpss.step.state import State, loads_of
from tpss.vehicle.train import Course, Phase, Train
from tpss.vehicle.train_type import TrainType


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
        1.0, or the share of the load that the line can carry; or `ASKS`: once the search is
        done, a second call goes on.
    passes : int
        Evaluations of the network.
    """
    passes = 0
    if state.clock[0].unfed > 0:
        prepare_unfed(count, model, state)
    while True:
        decide(count, state.flow.standing, state.trains, driving_data(model), model.points)
        share, more = solve_network(count, warm, model, state)
        passes += more
        if share == 1.0 and state.clock[0].unfed > 0:
            pass_unfed(count, model, state)
        if share < 1.0 or apply_solutions(count, model, state):
            return share, passes
        warm = True


@kernel
def prepare_unfed(count: int, model: Model, state: State) -> None:
    """Let trains that no station reaches pass through the step: they coast, brake, and stand."""
    for k in range(count):
        place = state.flow.standing[at(k)]
        if is_unfed(place.section, model.network):
            pass_instead(state.trains[at(place.train)])


@kernel
def pass_unfed(count: int, model: Model, state: State) -> None:
    """Find the ways of the trains that no station reaches, at no voltage, or on their own stores.

    What is kept as their voltage for the next step, where they may be fed again, is the nominal one.
    """
    nominal_v, loads = model.network.system.nominal_voltage_v, loads_of(model, state)
    for k in range(count):
        place = state.flow.standing[at(k)]
        if is_unfed(place.section, model.network):
            train = state.trains[at(place.train)]
            if not runs_on_store(nominal_v, train, loads):
                find_demand(0.0, WITHOUT_SLOPES, train, loads)
            train.line_voltage_v = nominal_v
            train.demand.voltage_v = nominal_v


@kernel
def decide(
    count: int,
    standing: Records[Standing],
    trains: Records[Train],
    data: DrivingData,
    points: Points,
) -> None:
    """Let those drivers decide who have not done so in this step, of the first `count` trains."""
    for k in range(count):
        train = trains[at(standing[at(k)].train)]
        if not train.decision.decided:
            aim(train, data, points)
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
        if train.decision.course == Course.PASSAGE:
            apply_passage(train, model.options.step_s)
            continue
        # Of the last pass, as the powers: near a knee the last roundings of the voltage count.
        train.forces.tractive_n = min(train.demand.wheel_force_n, train.demand.adhesion_n)
        train.forces.braking_n = 0.0
        if train.motion.phase == Phase.DWELLING:
            train.forces.next_speed_m_s = 0.0
            continue
        apply_solution(train, kind, model.options)
        if _must_decide_anew(train, kind, data):
            train.decision.decided = False
            stands = False
    return stands


@inlined
def _must_decide_anew(train: Train, kind: TrainType, data: DrivingData) -> bool:
    """Whether a decision does not stand; then it is told how to decide."""
    if data.options.motion == MotionModel.CONTINUOUS:
        if must_pass(train, kind, data):
            pass_instead(train)
            return True
        return False
    if must_replan(train, kind, data):
        replan(train, kind, data)
        return True
    return False


@kernel
def fix_voltage(voltage_v: float, count: int, standing: Records[Standing], loads: Loads) -> None:
    """Let a voltage be that at all pantographs, and find what the trains draw there."""
    for k in range(count):
        train = loads.trains[at(standing[at(k)].train)]
        train.demand.voltage_v = voltage_v
        standing[at(k)].voltage_v = voltage_v
        find_demand(voltage_v, WITHOUT_SLOPES, train, loads)


@inlined
def solve_network(count: int, warm: bool, model: Model, state: State) -> tuple[float, int]:
    """Voltages at all pantographs: by the load flow, or fixed if the model says so."""
    fixed_v, flow = model.control.fixed_voltage_v, state.flow
    if fixed_v > 0.0:
        fix_voltage(fixed_v, count, flow.standing, loads_of(model, state))
        return 1.0, 0
    loads = loads_of(model, state)
    share, passes = solve_or_ask(warm, model.network, flow, loads)
    if share == ASKS:
        return share, passes
    for k in range(count):
        place = flow.standing[at(k)]
        train = state.trains[at(place.train)]
        train.line_voltage_v = place.voltage_v
        train.demand.voltage_v = magnitude(place.voltage_v)
    return share, passes
