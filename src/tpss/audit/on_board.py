"""The audit of stores on board: their rule at the line, their limits, and what is left in them."""

from tpss.audit.balances import Balances, worst
from tpss.audit.feed_back import CLOSED_V
from tpss.audit.stores import energy_mismatch_w
from tpss.kernel import kernel
from tpss.numerics.pairs import magnitude
from tpss.step.recording import Recording
from tpss.step.state import TrainState
from tpss.storage.on_board import exchange
from tpss.storage.store import Stored, begin_store
from tpss.vehicle.regeneration import taken_share
from tpss.vehicle.train_type import TrainType


@kernel
def audit_own_store(
    step: int, i: int, step_s: float, kind: TrainType, recording: Recording, state: Stored,
    figures: Balances,
) -> None:  # fmt: skip
    """Note how far a train and its store are off their rule in a step of this length. [s]

    What the train asks for follows from the line, the store and the brakes; that it is what the motors
    need is a matter of the traction balance.

    References
    ----------
    [SteinerScholten2004]_, as `storage.on_board.exchange`.
    """
    row, train, own = recording.on_board[step, i], recording.trains[step, i], kind.on_board
    after_j = recording.on_board[step + 1, i].train_stored_energy
    taken, line = row.train_storage_power, train.active_power
    # 1. The energy.
    off_w = energy_mismatch_w(
        row.train_stored_energy, after_j, taken, row.train_storage_losses, step_s, own.store
    )
    figures.power_mismatch_va = worst(figures.power_mismatch_va, off_w)
    # 2. What the brakes offer, and what the train asks for.
    offered = used = 0.0
    if recording.regeneration.shape[0] > 0:
        brakes = recording.regeneration[step, i]
        used, offered = brakes.regenerated_power, brakes.regenerated_power + brakes.refused_power
    asked = line - taken + used
    state.energy_j = row.train_stored_energy
    begin_store(step_s, own.store, state)
    # 3. The rule, without a line and with one.
    voltage = magnitude(complex(train.pantograph_real, train.pantograph_imag))
    if voltage == 0.0:
        off_w = taken - min(offered - asked, state.charge_limit_w)
        figures.power_mismatch_va = worst(figures.power_mismatch_va, off_w)
        over_w = max(0.0, -taken - state.discharge_limit_w)
        figures.power_mismatch_va = worst(figures.power_mismatch_va, over_w)
        figures.power_mismatch_va = worst(figures.power_mismatch_va, line)
        return
    charges = recording.train_state[step, i] == TrainState.DWELLING and taken > 0.0
    share, slope = taken_share(voltage, kind.regeneration)
    expected, _, _ = exchange(voltage, asked, 0.0, offered, share, slope, charges, own, state)
    blurred_w = CLOSED_V * (own.standing_current_a - slope * offered)
    off_w = max(0.0, abs(line - expected) - blurred_w)
    figures.power_mismatch_va = worst(figures.power_mismatch_va, off_w)
    off_w = max(0.0, abs(taken - state.power_w) - blurred_w)
    figures.power_mismatch_va = worst(figures.power_mismatch_va, off_w)
