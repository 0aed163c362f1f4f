"""One step's forces, voltages and powers, solved together until every driver's decision stands.

Whether a train must start to brake for its stop depends on the acceleration that the solution gives
it.  So the step is solved, trains that would come too near to their stop are put on their braking
plan, and the step is solved again; each round puts at least one more train on its plan.
"""

from typing import Any

from tpss.kernel import at, inlined
from tpss.physics.locomotive import acceleration, electrical_demand
from tpss.powerflow.network import Loads
from tpss.powerflow.pairs import magnitude
from tpss.powerflow.solve import solve
from tpss.simulation.driver import decide
from tpss.simulation.state import DWELLING, Model, State, is_on_course, sight_of
from tpss.simulation.stopping import settle_course
from tpss.simulation.traffic import begin_plan, must_plan


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
        decide(count, state.flow.standing, state.trains, sight_of(model))
        share, more = solve_network(count, warm, model, state)
        passes += more
        if share < 1.0 or settle_all(count, model, state):
            return share, passes
        warm = True


@inlined
def settle_all(count: int, model: Model, state: State) -> bool:
    """Settle the trains at the voltages of a solution; return whether every decision stands.

    If not, some trains have been put on their braking plan, and the step has to be solved again.
    """
    stands = True
    for k in range(count):
        train = state.trains[at(state.flow.standing[at(k)].train)]
        settle(train, model)
        if must_plan(train, model):
            begin_plan(train, model)
            train.decided = False
            stands = False
    return stands


@inlined
def solve_network(count: int, warm: bool, model: Model, state: State) -> tuple[float, int]:
    """Voltages at all pantographs: by the load flow, or fixed if the model says so."""
    fixed_v, flow = model.options.fixed_voltage_v, state.flow
    if fixed_v > 0.0:
        for k in range(count):
            train = state.trains[at(flow.standing[at(k)].train)]
            train.voltage_v = fixed_v
            flow.standing[at(k)].voltage_v = fixed_v
            electrical_demand(fixed_v, model.types[at(train.train_type)], train, state.machine[0])
        return 1.0, 0
    loads = Loads(state.trains, model.types, state.machine)
    share, passes = solve(warm, model.network, flow, loads)
    for k in range(count):
        place = flow.standing[at(k)]
        state.trains[at(place.train)].voltage_v = magnitude(place.voltage_v)
    return share, passes


@inlined
def settle(train: Any, model: Model) -> None:
    """Force, brakes and next speed of a train at the voltage of the solution.

    With motors off the train brakes with exactly the wanted acceleration; below its wanted force it
    takes what the machine gives and the rails pass on.

    References
    ----------
    [Boullanger2009]_, eq. (2.7), (2.11), (F.19), (F.20).
    """
    kind = model.types[at(train.train_type)]
    # Of the load flow's last pass, as the powers: near a knee the last roundings of the voltage count.
    force, wanted = min(train.wheel_force_n, train.adhesion_n), train.wanted_force_n
    train.force_n = force
    train.braking_force_n = 0.0
    if train.phase == DWELLING:
        train.next_speed_m_s = 0.0
    elif is_on_course(train.course):
        settle_course(train, kind, model.options.step_s)
    elif force >= wanted or wanted <= 0.0:
        train.next_speed_m_s = train.target_speed_m_s
        train.braking_force_n = max(0.0, -wanted)
    else:
        a = acceleration(force, train.resistance_n, kind.inertia_kg)
        train.next_speed_m_s = train.speed_m_s + a * model.options.step_s
