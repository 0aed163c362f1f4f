r"""Steps of trains that move continuously: one phase where that is enough, else a `passage`.

Most steps of a train are one phase: it holds its limit, or accelerates with all that its machine gives,
from the start of the step to its end.  Then the demand can be found as `vehicle.demand` does, which is
many times as fast as a passage; all that the speed decides is evaluated at the speed that is expected in
the middle of the step, and the machine's force follows the speed from there along its tangent.

Expected is the acceleration of the step before, changed by what the resistances have changed.  If the
solution shows that the speed was not as expected (`FARTHEST_OFF`: along the tangent the force is then
off by the square of that), that the train reaches its limit within the step, or that it has to brake in
it, the step becomes a passage, and is solved again.
"""

from tpss.driving.coasting import has_coasting, may_coast
from tpss.driving.data import DrivingData, Floats
from tpss.driving.lookahead import highest_speed, what_to_brake_for
from tpss.driving.motion import force_to_target, move_uniformly, set_target, spare_motors
from tpss.driving.neutral import has_neutral, may_lack_power
from tpss.driving.own_driver import wanted_speed
from tpss.driving.passage import LONGEST_PHASE_S
from tpss.kernel import at, inlined, kernel
from tpss.numerics.curve import Points
from tpss.numerics.staircase import index_at, index_from
from tpss.physics.gradient import mean_gradient
from tpss.physics.running_resistance import gradient_force
from tpss.vehicle.adhesion import adhesion_of
from tpss.vehicle.braking import braking_square
from tpss.vehicle.demand import (
    certify_free_band,
    follow_speed,
    take_speed_as_it_is,
    update_cap_terms,
    update_speed_terms,
    within_free_band,
)
from tpss.vehicle.feed_back import offer, regenerates
from tpss.vehicle.resistance import resistance_at
from tpss.vehicle.train import Course, Phase, Train, copy_motion
from tpss.vehicle.train_type import TrainType

FARTHEST_OFF = 1e-3
"""Farthest that the mean speed of a step may be from the expected one, relative to it. [1]"""

SHORT_STEP_S = LONGEST_PHASE_S * (1.0 + 1e-9)
"""Longest step of changing forces that may be one phase. [s]"""


@inlined
def _resist(
    mean_speed_m_s: float, distance_m: float, train: Train, kind: TrainType, data: DrivingData
) -> None:
    """Find the resistances over a distance at a mean speed."""
    motion, forces, row = train.motion, train.forces, at(kind.profile)
    slope = mean_gradient(
        motion.gradient, motion.position_m, distance_m,
        data.gradients.from_m[row], data.gradients.value[row],
    )  # fmt: skip
    forces.running_resistance_n = resistance_at(mean_speed_m_s, kind)
    forces.gradient_n = gradient_force(kind.mass_kg, slope)
    train.demand.resistance_n = forces.running_resistance_n + forces.gradient_n


@inlined
def _expect_acceleration(
    cruise_m_s: float, train: Train, kind: TrainType, data: DrivingData
) -> float:
    """Expected acceleration, with which the resistances of the step are found. [m/s²]"""
    v, h = train.motion.speed_m_s, data.options.step_s
    if v == cruise_m_s:
        _resist(v, v * h, train, kind, data)
        return 0.0
    a = train.decision.acceleration_m_s2
    mean = max(0.0, v + a * h / 2.0)
    _resist(mean, mean * h, train, kind, data)
    return a + (train.decision.resistance_n - train.demand.resistance_n) / kind.inertia_kg


