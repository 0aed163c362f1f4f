r"""A store of energy over the steps of a run: its limits in a step, and what the step leaves in it.

A supercapacitor of capacitance C between its voltages V_min and V_max holds

.. math:: E = \frac{C}{2} (V^2 - V_{min}^2), \qquad E_{max} = \frac{C}{2} (V_{max}^2 - V_{min}^2),

a battery or a flywheel what it is given as capacity.  With the efficiencies η_c of charging and η_d of
discharging, and a loss P_0 by standing by, a step of length h takes the energy E at its beginning to

.. math:: E' = E - P_0 h + \eta_c P h \;\; (P > 0), \qquad E' = E - P_0 h + P h / \eta_d \;\; (P < 0).

The power is limited by what is in it at the beginning of the step, so that no step passes full or empty:

.. math:: P \le \min\Big(P_{c}, \frac{I V}{\eta_c}, \frac{E_{max} - E + P_0 h}{\eta_c h}\Big), \qquad
          -P \le \min\Big(P_{d}, I V \eta_d, \frac{(E - P_0 h) \eta_d}{h}\Big).

An empty store loses nothing; one that loses the rest of its energy in a step is empty at its end.

Sign: a power is positive where the store takes it from the line or the train.

Limits of validity: efficiencies are the same at any power and temperature, and the voltage of a
supercapacitor is that at the beginning of the step.  In a step that moves a large part of the capacity
the limits bite early: a shorter step shows it.

References
----------
[SteinerScholten2004]_, on supercapacitors of rail vehicles.
"""

import math

from tpss.kernel import kernel
from tpss.record import Record


class Store(Record):
    """What a store can do; all zero: there is none."""

    capacity_j: float = 0.0
    """Energy between empty and full; 0: there is no store. [J]"""
    charge_power_w: float = 0.0
    """Highest power that it takes. [W]"""
    discharge_power_w: float = 0.0
    """Highest power that it gives. [W]"""
    charge_efficiency: float = 1.0
    """What is kept of what it takes. [1]"""
    discharge_efficiency: float = 1.0
    """What it gives of what it draws from its energy. [1]"""
    standby_w: float = 0.0
    """What it loses all the time, unless it is empty. [W]"""
    capacitance_f: float = 0.0
    """Capacitance of a supercapacitor; 0: it is none. [F]"""
    empty_j: float = 0.0
    """Energy in a supercapacitor at its lowest voltage, which is not used. [J]"""
    highest_current_a: float = math.inf
    """Highest current of a supercapacitor. [A]"""


class Stored(Record):
    """The state of a store."""

    energy_j: float = 0.0
    """Energy in it, at the beginning of the step. [J]"""
    standby_j: float = 0.0
    """What it loses in the step by standing by. [J]"""
    charge_limit_w: float = 0.0
    """Highest power that it takes in the step. [W]"""
    discharge_limit_w: float = 0.0
    """Highest power that it gives in the step. [W]"""
    power_w: float = 0.0
    """Power that it takes, at the voltage last tried. [W]"""


@kernel
def begin_store(step_s: float, store: Store, state: Stored) -> None:
    """Find the limits of a store in a step of this length. [s]

    References
    ----------
    [SteinerScholten2004]_; the formulae at the top of this file.
    """
    state.power_w = 0.0
    state.standby_j = min(store.standby_w * step_s, state.energy_j)
    held_j = state.energy_j - state.standby_j
    charge_w, discharge_w = store.charge_power_w, store.discharge_power_w
    if store.capacitance_f > 0.0:
        voltage_v = math.sqrt(2.0 * (state.energy_j + store.empty_j) / store.capacitance_f)
        most_w = store.highest_current_a * voltage_v
        charge_w = min(charge_w, most_w / store.charge_efficiency)
        discharge_w = min(discharge_w, most_w * store.discharge_efficiency)
    room_w = (store.capacity_j - held_j) / (store.charge_efficiency * step_s)
    state.charge_limit_w = min(charge_w, room_w)
    state.discharge_limit_w = min(discharge_w, held_j * store.discharge_efficiency / step_s)


@kernel
def energy_after(power_w: float, step_s: float, store: Store, state: Stored) -> float:
    """Energy in a store after a step in which it takes a power. [J]

    A power at a limit makes it full or empty but for a rounding, which is left out.

    References
    ----------
    [SteinerScholten2004]_; the formulae at the top of this file.
    """
    held_j = state.energy_j - state.standby_j
    if power_w > 0.0:
        if power_w * store.charge_efficiency * step_s >= store.capacity_j - held_j:
            return store.capacity_j
        return held_j + power_w * store.charge_efficiency * step_s
    if -power_w * step_s >= held_j * store.discharge_efficiency:
        return 0.0
    return held_j + power_w * step_s / store.discharge_efficiency


@kernel
def lost_power(power_w: float, step_s: float, store: Store, state: Stored) -> float:
    """What a store loses in a step in which it takes a power, standing by included: mean power. [W]

    References
    ----------
    [SteinerScholten2004]_; the formulae at the top of this file.
    """
    if power_w > 0.0:
        converted_w = (1.0 - store.charge_efficiency) * power_w
    else:
        converted_w = (1.0 - 1.0 / store.discharge_efficiency) * power_w
    return converted_w + state.standby_j / step_s
