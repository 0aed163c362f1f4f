"""A network put together from its parts, and the state of a load flow on it."""

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.numerics.block_lu import Block, find_pattern
from tpss.powerflow.bundles import (
    BundlePart,
    bundles_of,
    edges_of_bundles,
    new_bundle_flow,
)
from tpss.powerflow.completion import complete
from tpss.powerflow.groups import edges_within, groups_of, new_group_flow
from tpss.powerflow.links import LinkPart, add_admittances, edges_of_links, links_of
from tpss.powerflow.network import (
    SHORTEST_PIECE_M,
    TOLERANCE,
    Branch,
    Flow,
    Network,
    NodeFlow,
    Search,
    Section,
    SectionFlow,
    SourceFlow,
    Standing,
)
from tpss.powerflow.passive import passive_nodes
from tpss.powerflow.shared_grids import (
    edges_of_shared,
    shared_grids,
    stamp_shared,
)
from tpss.powerflow.system import System, gap_weight, resolution_va
from tpss.record import Records, copy_of_records
from tpss.sources.kinds import Source
from tpss.storage.store import Stored
from tpss.storage.wayside import StoreLaw

Complexes = npt.NDArray[np.complex128]


class SectionPart(NamedTuple):
    """A section as it is given to `assemble`."""

    start_node: int
    end_node: int
    start_m: float
    end_m: float
    impedance_ohm_per_m: complex
    susceptance_s_per_m: float
    mutual_ohm_per_m: complex = 0j

    @property
    def shortest_ohm(self) -> float:
        """Impedance of the whole section, of a metre at least, and without what is in common. [Ω]"""
        length_m = max(SHORTEST_PIECE_M, self.end_m - self.start_m)
        return abs(self.impedance_ohm_per_m - self.mutual_ohm_per_m) * length_m


class BranchPart(NamedTuple):
    """A branch as it is given to `assemble`."""

    start_node: int
    end_node: int
    impedance_ohm: complex


_pattern = lru_cache(maxsize=64)(find_pattern)
"""Patterns by the edges of networks, which share them; nobody changes one."""


def assemble(
    n_nodes: int,
    sections: Sequence[SectionPart],
    branches: Sequence[BranchPart],
    sources: Records[Source],
    system: System,
    *,
    room: Sequence[tuple[int, int]] = (),
    groups: Sequence[Sequence[int]] = (),
    links: Sequence[LinkPart] = (),
    bundles: Sequence[BundlePart] = (),
    flat_pu: Sequence[float] = (),
    inner_ohm: Sequence[float] = (),
    mutual_ohm: Complexes | None = None,
    stores: Records[StoreLaw] | None = None,
) -> Network:
    """Network from its parts.

    Parameters
    ----------
    n_nodes : int
        Number of fixed nodes.
    sections, branches : sequences of SectionPart, of BranchPart
    sources : records of Source
        At most one a node.
    system : System
    room : sequence of (int, int)
        Further pairs of nodes for which the linear system has room.
    groups : sequence of sequences of int
        Numbers of sections side by side that are coupled.
    links : sequence of LinkPart
    bundles : sequence of BundlePart
        None of their sections is one of a group.
    flat_pu, inner_ohm : sequences of float
        Of nodes and sources, where there are bundles: see `Bundles`.
    mutual_ohm : array of complex, shape (sources, sources), optional
        What sources that share a grid do to each other, see `shared_grids`. [Ω]
    stores : records of StoreLaw, optional
    """
    ends = [(part.start_node, part.end_node) for part in sections]
    edges = ends + edges_within(groups, ends)
    edges += [(part.start_node, part.end_node) for part in branches]
    edges += edges_of_links(links) + edges_of_bundles(bundles, ends)
    edges += [*room, *edges_of_shared(mutual_ohm, sources["node"].tolist())]
    joined = {n for pair in [*ends, *room] for n in pair} | set(sources["node"].tolist())
    joined |= set() if stores is None else set(stores["node"].tolist())
    pattern, place = _pattern(n_nodes, tuple(edges), passive_nodes(n_nodes, joined))
    impedances = [abs(part.impedance_ohm) for part in branches]
    impedances += [part.shortest_ohm for part in sections]
    impedances += [abs(part.impedance_ohm) for part in links]
    impedances += [abs(z) for part in bundles for z in part.impedance_ohm_per_m.diagonal()]
    rounding = max(resolution_va(z, system) for z in impedances) / system.base_power_va
    source_of_node = np.full(n_nodes, -1, dtype=np.int64)
    source_of_node[sources["node"]] = np.arange(sources.size)

    def blocks(part: SectionPart | BranchPart) -> tuple[int, int, int, int]:
        a, b = part.start_node, part.end_node
        return place[a, a], place[a, b], place[b, a], place[b, b]

    admittance_s = np.zeros(len(place), dtype=complex)
    for part in branches:
        admittance_s[list(blocks(part))] += np.array([1.0, -1.0, -1.0, 1.0]) / part.impedance_ohm
    linked = links_of(links)
    add_admittances(linked, place, admittance_s)
    inner = np.array(inner_ohm)
    shared = shared_grids(mutual_ohm, sources, inner if bundles else None)
    stamp_shared(admittance_s, shared, sources, place)

    network = Network(
        system=system,
        sections=Section.array(
            (*part[:-1], *blocks(part), gap_weight(part.shortest_ohm, system)) for part in sections
        ),
        branches=Branch.array((*part, 1.0 / part.impedance_ohm) for part in branches),
        sources=sources,
        source_of_node=source_of_node,
        pattern=pattern,
        admittance_s=admittance_s,
        tolerance=max(TOLERANCE, rounding),
        groups=groups_of(groups, ends, place, [part.mutual_ohm_per_m for part in sections]),
        links=linked,
        bundles=bundles_of(bundles, ends, place, np.array(flat_pu), inner),
        shared=shared,
        stores=StoreLaw.blank(0) if stores is None else stores,
    )
    return complete(network)


def new_flow(network: Network, n_trains: int) -> Flow:
    """State of a load flow with room for `n_trains`, all units of the sources running."""
    flow = Flow(
        nodes=NodeFlow.blank(network.source_of_node.size),
        sections=SectionFlow.blank(network.sections.size),
        standing=Standing.blank(n_trains),
        sources=SourceFlow.blank(network.sources.size),
        blocks=Block.blank(network.admittance_s.size),
        sensitivity=np.zeros((2, 2, 2), dtype=complex),
        laws=copy_of_records(network.sources),
        search=Search.blank(1),
        groups=new_group_flow(network.groups),
        bundles=new_bundle_flow(network.bundles, n_trains),
        stores=Stored.blank(network.stores.size),
    )
    flow.stores.energy_j[:] = network.stores["start_j"]
    flow.sources.running[:] = network.sources["installed"]
    flow.standing.train[:] = np.arange(n_trains)
    return flow