@inlined
def _is_one_phase(
    acceleration_m_s2: float, cruise_m_s: float, here: int, train: Train, kind: TrainType,
    data: DrivingData,
) -> bool:  # fmt: skip
    """Whether a step with the expected acceleration would be one phase."""
    motion, h, row = train.motion, data.options.step_s, at(kind.profile)
    v, after = motion.speed_m_s, motion.speed_m_s + acceleration_m_s2 * h
    way_m = h * (v + after) / 2.0
    end_m = motion.position_m + way_m
    # 1. Forces that change with speed and place take more phases in a long step.
    if h > SHORT_STEP_S:
        following, from_m = motion.gradient + 1, data.gradients.from_m[row]
        if v != cruise_m_s or (following < from_m.size and from_m[at(following)] < end_m):
            return False
    # 2. The limit is reached, or ends.
    if v != cruise_m_s and after >= cruise_m_s:
        return False
    from_m = data.limits.from_m[row]
    if v == cruise_m_s and here + 1 < from_m.size and from_m[at(here + 1)] < end_m:
        return False
    # 3. The train has to brake.
    b = kind.highest_retardation_m_s2
    square = braking_square(after, b, kind.braking)
    return square + 2.0 * b * way_m < train.decision.braking_square_m2_s2


@inlined
def _expect_one_phase(
    mean_speed_m_s: float, train: Train, kind: TrainType, data: DrivingData, points: Points,
    scratch: Floats,
) -> None:  # fmt: skip
    """Find what stays fixed while the step is solved, at the speed expected in its middle."""
    options, demand = data.options, train.demand
    demand.mean_speed_weight_s = options.step_s / 2.0
    if mean_speed_m_s != demand.terms_speed_m_s:
        demand.adhesion_n = adhesion_of(
            kind, mean_speed_m_s, options.rail, options.adhesion_in_km_h, points
        )
    if mean_speed_m_s != demand.terms_speed_m_s or not within_free_band(demand):
        update_speed_terms(mean_speed_m_s, kind, demand, points, scratch)
    demand.speed_m_s = train.motion.speed_m_s
    take_speed_as_it_is(demand)
    if mean_speed_m_s != demand.speed_m_s:
        follow_speed(kind, demand, points)


@inlined
def look_ahead(
    train: Train, kind: TrainType, data: DrivingData, points: Points, scratch: Floats
) -> None:
    """Find out whether a train's step is one phase, as far as can be expected, and prepare that."""
    motion, decision, h = train.motion, train.decision, data.options.step_s
    if decision.course == Course.PASSAGE:
        train.demand.terms_speed_m_s = -1.0  # a passage leaves the terms of one of its phases
    decision.course = Course.PASSAGE
    if has_neutral(data) and may_lack_power(motion, kind, data):
        return
    if has_coasting(data) and may_coast(motion, kind, data):
        return
    if motion.phase == Phase.DWELLING and motion.wait_s > h:
        decision.course = Course.UNIFORM
        train.forces.running_resistance_n, train.forces.gradient_n = 0.0, 0.0
        train.demand.resistance_n = 0.0
        _expect_one_phase(0.0, train, kind, data, points, scratch)
        return
    v, row = motion.speed_m_s, at(kind.profile)
    if motion.wait_s > 0.0 or v <= 0.0:
        return
    here = index_at(motion.position_m, data.limits.from_m[row])
    cruise = min(highest_speed(data.limits.value[row][at(here)], kind), motion.ceiling_m_s)
    cruise = min(cruise, decision.wanted_m_s)
    if v > cruise:
        return
    motion.gradient = index_from(motion.gradient, motion.position_m, data.gradients.from_m[row])
    square, _, _ = what_to_brake_for(here, train.route, motion, kind, data)
    decision.cruise_m_s, decision.braking_square_m2_s2 = cruise, square
    a = _expect_acceleration(cruise, train, kind, data)
    if not _is_one_phase(a, cruise, here, train, kind, data):
        return
    decision.course = Course.UNIFORM
    _expect_one_phase(max(0.0, v + a * h / 2.0), train, kind, data, points, scratch)


@inlined
def prepare(train: Train, data: DrivingData, points: Points, scratch: Floats) -> None:
    """Find all about a train that stays fixed while this step is solved, but what its driver decides."""
    decision = train.decision
    kind = data.types[at(train.train_type)]
    train.passage.stays, train.passage.tried_v = False, 0.0
    decision.wanted_m_s = wanted_speed(train, kind, data)
    train.demand.driven_share = decision.moving_share = 1.0
    decision.hold_s = 0.0
    look_ahead(train, kind, data, points, scratch)
    decision.decided = False


