r"""A store on board: what a train takes from the line, where its store gives and takes too.

With the power P that motors and auxiliaries ask for, the power O that electric brakes offer, and the
share g of it that the line takes at the voltage (`vehicle.regeneration`), all means over a step:

- A train that offers more than it asks for fills its store first, S = min(O - P, P_c).  The line is
  offered the rest: it takes P_line = P - g (O - S).
- Else, where P_line = P - g O is above a cap, the store gives the rest of it, up to P_d: what it cannot
  give comes from the line.
- A train that stands at a stop all through the step charges, by as much as its current while it stands,
  the cap, and P_c leave.
- Otherwise it rests.

So P_line = P + S - U, where U is what is used of the offer, and S, the power that the store takes, is
negative where it gives.  P_c and P_d are the limits of the step (`storage.store`).

Where no line is, the store alone feeds the train: it has no more than P_d.

Limits of validity: a train that brakes and pulls within one step is one with the means of both.  Its
current limitation by the line voltage (EN 50388) regards what it asks for, before its store gives.
"""

import math

from tpss.kernel import kernel
from tpss.record import Record
from tpss.storage.store import Store, Stored


class OnBoard(Record):
    """The store of a type of train."""

    store: Store = Store.row()
    """What it can do."""
    start_j: float = 0.0
    """Energy in it when the train enters the line. [J]"""
    line_cap_w: float = math.inf
    """Power from the line above which the store helps; infinite: it does not. [W]"""
    standing_current_a: float = 0.0
    """Highest current from the line while the train stands and charges; 0: it does not. [A]"""


@kernel
def exchange(
    voltage_v: float, asked_w: float, asked_slope: float, offered_w: float, share: float,
    share_slope: float, stands: bool, own: OnBoard, state: Stored,
) -> tuple[float, float, float]:  # fmt: skip
    """Power that a train takes from the line, its slope over the voltage, and what it uses of its offer.

    [W], [W/V], [W]

    Parameters
    ----------
    voltage_v : float
        Voltage at the pantograph. [V]
    asked_w, asked_slope : float
        What motors and auxiliaries ask for, and its slope. [W], [W/V]
    offered_w : float
        What electric brakes offer. [W]
    share, share_slope : float
        Share of an offer that the line takes, and its slope. [1], [1/V]
    stands : bool
        Whether it stands at a stop all through the step.
    own : OnBoard
    state : Stored
        Written: what the store takes.

    References
    ----------
    [SteinerScholten2004]_; the rules at the top of this file.
    """
    if offered_w > asked_w:
        stored, slope = offered_w - asked_w, -asked_slope
        if stored >= state.charge_limit_w:
            stored, slope = state.charge_limit_w, 0.0
        state.power_w = stored
        left_w = offered_w - stored
        line_slope = asked_slope - share_slope * left_w + share * slope
        return asked_w - share * left_w, line_slope, stored + share * left_w
    used_w = share * offered_w
    line_w, line_slope = asked_w - used_w, asked_slope - share_slope * offered_w
    state.power_w = 0.0
    if line_w > own.line_cap_w:
        given = line_w - own.line_cap_w
        if given < state.discharge_limit_w:
            state.power_w = -given
            return own.line_cap_w, 0.0, used_w
        state.power_w = -state.discharge_limit_w
        return line_w - state.discharge_limit_w, line_slope, used_w
    if stands:
        most, most_slope = voltage_v * own.standing_current_a, own.standing_current_a
        if most > own.line_cap_w:
            most, most_slope = own.line_cap_w, 0.0
        if most > line_w + state.charge_limit_w:
            state.power_w = state.charge_limit_w
            return line_w + state.charge_limit_w, line_slope, used_w
        if most > line_w:
            state.power_w = most - line_w
            return most, most_slope, used_w
    return line_w, line_slope, used_w
