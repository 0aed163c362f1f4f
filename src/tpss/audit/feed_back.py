"""The audit of electric brakes: that they give no more than all brakes, and the line takes its share."""

from tpss.audit.balances import Balances, worst
from tpss.kernel import inlined
from tpss.numerics.curve import Points, extremes
from tpss.numerics.pairs import magnitude
from tpss.step.recording import Recording
from tpss.vehicle.on_board import has_store
from tpss.vehicle.part_load import range_over_load
from tpss.vehicle.regeneration import taken_share
from tpss.vehicle.train_type import TrainType

CLOSED_V = 1e-4
"""How far the voltage that is recorded may be from the one at which a train was asked last: what is
left of a section's gap is spread over it. [V]"""


@inlined
def audit_feed_back(
    step: int, i: int, kind: TrainType, points: Points, recording: Recording, figures: Balances
) -> None:
    """Note by how much the power that a train feeds back is off its brakes and its voltage, in a step.

    What it offers follows from the work of its electric brakes, but for the efficiency, which changes
    with speed and load: it is taken as far as some efficiency of the train's makes it that.

    References
    ----------
    [EN50163]_, as `vehicle.regeneration.taken_share`.
    """
    row, braked, own = recording.regeneration[step, i], recording.trains[step, i], kind.regeneration
    offered, electric = row.regenerated_power + row.refused_power, row.electric_braking_power
    # 1. The electric brakes are a part of all brakes, and have no more power than they may.
    over = max(0.0, electric - braked.braking_power, electric - own.highest_power_w, -electric)
    figures.power_mismatch_va = worst(figures.power_mismatch_va, over)
    # 2. What they offer.
    low, high = extremes(own.efficiency, points)
    low_load, high_load = range_over_load(own.over_load)
    least, most = low * low_load * electric, high * high_load * electric
    off = offered - min(max(offered, least), most)
    figures.power_mismatch_va = worst(figures.power_mismatch_va, off)
    # 3. What the line takes of it; beside a store that is a matter of `audit.on_board`.
    if has_store(kind):
        return
    voltage = magnitude(complex(braked.pantograph_real, braked.pantograph_imag))
    share, slope = taken_share(voltage, own)
    off = abs(row.regenerated_power - share * offered) + slope * offered * CLOSED_V
    figures.power_mismatch_va = worst(figures.power_mismatch_va, max(0.0, off))
