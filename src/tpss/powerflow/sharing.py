"""Nodes of sources that share a three-phase grid; the equations are those of `shared_grids`."""

from typing import Any

from tpss.kernel import at, where_any
from tpss.numerics.pairs import squared
from tpss.powerflow.network import Flow, Network
from tpss.powerflow.shared_grids import SharedGrids


def _has_its_own(*_: Any) -> bool:
    """`shares_its_grid` where no source does."""
    return False


@where_any(without=_has_its_own)
def shares_its_grid(shared: SharedGrids, s: int) -> bool:
    """Whether source `s` shares its grid with others."""
    return bool(shared.admittance_s[at(s), at(s)] != 0.0)


def _no_balance(*_: Any) -> float:
    """`balance_of_sharing`, which is never asked for where no source shares its grid."""
    return 0.0


@where_any(without=_no_balance)
def balance_of_sharing(shared: SharedGrids, n: int, s: int, network: Network, flow: Flow) -> float:
    """`newton.evaluate_node` of the node of a source that shares its grid.

    References
    ----------
    [Steimel2014]_, the feeding of single-phase lines from the three-phase grid.
    """
    balance = flow.nodes[at(n)].leaving_current_a
    for j in range(network.sources.size):
        admittance = shared.admittance_s[at(s), at(j)]
        if admittance != 0.0:
            other = network.sources[at(j)]
            unloaded_v = other.grid.no_load_voltage_v
            balance += admittance * (flow.nodes[at(other.node)].voltage_v - unloaded_v)
    flow.nodes[at(n)].right_side -= balance
    return squared(balance) * network.system.per_square_ampere


def _no_losses(*_: Any) -> float:
    """`losses_by_others` where no source shares its grid."""
    return 0.0


@where_any(without=_no_losses)
def losses_by_others(shared: SharedGrids, s: int, network: Network, flow: Flow) -> float:
    """What a source loses more, over the currents of others that share its grid. [W]

    That is the real part of its current times the voltage that it loses over theirs; it may be negative.

    References
    ----------
    [Steimel2014]_, as `balance_of_sharing`.
    """
    drop = 0j
    for j in range(network.sources.size):
        other = network.sources[at(j)]
        if shared.mutual_ohm[at(s), at(j)] != 0.0 and other.installed > 0:
            current = flow.nodes[at(other.node)].leaving_current_a
            drop += shared.mutual_ohm[at(s), at(j)] * current
    if network.sources[at(s)].installed == 0:
        return 0.0
    own = flow.nodes[at(network.sources[at(s)].node)].leaving_current_a
    return (drop * own.conjugate()).real
