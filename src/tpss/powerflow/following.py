"""Nodes that are another node's second name: nothing is joined to them, and they have its voltage.

A run that opens a switch goes from a network in which its two sides are one node to one of the same
shapes in which they are two.  While they are one, all is joined to one of them, and the other follows.
"""

from collections.abc import Mapping

import numpy as np

from tpss.kernel import at, kernel
from tpss.numerics.pairs import squared
from tpss.powerflow.in_service import places_of_blocks
from tpss.powerflow.network import UNFED, Flow, Network

FOLLOWS = -3
"""In `Network.source_of_node`: this, or less by the number of a node, is one that follows that node."""


def leaders_of(network: Network) -> dict[int, int]:
    """Nodes of a network that follow others, and these."""
    codes = network.source_of_node
    return {int(n): FOLLOWS - int(codes[n]) for n in np.flatnonzero(codes <= FOLLOWS)}


def following(network: Network, leader: Mapping[int, int]) -> Network:
    """The network in which some nodes, to which nothing is joined, have the voltage of others.

    The row of such a node, which nothing else is added to, is that of V - V' = 0.

    Parameters
    ----------
    network : Network
        With room in its linear system for each of the pairs.
    leader : mapping of int to int
        The node that each of them follows.
    """
    place = places_of_blocks(network.pattern)
    source_of_node, admittance_s = network.source_of_node.copy(), network.admittance_s.copy()
    for node, other in leader.items():
        if source_of_node[other] == UNFED:
            continue  # so is the node itself, and both are at 0
        source_of_node[node] = FOLLOWS - other
        admittance_s[node] += 1.0
        admittance_s[place[node, other]] -= 1.0
    return network._replace(source_of_node=source_of_node, admittance_s=admittance_s)


@kernel
def follow(n: int, other: int, network: Network, flow: Flow) -> float:
    """`newton.evaluate_node` of one that follows another; its row stands in `Network.admittance_s`."""
    apart_v = flow.nodes[at(n)].voltage_v - flow.nodes[at(other)].voltage_v
    flow.nodes[at(n)].right_side -= apart_v
    return squared(apart_v) * network.system.per_square_volt
