"""The audit of stores of energy at the line: their law, their limits, and what is left in them."""

from tpss.audit.balances import Balances, Scratch, worst
from tpss.kernel import kernel
from tpss.numerics.pairs import magnitude
from tpss.powerflow.network import UNFED, Network
from tpss.record import Records
from tpss.step.recorded import StoreRow
from tpss.storage.store import Store, begin_store
from tpss.storage.wayside import power_at_voltage


@kernel
def join_stores(
    step: int, network: Network, rows: Records[StoreRow], scratch: Scratch, figures: Balances
) -> None:
    """Add what stores take in a step to the currents that leave their nodes."""
    for m in range(network.stores.size):
        node, power = network.stores[m].node, rows[step, m].store_power
        voltage = scratch.node_v[node]
        if voltage == 0.0:
            figures.power_mismatch_va = worst(figures.power_mismatch_va, power)
        else:
            scratch.leaving_a[node] += (power / voltage).conjugate()


@kernel
def audit_stores(
    step: int, step_s: float, network: Network, rows: Records[StoreRow], scratch: Scratch,
    figures: Balances,
) -> None:  # fmt: skip
    """Note how far stores are off their law in a step of this length, and their energy off its balance.

    [s]

    References
    ----------
    [SteinerScholten2004]_, as `storage.store`.
    """
    for m in range(network.stores.size):
        law, row, state = network.stores[m], rows[step, m], scratch.stored[0]
        after_j = rows[step + 1, m].stored_energy
        state.energy_j = row.stored_energy
        begin_store(step_s, law.store, state)
        asked = 0.0
        if network.source_of_node[law.node] != UNFED:
            asked, _ = power_at_voltage(magnitude(scratch.node_v[law.node]), law, state)
        figures.power_mismatch_va = worst(figures.power_mismatch_va, row.store_power - asked)
        off_w = energy_mismatch_w(
            row.stored_energy, after_j, row.store_power, row.store_losses, step_s, law.store
        )
        figures.power_mismatch_va = worst(figures.power_mismatch_va, off_w)
        figures.stored_j += row.store_power * step_s


@kernel
def energy_mismatch_w(
    before_j: float, after_j: float, power_w: float, lost_w: float, step_s: float, store: Store
) -> float:
    """Largest of what is missing from a store's balance, and of what passes its bounds, as a power. [W]

    Parameters
    ----------
    before_j, after_j : float
        Energy at both ends of a step. [J]
    power_w, lost_w : float
        Power that it takes, and what it loses of it. [W]
    step_s : float
        Length of the step. [s]
    store : Store

    References
    ----------
    [SteinerScholten2004]_, as `storage.store`.
    """
    kept_j = power_w * step_s
    kept_j *= store.charge_efficiency if power_w > 0.0 else 1.0 / store.discharge_efficiency
    standby_j = min(store.standby_w * step_s, before_j)
    off_j = abs(before_j - standby_j + kept_j - after_j)
    off_j = worst(off_j, before_j + (power_w - lost_w) * step_s - after_j)
    off_j = worst(off_j, max(0.0, -after_j, after_j - store.capacity_j))
    return off_j / step_s
