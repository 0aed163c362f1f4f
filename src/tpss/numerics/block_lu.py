"""Linear systems over the fixed nodes: block elimination with a pattern found once.

A supply network is a ladder (catenary, feeder, high-voltage line) along the track.  Eliminating its
nodes in an order of least fill touches a bounded number of blocks for each, so the cost grows in
proportion to the nodes.  The order, the fill and the places of all blocks are found once, in plain
Python; each solution then only runs through lists of places.  A block is a pair (see `pairs`).
"""

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.kernel import at, inlined
from tpss.numerics.pairs import apply, compose, determinant, inverse
from tpss.record import Record, Records

Indices = npt.NDArray[np.int64]


class Block(Record):
    """A block of the linear system, as a pair."""

    p: complex
    q: complex


class Unknown(Record):
    """What the linear system has of a node."""

    right_side: complex
    """Right-hand side, then the solution."""


class Pivot(Record):
    """A node in the order of elimination."""

    node: int
    first: int
    """Bounds of its neighbours."""
    end: int
    update: int
    """Where its updates begin in `Pattern.places`."""


class Neighbour(Record):
    """A node eliminated later, coupled to the pivot's node, fill included."""

    node: int
    upper: int
    """Place of the block (pivot's node, neighbour)."""
    lower: int
    """Place of the block (neighbour, pivot's node)."""


class Pattern(NamedTuple):
    """Places of blocks and the order of elimination.  The block (i, i) has the place i."""

    pivots: Records[Pivot]
    """In the order of elimination."""
    neighbours: Records[Neighbour]
    """Pivot by pivot."""
    places: Indices
    """Places of blocks that belong together: for each pivot those of (neighbour a, neighbour b), row
    by row; then, for each node, all of its row."""
    row_start: Indices
    """Where each node's row begins in `places`, and where the last one ends."""


def find_pattern(
    n_nodes: int, edges: Iterable[tuple[int, int]]
) -> tuple[Pattern, dict[tuple[int, int], int]]:
    """Pattern of a network and the place of each block.

    Parameters
    ----------
    n_nodes : int
        Number of nodes.
    edges : iterable of (int, int)
        Pairs of nodes that a branch or a section couples, each of two nodes.

    Returns
    -------
    Pattern, dict
        The dictionary gives the place of each block (row, column).
    """
    coupled: list[set[int]] = [set() for _ in range(n_nodes)]
    for i, j in edges:
        coupled[i].add(j)
        coupled[j].add(i)
    order, later = _order_of_least_fill(coupled)
    place = {(i, i): i for i in range(n_nodes)}
    for node, neighbours in zip(order, later, strict=True):
        for other in neighbours:
            place[node, other] = len(place)
            place[other, node] = len(place)
    rows = _blocks_by_row(n_nodes, place)
    starts = np.cumsum([0, *(len(js) for js in later)])
    updates = np.cumsum([0, *(len(js) ** 2 for js in later)])
    pivots = zip(order, starts, starts[1:], updates, strict=False)
    pairs = [(i, j) for i, js in zip(order, later, strict=True) for j in js]
    places = [place[a, b] for js in later for a in js for b in js]
    pattern = Pattern(
        pivots=Pivot.array(pivots),
        neighbours=Neighbour.array((j, place[i, j], place[j, i]) for i, j in pairs),
        places=np.array([*places, *(block for row in rows for block in row)], dtype=np.int64),
        row_start=len(places) + np.cumsum([0, *(len(row) for row in rows)], dtype=np.int64),
    )
    return pattern, place


def _order_of_least_fill(coupled: list[set[int]]) -> tuple[list[int], list[list[int]]]:
    """Eliminate, again and again, a node with the fewest neighbours; return order and neighbours."""
    graph = [set(neighbours) for neighbours in coupled]
    left = set(range(len(graph)))
    order: list[int] = []
    later: list[list[int]] = []
    while left:
        node = min(left, key=lambda i: (len(graph[i]), i))
        neighbours = sorted(graph[node])
        for i in neighbours:
            graph[i].discard(node)
            graph[i].update(j for j in neighbours if j != i)
        left.discard(node)
        order.append(node)
        later.append(neighbours)
    return order, later


def _blocks_by_row(n_nodes: int, place: dict[tuple[int, int], int]) -> list[list[int]]:
    rows: list[list[int]] = [[] for _ in range(n_nodes)]
    for (i, _), block in place.items():
        rows[i].append(block)
    return rows


@inlined
def solve_blocks(pattern: Pattern, blocks: Records[Block], nodes: Records[Unknown]) -> float:
    """Solve the system in place and return the sign of its determinant (0 or NaN: singular).

    Parameters
    ----------
    pattern : Pattern
    blocks : records of Block
        Overwritten.
    nodes : records of Unknown
        The right-hand side; overwritten by the solution.
    """
    sign = 1.0
    # 1. Eliminate forwards; each pivot's inverse replaces it.
    for k in range(pattern.pivots.size):
        pivot = pattern.pivots[at(k)]
        own, target = blocks[at(pivot.node)], pivot.update
        sign *= math.copysign(1.0, determinant(own.p, own.q))
        own.p, own.q = inverse(own.p, own.q)
        for a in range(pivot.first, pivot.end):
            neighbour = pattern.neighbours[at(a)]
            low = blocks[at(neighbour.lower)]
            lp, lq = compose(low.p, low.q, own.p, own.q)
            for b in range(pivot.first, pivot.end):
                up = blocks[at(pattern.neighbours[at(b)].upper)]
                changed = blocks[at(pattern.places[at(target)])]
                dp, dq = compose(lp, lq, up.p, up.q)
                changed.p -= dp
                changed.q -= dq
                target += 1
            right_side = nodes[at(pivot.node)].right_side
            nodes[at(neighbour.node)].right_side -= apply(lp, lq, right_side)
    # 2. Substitute backwards.
    for k in range(pattern.pivots.size - 1, -1, -1):
        pivot = pattern.pivots[at(k)]
        rest = nodes[at(pivot.node)].right_side
        for a in range(pivot.first, pivot.end):
            neighbour = pattern.neighbours[at(a)]
            up = blocks[at(neighbour.upper)]
            rest -= apply(up.p, up.q, nodes[at(neighbour.node)].right_side)
        own = blocks[at(pivot.node)]
        nodes[at(pivot.node)].right_side = apply(own.p, own.q, rest)
    return sign
