"""What a train draws where its efficiency follows the load, from what it would draw if it did not."""

from tpss.kernel import kernel
from tpss.physics.locomotive import active_power
from tpss.vehicle.part_load import taken_at_load
from tpss.vehicle.terms import Demand
from tpss.vehicle.train_type import TrainType


@kernel
def follow_load(
    active_w: float, slope: float, driven_share: float, kind: TrainType, demand: Demand
) -> tuple[float, float]:
    """Active power that a train draws, and its slope over anything. [W]

    A step of its own behind the usual one: trains without such a curve compute as if there were none.

    Parameters
    ----------
    active_w, slope : float
        The same with the efficiency over speed alone. [W]
    driven_share : float
        Share of the time in which the motors work, over which the power is a mean. [1]

    References
    ----------
    [Boullanger2009]_, eq. (2.14), as `taken_at_load`.
    """
    motors_w = (active_w - kind.auxiliary_power_w) / demand.per_efficiency
    taken_w, by_power = taken_at_load(motors_w, driven_share, kind.over_load)
    active_w = active_power(taken_w, demand.per_efficiency, kind.auxiliary_power_w)
    return active_w, slope * by_power
