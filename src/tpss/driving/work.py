"""Mean powers of the forces on a train in a step that is no passage."""

from tpss.kernel import inlined
from tpss.vehicle.train import Train, brakes_within_step


@inlined
def mean_powers(train: Train, step_s: float) -> tuple[float, float, float, float]:
    """Mean powers of tractive force, brakes, running resistance and gradient force. [W]

    In a step of constant acceleration the forces act over its distance.  A step that holds the speed v
    for a while and then brakes has its motors in traction at v; the resistances are constant; on a
    descent the brakes hold the speed first.  The forces of `Forces` are means over the step, but the
    resistances those while the train moves.
    """
    motion, decision, forces = train.motion, train.decision, train.forces
    running, gradient = forces.running_resistance_n, forces.gradient_n
    v, mean = motion.speed_m_s, (motion.speed_m_s + forces.next_speed_m_s) / 2.0
    if not brakes_within_step(decision.course):
        return forces.tractive_n * mean, forces.braking_n * mean, running * mean, gradient * mean
    brake_s = decision.moving_share * step_s - decision.hold_s
    way_per_s = (v * decision.hold_s + mean * brake_s) / step_s
    holding_n = max(0.0, -(running + gradient)) * decision.hold_s / step_s
    braking_w = holding_n * v + (forces.braking_n - holding_n) * mean
    pulling_m_s = v if decision.hold_s > 0.0 else mean
    return (
        forces.tractive_n * pulling_m_s,
        braking_w,
        running * way_per_s,
        gradient * way_per_s,
    )
