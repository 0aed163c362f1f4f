"""Trains with a store on board: what they take from the line, and what moves them without one."""

from tpss.kernel import inlined, kernel
from tpss.numerics.curve import Points
from tpss.storage.on_board import exchange
from tpss.storage.store import begin_store
from tpss.vehicle.billing import billed_power
from tpss.vehicle.demand import Array, update_power_terms
from tpss.vehicle.part_load import power_for
from tpss.vehicle.regeneration import taken_share
from tpss.vehicle.terms import Demand
from tpss.vehicle.train import Phase, Train
from tpss.vehicle.train_type import TrainType


@inlined
def has_store(kind: TrainType) -> bool:
    """Whether trains of a type have a store."""
    return kind.on_board.store.capacity_j > 0.0


@kernel
def begin_own_store(step_s: float, train: Train, kind: TrainType) -> None:
    """Find the limits of a train's store in a step of this length, and whether it charges. [s]"""
    begin_store(step_s, kind.on_board.store, train.stored)
    train.stands = train.motion.phase == Phase.DWELLING and train.motion.wait_s >= step_s


@kernel
def exchange_with_store(
    voltage_v: float, active_w: float, reactive_var: float, active_slope: float,
    reactive_slope: float, kind: TrainType, train: Train,
) -> tuple[float, float, float, float]:  # fmt: skip
    """Powers of a train and their slopes, P, Q, P', Q', at a voltage, with its store and its brakes.

    [W], [var], [W/V], [var/V]

    Parameters are those of `vehicle.feed_back.feed_back`; the store's part is noted in the train.

    References
    ----------
    [SteinerScholten2004]_, as `storage.on_board.exchange`.
    """
    demand, own = train.demand, kind.regeneration
    share, share_slope = taken_share(voltage_v, own)
    line_w, line_slope, used_w = exchange(
        voltage_v, active_w, active_slope, demand.offered_power_w, share, share_slope,
        train.stands, kind.on_board, train.stored,
    )  # fmt: skip
    demand.regenerated_power_w = used_w
    demand.active_power_w = line_w
    # What goes to the line has a power factor, what goes into the store has none.
    given_w, given_slope = 0.0, 0.0
    if demand.offered_power_w > 0.0:
        stored_w = max(0.0, train.stored.power_w)
        given_w = used_w - stored_w
        given_slope = share_slope * (demand.offered_power_w - stored_w)
    demand.reactive_power_var = reactive_var + own.reactive_ratio * given_w
    return (
        demand.active_power_w,
        demand.reactive_power_var,
        line_slope,
        reactive_slope + own.reactive_ratio * given_slope,
    )


@kernel
def within_own_power(
    force_n: float,
    speed_m_s: float,
    kind: TrainType,
    demand: Demand,
    points: Points,
    scratch: Array,
) -> float:
    """Largest force of all motors with which a train asks for no more than its store gives. [N]

    At the mean speed of a phase the motors' power is proportional to the force.

    Parameters
    ----------
    force_n : float
        Force that the machine gives. [N]
    speed_m_s : float
        Mean speed of the phase. [m/s]
    demand : Demand
        What the store gives: `store_only_w`.

    References
    ----------
    [SteinerScholten2004]_, on trains without a contact line.
    """
    update_power_terms(speed_m_s, kind, demand, points, scratch)
    power_w, per_newton, _, _ = billed_power(force_n, 1.0, kind, demand)
    taken_w = (demand.store_only_w - kind.auxiliary_power_w) / demand.per_efficiency
    left_w = power_for(taken_w, kind.over_load)
    if power_w <= left_w:
        return force_n
    return max(0.0, left_w / per_newton)
