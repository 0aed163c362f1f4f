"""What follows from the parts of a network: nodes that no source reaches, rows that stay the same."""

import numpy as np
import numpy.typing as npt

from tpss.numerics.block_lu import eliminate_passive
from tpss.powerflow.bundles import without_dead_conductors
from tpss.powerflow.links import ends_of
from tpss.powerflow.network import UNFED, Network


def complete(network: Network) -> Network:
    """The network, its unfed nodes marked and its passive ones eliminated.

    Parameters
    ----------
    network : Network
        Its `admittance_s` is what branches, links and grids of several sources put into each block of
        the system.
    """
    unfed = unfed_nodes(network)
    network = network._replace(
        source_of_node=np.where(unfed, UNFED, network.source_of_node),
        admittance_s=eliminate_passive(network.pattern, network.admittance_s, unfed),
    )
    if not unfed.any():
        return network
    dead = unfed[network.sections["start_node"]]
    return network._replace(bundles=without_dead_conductors(network.bundles, dead))


def unfed_nodes(network: Network) -> npt.NDArray[np.bool_]:
    """Nodes that no source in service reaches by what is in service, and sections, shape (nodes,)."""
    neighbours: list[list[int]] = [[] for _ in range(network.source_of_node.size)]
    carrying = network.branches["admittance_s"] != 0.0
    starts = [*network.branches["start_node"][carrying], *network.sections["start_node"]]
    ends = [*network.branches["end_node"][carrying], *network.sections["end_node"]]
    for start, end in zip(starts, ends, strict=True):
        neighbours[start].append(end)
        neighbours[end].append(start)
    for k, (nodes, _) in enumerate(ends_of(network.links)):
        if network.links.admittance_s[k] != 0.0:
            for node in nodes:
                neighbours[node] += [other for other in nodes if other != node]
    unfed = network.source_of_node < 0
    waiting = np.flatnonzero(~unfed).tolist()
    while waiting:
        for node in neighbours[waiting.pop()]:
            if unfed[node]:
                unfed[node] = False
                waiting.append(node)
    return unfed
