"""Resistances, targets and steps of constant acceleration, which all drivers and manners share."""

import math

from tpss.driving.data import DrivingData, Options, Profiles
from tpss.driving.regulated import ideal_force, wanted_acceleration
from tpss.kernel import at, inlined, kernel
from tpss.numerics.staircase import index_from
from tpss.physics.gradient import mean_gradient
from tpss.physics.locomotive import acceleration
from tpss.physics.running_resistance import gradient_force
from tpss.vehicle.billing import force_of_current
from tpss.vehicle.resistance import resistance_at
from tpss.vehicle.train import Phase, Train
from tpss.vehicle.train_type import TrainType


@inlined
def update_resistances(
    train: Train, kind: TrainType, gradients: Profiles, options: Options
) -> None:
    """Find the forces on a train that do not depend on what its driver does, for this step.

    A standing train is held by its brakes; no running resistance is billed.

    References
    ----------
    [Boullanger2009]_, eq. (2.8)-(2.10), (F.2)-(F.4).
    """
    motion, forces, row = train.motion, train.forces, at(kind.profile)
    speed, from_m = motion.speed_m_s, gradients.from_m[row]
    motion.gradient = index_from(motion.gradient, motion.position_m, from_m)
    distance_m = speed * options.step_s if options.mean_gradient else 0.0
    slope = mean_gradient(
        motion.gradient, motion.position_m, distance_m, from_m, gradients.value[row]
    )
    standing = motion.phase == Phase.DWELLING
    forces.running_resistance_n = 0.0 if standing else resistance_at(speed, kind)
    forces.gradient_n = gradient_force(kind.mass_kg, slope)
    train.demand.resistance_n = forces.running_resistance_n + forces.gradient_n


@inlined
def update_gradient(train: Train, kind: TrainType, distance_m: float, data: DrivingData) -> None:
    """Update the resistances for a step in which the train covers `distance_m`."""
    if data.options.mean_gradient:
        motion, forces, row = train.motion, train.forces, at(kind.profile)
        from_m, gradient = data.gradients.from_m[row], data.gradients.value[row]
        slope = mean_gradient(motion.gradient, motion.position_m, distance_m, from_m, gradient)
        forces.gradient_n = gradient_force(kind.mass_kg, slope)
        train.demand.resistance_n = forces.running_resistance_n + forces.gradient_n


@kernel
def drive_uniformly(train: Train, kind: TrainType, data: DrivingData) -> None:
    """Make the step of a train one of constant acceleration."""
    h, demand = data.options.step_s, train.demand
    train.decision.hold_s = 0.0
    demand.driven_share = train.decision.moving_share = 1.0
    demand.mean_speed_weight_s = h / 2.0 if data.options.mean_power else 0.0
    update_gradient(train, kind, train.motion.speed_m_s * h, data)


@inlined
def force_to_target(train: Train, kind: TrainType, target_m_s: float, step_s: float) -> float:
    """Force at the wheel rim that gives a speed after a step of constant acceleration. [N]

    References
    ----------
    [Boullanger2009]_, eq. (2.10), (2.25) and (F.20).
    """
    a = wanted_acceleration(train.motion.speed_m_s, target_m_s, step_s)
    return ideal_force(a, train.demand.resistance_n, kind.inertia_kg)


@kernel
def set_target(train: Train, force_n: float, cap_n: float, target_m_s: float) -> None:
    """Set target and force of a train, and the force that driver and adhesion allow at most."""
    train.demand.force_cap_n = max(0.0, cap_n)
    train.decision.target_speed_m_s = target_m_s
    train.decision.force_n = force_n


@inlined
def spare_motors(train: Train, kind: TrainType) -> None:
    """Let a driver want no more of his motors than he allows them.

    References
    ----------
    [Boullanger2009]_, eq. (2.17), as `force_of_current` solves it.
    """
    if train.allowed_current_a < math.inf:
        demand = train.demand
        spared_n = force_of_current(
            train.allowed_current_a, demand.speed_m_s, demand.resistance_n,
            demand.mean_speed_weight_s, kind,
        )  # fmt: skip
        demand.force_cap_n = min(demand.force_cap_n, spared_n)


@inlined
def move_uniformly(train: Train, step_s: float) -> None:
    """Bring a train to the next instant: v' = v + a h, x' = x + v h + a h²/2.

    References
    ----------
    [Boullanger2009]_, implied by eq. (2.29) and (2.30).
    """
    motion, next_m_s = train.motion, train.forces.next_speed_m_s
    motion.position_m += step_s * (motion.speed_m_s + next_m_s) / 2.0
    motion.speed_m_s = next_m_s


@inlined
def apply_solution_uniformly(train: Train, kind: TrainType, step_s: float) -> None:
    """Brakes and next speed of a train in a step of constant acceleration.

    With motors off the train brakes with exactly the wanted acceleration; below its wanted force it
    takes what the machine gives and the rails pass on.

    References
    ----------
    [Boullanger2009]_, eq. (2.7), (2.11), (F.19), (F.20).
    """
    forces, wanted = train.forces, train.decision.force_n
    if forces.tractive_n >= wanted or wanted <= 0.0:
        forces.next_speed_m_s = train.decision.target_speed_m_s
        forces.braking_n = max(0.0, -wanted)
    else:
        a = acceleration(forces.tractive_n, train.demand.resistance_n, kind.inertia_kg)
        forces.next_speed_m_s = train.motion.speed_m_s + a * step_s
