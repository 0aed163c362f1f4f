"""What a train asks of the network, however it moves."""

import numpy as np

from tpss.driving.passage import demand_of_passage
from tpss.kernel import at, inlined, kernel
from tpss.powerflow.network import Loads
from tpss.vehicle.at_load import follow_load
from tpss.vehicle.demand import electrical_demand
from tpss.vehicle.feed_back import asks_more, feed_back
from tpss.vehicle.on_board import exchange_with_store, has_store
from tpss.vehicle.train import Course, Train

WITHOUT_SLOPES: bool = np.bool_(False)  # type: ignore[assignment]
"""As `with_slopes`, where it is known; see `kernel.switch`."""


@inlined
def find_demand(
    voltage_v: float, with_slopes: bool, train: Train, loads: Loads
) -> tuple[float, float, float, float]:
    """Active and reactive power of a train at a voltage, and their slopes: P, Q, P', Q'.

    [W], [var], [W/V], [var/V]

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph. [V]
    with_slopes : bool
        Whether the slopes are asked for; else they may be anything.
    train : Train
        Written: force and powers.
    loads : Loads
    """
    kind = loads.types[at(train.train_type)]
    if asks_more(kind):
        return demand_with_brakes(voltage_v, with_slopes, train, loads)
    if train.decision.course == Course.PASSAGE:
        return demand_of_passage(
            voltage_v, with_slopes, train, kind, loads.driving, loads.points, loads.scratch
        )
    return electrical_demand(voltage_v, kind, train.demand, loads.scratch)


@kernel
def demand_with_brakes(
    voltage_v: float, with_slopes: bool, train: Train, loads: Loads
) -> tuple[float, float, float, float]:
    """`find_demand` of a train with electric brakes, a store, or an efficiency that follows the load.

    A function of its own: the others are compiled as if there were none.

    References
    ----------
    [EN50163]_, as `vehicle.regeneration.taken_share`.
    """
    kind, demand = loads.types[at(train.train_type)], train.demand
    if train.decision.course == Course.PASSAGE:
        p, q, p_slope, q_slope = demand_of_passage(
            voltage_v, with_slopes, train, kind, loads.driving, loads.points, loads.scratch
        )
        per_second = 1.0 / loads.driving.options.step_s
        demand.electric_power_w = train.passage.electric_j * per_second
        demand.offered_power_w = train.passage.offered_j * per_second
    else:
        p, q, p_slope, q_slope = electrical_demand(voltage_v, kind, demand, loads.scratch)
        if kind.over_load.count > 0:
            p, p_slope = follow_load(p, p_slope, demand.driven_share, kind, demand)
    if has_store(kind):
        return exchange_with_store(voltage_v, p, q, p_slope, q_slope, kind, train)
    return feed_back(voltage_v, p, q, p_slope, q_slope, kind.regeneration, demand)


@kernel
def runs_on_store(nominal_v: float, train: Train, loads: Loads) -> bool:
    """Find the way of a train that its own store alone feeds; return whether that feeds it.

    A store that has less than the auxiliaries need, or less than keeps the train from rolling back,
    feeds it no more: the train coasts.

    Parameters
    ----------
    nominal_v : float
        Voltage that its machine has then. [V]
    train : Train
        On its passage; written: powers, of which the line has none, and that of the store.
    loads : Loads

    References
    ----------
    [SteinerScholten2004]_, as `storage.on_board`.
    """
    kind, demand, state = loads.types[at(train.train_type)], train.demand, train.stored
    if not has_store(kind) or state.discharge_limit_w <= kind.auxiliary_power_w:
        return False
    demand.store_only_w = state.discharge_limit_w
    asked, _, _, _ = demand_of_passage(
        nominal_v, WITHOUT_SLOPES, train, kind, loads.driving, loads.points, loads.scratch
    )
    demand.store_only_w = 0.0
    if train.passage.stalled:
        return False
    per_second = 1.0 / loads.driving.options.step_s
    demand.electric_power_w = train.passage.electric_j * per_second
    demand.offered_power_w = train.passage.offered_j * per_second
    taken = min(demand.offered_power_w - asked, state.charge_limit_w)
    state.power_w = taken
    demand.regenerated_power_w = asked + taken
    demand.active_power_w = demand.reactive_power_var = 0.0
    return True