@inlined
def aim(train: Train, data: DrivingData, points: Points) -> None:
    """Set the target of a train whose step is one phase, and the force that its driver wants."""
    if train.decision.course == Course.PASSAGE:
        return
    kind, h, v = data.types[at(train.train_type)], data.options.step_s, train.motion.speed_m_s
    target = wanted = 0.0
    if train.motion.phase != Phase.DWELLING:
        target = min(train.decision.cruise_m_s, v + kind.highest_acceleration_m_s2 * h)
        wanted = force_to_target(train, kind, target, h)
    set_target(train, wanted, min(wanted, train.demand.adhesion_n), target)
    spare_motors(train, kind)
    if regenerates(kind):
        offer(-wanted, (v + target) / 2.0, kind, train.demand, points)
    certify_free_band(kind, train.demand)
    update_cap_terms(kind, train.demand)


@inlined
def apply_passage(train: Train, step_s: float) -> None:
    """Mean forces and next speed of a train on its passage; a negative speed says that it stalls."""
    passage, forces, per_second = train.passage, train.forces, 1.0 / step_s
    forces.tractive_n = passage.traction_ns * per_second
    forces.braking_n = passage.braking_ns * per_second
    forces.running_resistance_n = passage.running_ns * per_second
    forces.gradient_n = passage.gradient_ns * per_second
    forces.next_speed_m_s = passage.motion.speed_m_s
    train.decision.force_n = 0.0  # what its driver wants is a matter of the phases
    if passage.stalled:
        forces.next_speed_m_s = -1.0
        forces.tractive_n = passage.available_n
        train.demand.wheel_force_n = passage.available_n
        train.demand.resistance_n = passage.needed_n


@inlined
def must_pass(train: Train, kind: TrainType, data: DrivingData) -> bool:
    """Whether a step that was taken for one phase turns out not to be one."""
    motion, decision, h = train.motion, train.decision, data.options.step_s
    if decision.course == Course.PASSAGE or motion.phase == Phase.DWELLING:
        return False
    v, after = motion.speed_m_s, train.forces.next_speed_m_s
    if after < 0.0:
        return True
    if v != decision.cruise_m_s and after >= decision.cruise_m_s:
        return True  # the limit is reached
    mean = (v + after) / 2.0
    if abs(mean - train.demand.terms_speed_m_s) > FARTHEST_OFF * mean:
        return True
    b = kind.highest_retardation_m_s2
    square = braking_square(after, b, kind.braking)
    return square + 2.0 * b * mean * h > decision.braking_square_m2_s2


@kernel
def pass_instead(train: Train) -> None:
    """Make the step of a train a passage."""
    train.decision.course = Course.PASSAGE


@inlined
def _end_passage(step: int, train: Train) -> float:
    """Bring a train to the end of its passage; return how far from a stop it came to stand. [m]"""
    passage, decision = train.passage, train.decision
    copy_motion(passage.motion, train.motion)
    decision.acceleration_m_s2 = passage.acceleration_m_s2
    decision.resistance_n = passage.resistance_n
    if passage.motion.phase == Phase.ARRIVED:
        train.timetable.arrival_step = step + 1
        train.timetable.stood_s = passage.stood_s
    return passage.stop_error_m


@inlined
def move(step: int, train: Train, data: DrivingData) -> float:
    """Bring a train to the next instant; return how far from a stop it came to stand. [m]"""
    motion, h = train.motion, data.options.step_s
    if train.decision.course == Course.PASSAGE:
        return _end_passage(step, train)
    if motion.phase == Phase.DWELLING:
        motion.wait_s -= h
        return 0.0
    train.decision.acceleration_m_s2 = (train.forces.next_speed_m_s - motion.speed_m_s) / h
    train.decision.resistance_n = train.demand.resistance_n
    move_uniformly(train, h)
    return 0.0
