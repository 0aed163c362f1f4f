r"""Links: lumped linear elements between several nodes, such as transformers between conductors.

A link has an admittance y and a weight w_i at each of its nodes.  Its voltage is the sum of the nodes'
voltages, each times its weight, and its current leaves every node times that node's weight,

.. math:: I = y \sum_j w_j V_j, \qquad I_i = w_i I .

With the weights 1 and -1 that is a branch.  A transformer of the ratio n between a contact line and two
conductors of a grid has 1, -n and n; an autotransformer between contact line, rails and feeder has 1,
-2 and 1.  As \(\sum_i V_i \bar I_i = \bar y |\sum_j w_j V_j|^2\), what is lost in it is its part that is
real.

A network without links has an empty tuple in their place, see `kernel.where_any`.

References
----------
[Steimel2014]_, on transformers; the formulae above.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import combinations
from typing import Any, NamedTuple, cast

import numpy as np
import numpy.typing as npt

from tpss.kernel import at, inlined, where_any
from tpss.numerics.pairs import scaled, squared
from tpss.record import Records

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]
Indices = npt.NDArray[np.int64]


class LinkPart(NamedTuple):
    """A link as it is given to `assembly.assemble`."""

    nodes: tuple[int, ...]
    weights: tuple[float, ...]
    """Of the voltage of each node. [1]"""
    impedance_ohm: complex


class Links(NamedTuple):
    """All links of a network."""

    admittance_s: Complexes
    """Of each link; 0: it is out of service. [S]"""
    first: Indices
    """Where the ends of each link begin in `node`, and where those of the last one end."""
    node: Indices
    """Nodes, link by link."""
    weight: Floats
    """Weight of each of them. [1]"""


NO_LINKS = cast("Links", ())


def links_of(parts: Sequence[LinkPart]) -> Links:
    """Links from their parts."""
    if not parts:
        return NO_LINKS
    return Links(
        admittance_s=np.array([1.0 / part.impedance_ohm for part in parts], dtype=complex),
        first=np.cumsum([0, *(len(part.nodes) for part in parts)], dtype=np.int64),
        node=np.array([node for part in parts for node in part.nodes], dtype=np.int64),
        weight=np.array([weight for part in parts for weight in part.weights], dtype=float),
    )


def count_links(links: Links) -> int:
    """Number of links."""
    return 0 if links == NO_LINKS else links.admittance_s.size


def edges_of_links(parts: Iterable[LinkPart]) -> list[tuple[int, int]]:
    """Pairs of nodes that links couple."""
    return [pair for part in parts for pair in combinations(dict.fromkeys(part.nodes), 2)]


def ends_of(links: Links) -> Iterator[tuple[Indices, Floats]]:
    """Nodes and weights of each link."""
    if links != NO_LINKS:
        for begin, end in zip(links.first, links.first[1:], strict=False):
            yield links.node[begin:end], links.weight[begin:end]


def add_admittances(
    links: Links, place: Mapping[tuple[int, int], int], admittance_s: Complexes
) -> None:
    """Add what links put into each block of the linear system. [S]

    Parameters
    ----------
    place : mapping
        Place of the block of each two different nodes; that of a node itself is its number.
    admittance_s : Complexes
        Changed.
    """
    for k, (nodes, weights) in enumerate(ends_of(links)):
        for i, w_i in zip(nodes.tolist(), weights, strict=True):
            for j, w_j in zip(nodes.tolist(), weights, strict=True):
                block = i if i == j else place[i, j]
                admittance_s[block] += links.admittance_s[k] * w_i * w_j


def weakened(links: Links, shares: Mapping[int, float]) -> Links:
    """The links, of which shares of some are in service by their numbers; 0: they are out. [1]"""
    if not shares:
        return links
    admittance_s = links.admittance_s.copy()
    for number, share in shares.items():
        admittance_s[number] *= share
    return links._replace(admittance_s=admittance_s)


@inlined
def link_current(k: int, links: Links, nodes: Records[Any]) -> complex:
    """Current of a link. [A]

    References
    ----------
    [Steimel2014]_, on transformers; the formulae at the top of this file.
    """
    voltage = 0j
    for end in range(links.first[at(k)], links.first[at(k + 1)]):
        voltage += scaled(nodes[at(links.node[at(end)])].voltage_v, links.weight[at(end)])
    return links.admittance_s[at(k)] * voltage


def _nothing_leaves(*_: Any) -> None:
    """`leave_by_links` of no links."""


@where_any(without=_nothing_leaves)
def leave_by_links(links: Links, nodes: Records[Any]) -> None:
    """Add the currents into links to those that leave the nodes."""
    for k in range(links.admittance_s.size):
        current = link_current(k, links, nodes)
        for end in range(links.first[at(k)], links.first[at(k + 1)]):
            nodes[at(links.node[at(end)])].leaving_current_a += scaled(
                current, links.weight[at(end)]
            )


def _nothing_recorded(*_: Any) -> float:
    """`record_links` of no links. [W]"""
    return 0.0


@where_any(without=_nothing_recorded)
def record_links(links: Links, step: int, nodes: Records[Any], rows: Records[Any]) -> float:
    """Write the currents of all links into their rows of a recording; return their losses. [W]"""
    lost_w = 0.0
    for k in range(links.admittance_s.size):
        current, admittance_s = link_current(k, links, nodes), links.admittance_s[at(k)]
        rows[at(step), at(k)].link_real = current.real
        rows[at(step), at(k)].link_imag = current.imag
        if admittance_s != 0.0:
            lost_w += admittance_s.real * squared(current) / squared(admittance_s)
    return lost_w
