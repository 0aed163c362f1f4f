"""What would help a train that stalls: only what binds it, in the words of the scenario."""

import math
from typing import NamedTuple

from tpss.kernel import plain
from tpss.physics.adhesion import Rail
from tpss.physics.locomotive import machine_force
from tpss.scenario.machine import EffortLimits, EffortTable
from tpss.scenario.rolling_stock import Train
from tpss.step.model import Model
from tpss.vehicle.billing import force_of_current
from tpss.vehicle.terms import Demand
from tpss.vehicle.train import Train as TrainState
from tpss.vehicle.train_type import TrainType

STRENGTHEN = (
    "Strengthen the supply (an AT catenary, a high-voltage line, more transformers or feeding "
    "stations), or reduce the traffic (longer headway, lower speed or current limit)."
)
LIMIT_LESS = (
    "Relax the train's current_limitation (higher max_current_a, lower umin2_kv or knee_factor)."
)

SPARE_LESS = (
    "Lower the train's mass (mass_t), give its motors a higher continuous_a or less preload_percent, or "
    "leave out motor_rating.spared."
)

LONG_STEP_S = 15.0
"""With longer steps than this, a stall may be one of the step. [s]"""


class Forces(NamedTuple):
    """What each of its limits leaves a train, at the wheel rim."""

    needed_n: float
    """Running resistance and gradient. [N]"""
    rails_n: float
    """What the rails pass on. [N]"""
    machine_n: float
    """What the machine gives at the train's voltage, without a current limitation. [N]"""
    wanted_n: float
    """What driver and rails ask of the machine. [N]"""
    given_n: float
    """What the motors gave, within a current limitation too. [N]"""
    spared_n: float = math.inf
    """What its driver allows motors that he spares; infinite: any. [N]"""

    @property
    def unlimited_n(self) -> float:
        """The force without a current limitation. [N]"""
        return min(self.wanted_n, self.machine_n)

    @property
    def current_binds(self) -> bool:
        """Whether the current limitation leaves less than all else."""
        return self.given_n < self.unlimited_n

    @property
    def driver_binds(self) -> bool:
        """Whether the driver, to spare the motors, asks for less than is needed."""
        return self.spared_n < self.needed_n

    @property
    def rails_bind(self) -> bool:
        """Whether the rails pass on too little, or least."""
        return self.rails_n < self.needed_n or self.rails_n <= self.machine_n

    @property
    def machine_binds(self) -> bool:
        """Whether the machine gives too little, or least."""
        return self.machine_n < self.needed_n or self.machine_n <= self.rails_n


def forces_on(train: TrainState, kind: TrainType, needed_n: float) -> Forces:
    """What limits the force of a train in the present step."""
    demand, spared_n = train.demand, math.inf
    if train.allowed_current_a < math.inf:
        spared_n = plain(force_of_current)(
            train.allowed_current_a, train.motion.speed_m_s, demand.resistance_n, 0.0, kind
        )
    motors_n = max(0.0, float(demand.machine_force_n))
    machine_n = plain(machine_force)(
        motors_n, demand.resistance_n, kind.rotor_mass_kg, kind.inertia_kg
    )
    return Forces(
        needed_n=needed_n,
        rails_n=float(demand.adhesion_n),
        machine_n=max(0.0, float(machine_n)),
        wanted_n=float(demand.force_cap_n),
        given_n=float(demand.wheel_force_n),
        spared_n=float(spared_n),
    )


def what_binds(forces: Forces) -> str:
    """Sentence on the forces that rails and machine allow, or on what the driver asks for."""
    if forces.driver_binds:
        return (
            f" To spare hot motors its driver asks for no more than {forces.spared_n / 1e3:.1f} kN."
        )
    rails, machine = f"{forces.rails_n / 1e3:.1f} kN", f"{forces.machine_n / 1e3:.1f} kN"
    said = f" The rails pass on {rails}, the machine gives {machine}:"
    limiting = ["rails limit", "machine limits"]
    if forces.machine_n < forces.rails_n:
        limiting.reverse()
    both = forces.rails_bind and forces.machine_binds
    other = limiting[1].split()[0]
    return f"{said} the {limiting[0]} it{f', and the {other} would not be enough either' * both}."


def stall_advice(
    forces: Forces, demand: Demand, kind: TrainType, train: Train, model: Model
) -> str:
    """What would help a train that stalls.

    Parameters
    ----------
    forces : Forces
        Its limits.
    demand, kind : Demand, TrainType
        Its demand, and its type as the model has it.
    train : Train
        Its type as the scenario has it.
    model : Model
    """
    advice = []
    if forces.current_binds:
        advice.append(LIMIT_LESS)
        if demand.voltage_v < kind.line_current.full_current_voltage_v:
            advice.append(STRENGTHEN)
        return " ".join(advice)
    if forces.driver_binds:
        return SPARE_LESS
    rises = []
    if forces.rails_bind:
        rises.append("its adhesive mass (adhesive_mass_t)")
    if forces.machine_binds:
        rises.append(_stronger(train, float(demand.speed_m_s)))
    advice.append(f"Lower the train's mass (mass_t), or raise {' and '.join(rises)}.")
    if forces.rails_bind and model.options.rail == Rail.WET:
        advice.append('Dry rails (simulation.rail = "dry") pass on more.')
    if forces.machine_binds and _voltage_weakens(train, demand, model):
        advice.append(f"The voltage is low, which weakens the machine. {STRENGTHEN}")
    if model.options.step_s > LONG_STEP_S:
        advice.append(
            f"With a time step of {model.options.step_s / 60.0:g} min, try a shorter one."
        )
    return " ".join(advice)


def _stronger(train: Train, speed_m_s: float) -> str:
    """The keys that make a machine stronger at a speed."""
    effort = train.tractive_effort
    if isinstance(effort, EffortLimits):
        in_power = effort.max_force_kn * speed_m_s > effort.max_power_kw
        key = "max_power_kw" if in_power else "max_force_kn"
        return f"the {'power' if in_power else 'force'} of its machine ({key})"
    if isinstance(effort, EffortTable) and effort.motor_current_a is None:
        return "the force of its machine (force_kn)"
    return "its current limit (max_motor_current_a)"


def _voltage_weakens(train: Train, demand: Demand, model: Model) -> bool:
    """Whether the machine would give more at a higher voltage, and the present one is low."""
    effort, voltage_kv = train.tractive_effort, float(demand.voltage_v) / 1e3
    if voltage_kv >= model.network.system.nominal_voltage_v / 1e3:
        return False
    if isinstance(effort, EffortLimits):
        return effort.full_voltage_kv is not None and voltage_kv < effort.full_voltage_kv
    if isinstance(effort, EffortTable):
        return effort.voltage_kv is not None and voltage_kv < effort.voltage_kv[-1]
    return True
