"""What a braking train feeds back at a voltage: the line's part of what its motors offer."""

from tpss.kernel import inlined, kernel
from tpss.numerics.curve import Points, curve_at
from tpss.vehicle.part_load import given_share
from tpss.vehicle.regeneration import Regeneration, electric_force, taken_share
from tpss.vehicle.terms import Demand
from tpss.vehicle.train_type import TrainType


@inlined
def regenerates(kind: TrainType) -> bool:
    """Whether trains of a type have electric brakes."""
    return kind.regeneration.highest_force_n > 0.0


@inlined
def asks_more(kind: TrainType) -> bool:
    """Whether trains of a type have electric brakes, a store, or an efficiency that follows the load."""
    gives = kind.regeneration.highest_force_n > 0.0 or kind.on_board.store.capacity_j > 0.0
    return gives or kind.over_load.count > 0


@kernel
def offer(
    braking_n: float, speed_m_s: float, kind: TrainType, demand: Demand, points: Points
) -> None:
    """Find what the electric brakes give and offer all through a step, at its mean speed.

    Parameters
    ----------
    braking_n : float
        Force of all brakes, positive; otherwise they give nothing. [N]
    speed_m_s : float
        Mean speed of the step. [m/s]

    References
    ----------
    [EN50388]_, as `electric_force`.
    """
    demand.electric_power_w = demand.offered_power_w = demand.regenerated_power_w = 0.0
    if braking_n <= 0.0:
        return
    force = electric_force(braking_n, speed_m_s, demand.adhesion_n, kind.regeneration)
    curve = kind.regeneration.efficiency
    demand.electric_power_w = force * speed_m_s
    efficiency = curve_at(speed_m_s, curve.first, curve.points, points)
    efficiency *= given_share(demand.electric_power_w, kind.regeneration.over_load)
    demand.offered_power_w = demand.electric_power_w * efficiency


@kernel
def feed_back(
    voltage_v: float, active_w: float, reactive_var: float, active_slope: float,
    reactive_slope: float, own: Regeneration, demand: Demand,
) -> tuple[float, float, float, float]:  # fmt: skip
    """Powers of a train and their slopes, P, Q, P', Q', less what it feeds back at a voltage.

    [W], [var], [W/V], [var/V]

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph. [V]
    active_w, reactive_var, active_slope, reactive_slope : float
        What it draws by itself.
    own : Regeneration
    demand : Demand
        What it offers; written: powers.

    References
    ----------
    [EN50163]_, as `taken_share`.
    """
    share, slope = taken_share(voltage_v, own)
    taken_w, taken_slope = share * demand.offered_power_w, slope * demand.offered_power_w
    demand.regenerated_power_w = taken_w
    demand.active_power_w = active_w - taken_w
    demand.reactive_power_var = reactive_var + own.reactive_ratio * taken_w
    return (
        demand.active_power_w,
        demand.reactive_power_var,
        active_slope - taken_slope,
        reactive_slope + own.reactive_ratio * taken_slope,
    )
