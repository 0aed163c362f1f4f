"""What fixes a train's demand over the line voltage during one step, and what came of it."""

from tpss.numerics.series import Series
from tpss.record import Record
from tpss.vehicle.effort.kinds import EffortTerms


class Demand(Record):
    """Demand of a train over the line voltage; evaluated by `vehicle.demand`."""

    force_cap_n: float
    """Force of the driver or adhesion limit, the smaller; 0 with motors off. [N]"""
    adhesion_n: float
    """Force that the rails pass on at most. [N]"""
    resistance_n: float
    """Running resistance and gradient force. [N]"""
    speed_m_s: float
    """Speed at the start of the step. [m/s]"""
    terms_speed_m_s: float
    """Speed to which all belongs that the speed decides: the same, or the one expected in the middle
    of the step. [m/s]"""
    mean_speed_weight_s: float
    """h/2 to bill the step's mean speed, 0 for that at its start. [s]"""
    effort_shift_n: float
    """Added to what the motors give at that speed, ... [N]"""
    effort_growth: float
    """... then added as a share of the sum: they make it what the motors give at the mean speed of
    the step. [1]"""
    driven_share: float
    """Share of the step in which the motors give the force, mostly 1. [1]"""
    per_efficiency: float
    """1 / η, from pantograph to motor shaft, at this speed. [1]"""
    reactive_ratio: float
    """Reactive over active power of the motors, by the power factor. [1]"""
    free_voltage_v: float
    """Voltage around which the machine does not limit the force. [V]"""
    free_force_n: float
    """What the machine gives there. [N]"""
    free_band_v: float
    """How far from there that is proven; negative: nowhere. [V]"""
    cap_power_w: float
    """Power of the motors at the force cap. [W]"""
    cap_current_a: float
    """Sum of the motors' currents at the force cap. [A]"""
    voltage_v: float
    """Voltage at the pantograph, in this step or the one before. [V]"""
    wheel_force_n: float
    """What the motors give at the wheel rim, at the voltage last tried. [N]"""
    active_power_w: float
    """Active power that the train draws there. [W]"""
    reactive_power_var: float
    """Reactive power that the train draws there. [var]"""
    machine_force_n: float
    """What all motors give at most, before it is cut at 0. [N]"""
    bridge_sine: float
    """β, the sine of the bridges' firing angle, before it is cut to 0 to 1. [1]"""
    sine: Series
    """The bridge network over the locomotive's voltage. [1], [V]"""
    effort: EffortTerms
    """Tractive effort over the line voltage. [N], [V]"""
    electric_power_w: float
    """Power of the electric brakes at the wheel rim, mean over the step. [W]"""
    offered_power_w: float
    """What they offer the line, auxiliaries included. [W]"""
    regenerated_power_w: float
    """What of that the line takes, at the voltage last tried. [W]"""
    store_only_w: float
    """Power that its own store gives where nothing else feeds it; 0: the line does. [W]"""
