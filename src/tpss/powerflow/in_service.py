"""A network with some of its elements out of service.

Nodes, branches, sections and sources stay as many and keep their places, so that a run may go from one
network to the other.  Out of service are

    a source      it has no units, and no node is its own: that is one without a source
    some units    the source has fewer
    a branch      its admittance is 0
    a link        likewise, or a part of it, if it stands for several units
    a store       no voltage lets it take or give anything

Nodes that no source reaches by what is left are marked as `UNFED`.
"""

from collections.abc import Collection, Mapping

import numpy as np
import numpy.typing as npt

from tpss.numerics.block_lu import Pattern
from tpss.powerflow.bundles import NO_BUNDLES
from tpss.powerflow.completion import complete
from tpss.powerflow.links import add_admittances, weakened
from tpss.powerflow.network import UNFED, Network
from tpss.powerflow.shared_grids import NO_SHARED_GRIDS, shared_grids, stamp_shared
from tpss.record import Records, copy_of_records
from tpss.storage.wayside import StoreLaw


def in_service(
    network: Network,
    units: Mapping[int, int],
    opened: Collection[int],
    shares_of_links: Mapping[int, float] | None = None,
    idle_stores: Collection[int] = (),
) -> Network:
    """The network, none of whose nodes follows, with less in service.

    Parameters
    ----------
    network : Network
        With all in service.
    units : mapping of int to int
        Units that are in service, by the number of their source; of others all are.
    opened : collection of int
        Numbers of the branches that are out.
    shares_of_links : mapping of int to float, optional
        Share of links that is in service, by their numbers; of others all is. [1]
    idle_stores : collection of int
        Numbers of the stores of energy that are out.
    """
    sources, branches = copy_of_records(network.sources), copy_of_records(network.branches)
    source_of_node = network.source_of_node.copy()
    for number, count in units.items():
        sources[number].installed = count
        if count == 0:
            source_of_node[sources[number].node] = -1
    for number in opened:
        branches[number].admittance_s = 0.0
    source_of_node[source_of_node == UNFED] = -1
    changed = network._replace(sources=sources, branches=branches, source_of_node=source_of_node)
    changed = changed._replace(links=weakened(network.links, shares_of_links or {}))
    if idle_stores:
        changed = changed._replace(stores=_idle(network.stores, idle_stores))
    if network.shared != NO_SHARED_GRIDS:
        inner_ohm = None if network.bundles == NO_BUNDLES else network.bundles.inner_ohm
        shared = shared_grids(network.shared.mutual_ohm, sources, inner_ohm)
        changed = changed._replace(shared=shared)
    return complete(changed._replace(admittance_s=constant_admittance(changed)))


def _idle(stores: Records[StoreLaw], out: Collection[int]) -> Records[StoreLaw]:
    """Stores at the line, some of which follow no voltage."""
    changed = copy_of_records(stores)
    for number in out:
        changed[number].charge_w_per_v = changed[number].discharge_w_per_v = 0.0
    return changed


def constant_admittance(network: Network) -> npt.NDArray[np.complex128]:
    """What branches and links in service, and common grids, put into each block of the system. [S]

    Summed anew: what is left of a sum after a part of it is taken off is a rounding, not nothing.
    """
    place = places_of_blocks(network.pattern)
    total = np.zeros_like(network.admittance_s)
    for k in range(network.branches.size):
        branch = network.branches[k]
        a, b, admittance = branch.start_node, branch.end_node, branch.admittance_s
        total[[a, b]] += admittance
        total[[place[a, b], place[b, a]]] -= admittance
    add_admittances(network.links, place, total)
    stamp_shared(total, network.shared, network.sources, place)
    return total


def places_of_blocks(pattern: Pattern) -> dict[tuple[int, int], int]:
    """Places of the blocks between different nodes."""
    place = {}
    for k in range(pattern.pivots.size):
        pivot = pattern.pivots[k]
        for j in range(pivot.first, pivot.end):
            neighbour = pattern.neighbours[j]
            place[int(pivot.node), int(neighbour.node)] = int(neighbour.upper)
            place[int(neighbour.node), int(pivot.node)] = int(neighbour.lower)
    return place
