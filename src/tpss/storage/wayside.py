r"""A store at the line: the power that it takes by the voltage there.

.. math:: P(U) = \begin{cases}
        \min(k_c (U - U_c), P_{c}) & U > U_c \\
        0 & U_d \le U \le U_c \\
        -\min(k_d (U_d - U), P_{d}) & U < U_d
    \end{cases}

with the limits P_c and P_d of the step (`storage.store`).  The power grows with the voltage or stays: a
store damps a line as what braking trains are refused does, but for its limits, where it is a load or a
source of constant power.

The current is that of a load, conj(P/V), as a train's; so voltages that turn together by an angle still
obey it, and it is a station that holds the angle.  An island with stores alone has none: it is one
without a source, in which stores rest.
"""

from tpss.kernel import kernel
from tpss.record import Record
from tpss.storage.store import Store, Stored


class StoreLaw(Record):
    """A store at a node of the network, and how it follows the voltage there."""

    node: int
    """Its node."""
    store: Store
    """What it can do."""
    start_j: float
    """Energy in it at the beginning of a run. [J]"""
    charges_above_v: float
    """Voltage above which it charges, U_c. [V]"""
    discharges_below_v: float
    """Voltage below which it discharges, U_d. [V]"""
    charge_w_per_v: float
    """Power over voltage above U_c. [W/V]"""
    discharge_w_per_v: float
    """Power over voltage below U_d. [W/V]"""


@kernel
def power_at_voltage(voltage_v: float, law: StoreLaw, state: Stored) -> tuple[float, float]:
    """Power that a store at the line takes at a voltage, and its slope. [W], [W/V]

    References
    ----------
    [SteinerScholten2004]_, on stores at the line; the formulae at the top of this file.
    """
    if voltage_v > law.charges_above_v:
        power = law.charge_w_per_v * (voltage_v - law.charges_above_v)
        if power < state.charge_limit_w:
            return power, law.charge_w_per_v
        return state.charge_limit_w, 0.0
    if voltage_v < law.discharges_below_v:
        power = law.discharge_w_per_v * (law.discharges_below_v - voltage_v)
        if power < state.discharge_limit_w:
            return -power, law.discharge_w_per_v
        return -state.discharge_limit_w, 0.0
    return 0.0, 0.0
