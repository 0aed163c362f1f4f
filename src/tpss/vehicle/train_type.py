"""A type of train, as its owner describes it, in SI units."""

import math

from tpss.numerics.called import Called
from tpss.numerics.curve import Curve
from tpss.numerics.neural_network import FeedForwardNetwork
from tpss.physics.motor import MotorModel
from tpss.physics.reactive_power import ReactiveModel
from tpss.physics.running_resistance import DavisCoefficients
from tpss.record import Record
from tpss.storage.on_board import OnBoard
from tpss.vehicle.braking import BrakingBands
from tpss.vehicle.effort.kinds import TractiveEffort
from tpss.vehicle.part_load import LoadCurve
from tpss.vehicle.regeneration import Regeneration
from tpss.vehicle.spared_motors import SparedMotors


class LineCurrentLimit(Record):
    """Limit of the current at the pantograph."""

    highest_current_a: float = math.inf
    """Highest current; infinite without such a limit. [A]"""
    auxiliary_current_a: float = 0.0
    """What is left of it where there is no traction, the current of the auxiliaries. [A]"""
    no_traction_voltage_v: float = 0.0
    """Line voltage at which there is no traction, U_min2. [V]"""
    full_current_voltage_v: float = 0.0
    """Line voltage from which the current is whole, a U_n. [V]"""
    auxiliary_power_va: float = 0.0
    """Apparent power of the auxiliaries, by which their current follows the voltage; 0: it is the one
    above at any. [VA]"""


class Networks(Record):
    """The three networks that describe a locomotive's machine."""

    tractive_effort: FeedForwardNetwork
    """Largest force of all motors over speed, line voltage and current limit. [N]"""
    bridge_sine: FeedForwardNetwork
    """Sine of the firing angle over the voltages of motors and transformer. [1]"""
    power_factor: FeedForwardNetwork
    """Power factor over speed. [1]"""


class TrainType(Record):
    """A type of train, in SI units; what every evaluation reads comes first."""

    mass_kg: float
    """Mass of the whole train. [kg]"""
    adhesive_mass_kg: float
    """Mass on driven axles. [kg]"""
    inertia_kg: float
    """Inertia with rotating parts, M = m_adh + (m - m_adh)(1 + H), eq. (2.11), or m (1 + ρ). [kg]"""
    coasting_inertia_kg: float
    """Inertia of a train that the aggressive driver lets coast, m (1 + H), eq. (2.11). [kg]"""
    rotor_mass_kg: float
    """Inertia of the motors as a mass at the wheel rim, c = 4 K_J (κ + 1). [kg]"""
    slip_factor: float
    """Circumferential speed of the driven wheels over speed, κ + 1. [1]"""
    auxiliary_power_w: float
    """Active power of the auxiliaries. [W]"""
    auxiliary_reactive_power_var: float
    """Their reactive power. [var]"""
    filter_susceptance_s: float
    """Susceptance of the filter at the pantograph's side, negative; 0: no filter. [S]"""
    transformer_ratio: float
    """Secondary voltage of the locomotive's transformer over the voltage at the pantograph. [1]"""
    reactive_model: ReactiveModel
    """What the reactive power of the motors follows from."""
    voltage_model: MotorModel
    """Model of the motor voltage."""
    current_model: MotorModel
    """Model of the motor current."""
    base_speed_m_s: float
    """Speed from which the motor voltage is at its highest; NaN: not known. [m/s]"""
    highest_motor_voltage_v: float
    """Highest voltage of one motor; NaN: not known. [V]"""
    line_current: LineCurrentLimit
    """Limit of the current at the pantograph."""
    pulls_at_any_voltage: bool
    """Whether force and power of its motors do not follow the line voltage, if there is one."""
    highest_acceleration_m_s2: float
    """Highest acceleration; infinite without such a limit. [m/s²]"""
    highest_retardation_m_s2: float
    """Highest retardation, positive; of all speeds, where it depends on the speed. [m/s²]"""
    braking: BrakingBands
    """The highest retardation over speed."""
    highest_speed_m_s: float
    """Highest speed of the train. [m/s]"""
    length_m: float
    """Length of the train. [m]"""
    profile: int
    """Row of the line's profiles, which are laid out for each length of train."""
    resistance: DavisCoefficients
    """Running resistance on straight level track."""
    adhesion: Curve
    """Adhesion coefficient over speed, μ; without points that of the rails holds. [1]"""
    efficiency: Curve
    """Efficiency over speed, from pantograph to motor shaft. [1]"""
    power_factor: Curve
    """Power factor over speed, where it is not the network's. [1]"""
    effort: TractiveEffort
    """What the motors give at most."""
    regeneration: Regeneration
    """Its electric brakes."""
    networks: Networks
    """Networks of the machine; zero where nothing asks for them."""
    spared: SparedMotors = SparedMotors.row()
    """Its motors, if its driver spares them."""
    on_board: OnBoard = OnBoard.row()
    """Its store of energy."""
    own_resistance: Called = Called.row()
    """Its running resistance, where a law of somebody's own gives it."""
    driver: Called = Called.row()
    """What its driver wants, by such a law."""
    over_load: LoadCurve = LoadCurve.row()
    """Factor of the efficiency over the power of the motors."""
