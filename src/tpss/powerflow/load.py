"""What a train asks of the network, however it moves."""

import numpy as np

from tpss.driving.passage import demand_of_passage
from tpss.kernel import at, inlined, kernel
from tpss.powerflow.network import Loads
from tpss.vehicle.demand import electrical_demand
from tpss.vehicle.feed_back import feed_back, regenerates
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
    if regenerates(kind):
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
    """`find_demand` of a train with electric brakes.

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
    return feed_back(voltage_v, p, q, p_slope, q_slope, kind.regeneration, demand)
