"""Passive nodes: those to which nothing but lumped branches and links is joined.

Their rows of the linear system are the same in every pass, so they are eliminated when a network is put
together (`numerics.block_lu`).
"""

from collections.abc import Iterable

from tpss.kernel import at, inlined
from tpss.numerics.block_lu import carry_over
from tpss.numerics.pairs import squared
from tpss.powerflow.network import UNFED, Flow, Network


def passive_nodes(n_nodes: int, joined: Iterable[int]) -> tuple[int, ...]:
    """Nodes without any of those to which sections, sources or stores are joined."""
    return tuple(sorted(set(range(n_nodes)).difference(joined)))


@inlined
def evaluate_passive(k: int, derivatives: bool, network: Network, flow: Flow) -> float:
    """`newton.evaluate_node` of pivot `k`, which is eliminated once: its row is carried over."""
    n = network.pattern.pivots[at(k)].node
    node = flow.nodes[at(n)]
    if network.source_of_node[at(n)] == UNFED:
        residual, per_square = node.voltage_v, network.system.per_square_volt
    else:
        residual, per_square = node.leaving_current_a, network.system.per_square_ampere
    if derivatives:
        node.right_side -= residual
        carry_over(k, network.pattern, network.admittance_s, flow.nodes)
    return squared(residual) * per_square
