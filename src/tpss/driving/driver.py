"""The driver of each train: which speed to reach in this step, and which force that takes."""

from tpss.driving import continuous
from tpss.driving.aggressive import aggressive_force, aggressive_speed
from tpss.driving.data import Driver, DrivingData, Floats, MotionModel
from tpss.driving.manners import aim_to_stop, allowed_speed, highest_speed_that_stops
from tpss.driving.motion import force_to_target, set_target, spare_motors, update_resistances
from tpss.driving.stops import distance_to_stop
from tpss.driving.within_step import aim_to_limit
from tpss.kernel import at, inlined
from tpss.numerics.curve import Points
from tpss.numerics.staircase import index_at
from tpss.physics.locomotive import acceleration
from tpss.vehicle.adhesion import adhesion_of
from tpss.vehicle.demand import (
    FULL_EFFORT_N,
    certify_free_band,
    take_speed_as_it_is,
    update_cap_terms,
    update_speed_terms,
    within_free_band,
)
from tpss.vehicle.train import Course, Phase, Train
from tpss.vehicle.train_type import TrainType


@inlined
def fastest_and_coasting(train: Train, kind: TrainType, step_s: float) -> tuple[float, float]:
    """Speeds after this step: the highest that the rails allow, and without motors or brakes. [m/s]

    References
    ----------
    [Boullanger2009]_, eq. (2.11) and (F.19).
    """
    v, resistance = train.motion.speed_m_s, train.demand.resistance_n
    fastest = v + step_s * acceleration(train.demand.adhesion_n, resistance, kind.inertia_kg)
    coasting = v + step_s * acceleration(0.0, resistance, kind.coasting_inertia_kg)
    return max(0.0, fastest), coasting


@inlined
def target_speed(train: Train, kind: TrainType, data: DrivingData) -> float:
    """Speed that a train is to have after this step, if its machine can, before limits ahead. [m/s]

    The lower of line and train limits it, or the original driver's rule, and the highest acceleration
    that the train may have.  A train at or near standstill accelerates no further than its next stop
    allows: braking only ever lowers the speed, so a train that creeps would creep to its stop.

    References
    ----------
    [Boullanger2009]_, section 2.3.1 and figure 3-7.
    """
    motion, row, h = train.motion, at(kind.profile), data.options.step_s
    v, retardation = motion.speed_m_s, kind.highest_retardation_m_s2
    limit = data.limits.value[row][index_at(motion.position_m, data.limits.from_m[row])]
    target = min(limit, kind.highest_speed_m_s)
    if data.options.driver == Driver.AGGRESSIVE:
        fastest, coasting = fastest_and_coasting(train, kind, h)
        target = aggressive_speed(v, target, fastest, coasting, v - retardation * h)
    if v < target / 2.0:
        room_m = distance_to_stop(train, data.stops)
        most = highest_speed_that_stops(v, room_m, retardation, data.options)
        if most >= 2.0 * v:
            target = min(target, most)
    return min(target, v + kind.highest_acceleration_m_s2 * h)


@inlined
def aim_at_speed(train: Train, kind: TrainType, data: DrivingData) -> None:
    """Set the target of a train that does not brake to its stop, and the force that it takes.

    The step is one of constant acceleration, unless the train brakes to a lower limit within it.
    """
    h, demand = data.options.step_s, train.demand
    target = allowed_speed(train, kind, target_speed(train, kind, data), data)
    if train.decision.course == Course.TO_LIMIT and aim_to_limit(train, kind, target, data):
        return
    wanted = force_to_target(train, kind, target, h)
    if data.options.driver == Driver.AGGRESSIVE:
        fastest, coasting = fastest_and_coasting(train, kind, h)
        wanted = aggressive_force(target, fastest, coasting, wanted, FULL_EFFORT_N)
    cap = wanted if wanted == FULL_EFFORT_N else min(wanted, demand.adhesion_n)
    set_target(train, wanted, cap, target)


@inlined
def aim(train: Train, data: DrivingData, points: Points) -> None:
    """Set the target of a train, and the force that adhesion and driver allow at most."""
    if data.options.motion == MotionModel.CONTINUOUS:
        continuous.aim(train, data, points)
    else:
        _aim_stepped(train, data)


@inlined
def _aim_stepped(train: Train, data: DrivingData) -> None:
    """`aim` of a train that moves in steps.

    References
    ----------
    [Boullanger2009]_, eq. (2.6), (F.5), (F.20).
    """
    kind, phase = data.types[at(train.train_type)], train.motion.phase
    set_target(train, 0.0, 0.0, 0.0)
    if phase != Phase.DWELLING:
        stops = phase == Phase.PLANNED and aim_to_stop(train, kind, data)
        if not stops:
            aim_at_speed(train, kind, data)
    spare_motors(train, kind)
    certify_free_band(kind, train.demand)
    update_cap_terms(kind, train.demand)


@inlined
def prepare(train: Train, data: DrivingData, points: Points, scratch: Floats) -> None:
    """Find all about a train that stays fixed while this step is solved, but what its driver decides."""
    if data.options.motion == MotionModel.CONTINUOUS:
        continuous.prepare(train, data, points, scratch)
    else:
        _prepare_stepped(train, data, points, scratch)


@inlined
def _prepare_stepped(train: Train, data: DrivingData, points: Points, scratch: Floats) -> None:
    """`prepare` of a train that moves in steps.

    References
    ----------
    [Boullanger2009]_, appendix F.1.
    """
    kind, options, demand = data.types[at(train.train_type)], data.options, train.demand
    speed_m_s, decision = train.motion.speed_m_s, train.decision
    demand.mean_speed_weight_s = options.step_s / 2.0 if options.mean_power else 0.0
    take_speed_as_it_is(demand)
    demand.driven_share = decision.moving_share = 1.0
    decision.hold_s = 0.0
    decision.course = Course.UNIFORM
    # Adhesion depends on the speed alone, as do the terms that are kept.
    if speed_m_s != demand.terms_speed_m_s:
        demand.adhesion_n = adhesion_of(
            kind, speed_m_s, options.rail, options.adhesion_in_km_h, points
        )
    if speed_m_s != demand.terms_speed_m_s or not within_free_band(demand):
        update_speed_terms(speed_m_s, kind, demand, points, scratch)
    update_resistances(train, kind, data.gradients, options)
    decision.decided = False
