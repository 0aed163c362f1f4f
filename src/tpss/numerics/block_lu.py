"""Linear systems over the fixed nodes: block elimination with a pattern found once.

A supply network is a ladder (catenary, feeder, high-voltage line) along the track.  Eliminating its
nodes in an order of least fill touches a bounded number of blocks for each, so the cost grows in
proportion to the nodes.  The order, the fill and the places of all blocks are found once, in plain
Python; each solution then only runs through lists of places.  A block is a pair (see `pairs`).

Passive nodes, whose rows are the same numbers in every system, are eliminated first, and once
(`eliminate_passive`).  With a row of such a node (p) above those of the others (o),

    [A_pp  A_po] [x_p]   [r_p]        A_oo' = A_oo - A_op A_pp⁻¹ A_po,   r_o' = r_o - A_op A_pp⁻¹ r_p
    [A_op  A_oo] [x_o] = [r_o]        x_p = A_pp⁻¹ (r_p - A_po x_o)

each solution begins with A_oo', and only runs through r_o' and x_p: products of plain numbers, as the
second number of the pair of a passive row is 0.  Between the nodes that are left this makes fill, so as
many are taken as makes the rest cheapest.
"""

import heapq
import math
from collections.abc import Collection, Iterable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.kernel import at, inlined
from tpss.numerics.pairs import apply, compose, determinant, inverse
from tpss.record import Record, Records

Complexes = npt.NDArray[np.complex128]
Indices = npt.NDArray[np.int64]

MOST_NEIGHBOURS = (1, 2, 3, 4, 6)
"""Passive nodes with up to so many neighbours are eliminated once, or none: whichever makes the rest
cheapest."""

SUBSTITUTION = 0.1
"""What a block of a row that is eliminated once costs in each solution, of one that is not; an estimate,
on which the order depends, and no result but by roundings. [1]"""


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
    by row; then, for each node, all of its row but those of nodes that are eliminated once."""
    row_start: Indices
    """Where each node's row begins in `places`, and where the last one ends."""
    once: int
    """Number of pivots, the first ones, that are eliminated once."""
    is_once: npt.NDArray[np.bool_]
    """Whether a node is one of them."""


def find_pattern(
    n_nodes: int, edges: Iterable[tuple[int, int]], passive: Collection[int] = ()
) -> tuple[Pattern, dict[tuple[int, int], int]]:
    """Pattern of a network and the place of each block.

    Parameters
    ----------
    n_nodes : int
        Number of nodes.
    edges : iterable of (int, int)
        Pairs of nodes that a branch or a section couples, each of two nodes.
    passive : collection of int
        Nodes whose rows are the same in every system, and hold no second numbers of pairs.

    Returns
    -------
    Pattern, dict
        The dictionary gives the place of each block (row, column).
    """
    coupled: list[set[int]] = [set() for _ in range(n_nodes)]
    for i, j in edges:
        coupled[i].add(j)
        coupled[j].add(i)
    order, later, once = _cheapest_order(coupled, passive)
    place = {(i, i): i for i in range(n_nodes)}
    for node, neighbours in zip(order, later, strict=True):
        for other in neighbours:
            place[node, other] = len(place)
            place[other, node] = len(place)
    is_once = np.zeros(n_nodes, dtype=np.bool_)
    is_once[order[:once]] = True
    rows = _blocks_by_row(n_nodes, place, is_once)
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
        once=once,
        is_once=is_once,
    )
    return pattern, place


def _cheapest_order(
    coupled: list[set[int]], passive: Collection[int]
) -> tuple[list[int], list[list[int]], int]:
    """Order of the nodes, the neighbours that each has in its turn, and how many are eliminated once."""
    best = _order(coupled, (), 0)
    if passive:
        for most in MOST_NEIGHBOURS:
            other = _order(coupled, passive, most)
            if _cost(*other[1:]) < _cost(*best[1:]):
                best = other
    return best


def _cost(later: list[list[int]], once: int) -> float:
    """About what a solution costs. [blocks]"""
    substituted = sum(1 + len(neighbours) for neighbours in later[:once])
    eliminated = sum((1 + len(neighbours)) ** 2 for neighbours in later[once:])
    return eliminated + SUBSTITUTION * substituted


def _order(
    coupled: list[set[int]], passive: Collection[int], most: int
) -> tuple[list[int], list[list[int]], int]:
    """Passive nodes with up to `most` neighbours first, then all others; each time one with the fewest.

    Return the order, the neighbours of each in its turn, and how many came first.
    """
    graph = [set(neighbours) for neighbours in coupled]
    order: list[int] = []
    later: list[list[int]] = []
    _eliminate(passive, most, graph, order, later)
    once = len(order)
    _eliminate(set(range(len(graph))).difference(order), len(graph), graph, order, later)
    return order, later, once


def _eliminate(
    nodes: Collection[int],
    most: int,
    graph: list[set[int]],
    order: list[int],
    later: list[list[int]],
) -> None:
    """Eliminate, again and again, that of some nodes with the fewest neighbours, while it has few."""
    left = set(nodes)
    waiting = [(len(graph[i]), i) for i in left]
    heapq.heapify(waiting)
    while waiting:
        count, node = heapq.heappop(waiting)
        if node not in left or count != len(graph[node]):
            continue  # it has other neighbours by now, and stands further back, or ahead
        if count > most:
            break
        neighbours = sorted(graph[node])
        for i in neighbours:
            graph[i].discard(node)
            graph[i].update(j for j in neighbours if j != i)
            if i in left:
                heapq.heappush(waiting, (len(graph[i]), i))
        left.discard(node)
        order.append(node)
        later.append(neighbours)


def _blocks_by_row(
    n_nodes: int, place: dict[tuple[int, int], int], is_once: npt.NDArray[np.bool_]
) -> list[list[int]]:
    rows: list[list[int]] = [[] for _ in range(n_nodes)]
    for (i, j), block in place.items():
        if not is_once[j]:
            rows[i].append(block)
    return rows


def eliminate_passive(
    pattern: Pattern, constant: Complexes, held: npt.NDArray[np.bool_]
) -> Complexes:
    """Eliminate the rows that are the same in every system.

    Parameters
    ----------
    pattern : Pattern
    constant : array of complex, shape (blocks,)
        What is the same in every system, of all blocks.
    held : array of bool, shape (nodes,)
        Nodes whose own row says that they are 0.  Passive ones are coupled to such nodes only.

    Returns
    -------
    array of complex, shape (blocks,)
        With which a system begins, A_oo'; in the places of passive rows and columns their factors:
        A_pp⁻¹, A_po and A_op A_pp⁻¹.
    """
    found = constant.copy()
    for k in range(pattern.once):
        pivot, target = pattern.pivots[k], int(pattern.pivots[k].update)
        around = pattern.neighbours[pivot.first : pivot.end]
        if held[pivot.node]:
            found[[*around["upper"], *around["lower"]]] = 0.0
            found[pivot.node] = 1.0
            continue
        found[pivot.node] = 1.0 / found[pivot.node]
        found[around["lower"]] *= found[pivot.node]
        fill = np.outer(found[around["lower"]], found[around["upper"]])
        found[pattern.places[target : target + fill.size]] -= fill.ravel()
    return found


@inlined
def carry_over(k: int, pattern: Pattern, factors: Complexes, nodes: Records[Unknown]) -> None:
    """Take the right-hand side of pivot `k`, whose row is eliminated once, to those of the others."""
    pivot = pattern.pivots[at(k)]
    right_side = nodes[at(pivot.node)].right_side
    for a in range(pivot.first, pivot.end):
        neighbour = pattern.neighbours[at(a)]
        nodes[at(neighbour.node)].right_side -= factors[at(neighbour.lower)] * right_side


@inlined
def substitute_passive(pattern: Pattern, factors: Complexes, nodes: Records[Unknown]) -> None:
    """Find the solution at the nodes that are eliminated once from that at the others."""
    for k in range(pattern.once - 1, -1, -1):
        pivot = pattern.pivots[at(k)]
        rest = nodes[at(pivot.node)].right_side
        for a in range(pivot.first, pivot.end):
            neighbour = pattern.neighbours[at(a)]
            rest -= factors[at(neighbour.upper)] * nodes[at(neighbour.node)].right_side
        nodes[at(pivot.node)].right_side = factors[at(pivot.node)] * rest


@inlined
def solve_blocks(pattern: Pattern, blocks: Records[Block], nodes: Records[Unknown]) -> float:
    """Solve the system in place and return the sign of its determinant (0 or NaN: singular).

    Rows that are eliminated once have no part in it; their right-hand sides are carried over before
    (`carry_over`), and their solution is found after it (`substitute_passive`).

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
    for k in range(pattern.once, pattern.pivots.size):
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
    for k in range(pattern.pivots.size - 1, pattern.once - 1, -1):
        pivot = pattern.pivots[at(k)]
        rest = nodes[at(pivot.node)].right_side
        for a in range(pivot.first, pivot.end):
            neighbour = pattern.neighbours[at(a)]
            up = blocks[at(neighbour.upper)]
            rest -= apply(up.p, up.q, nodes[at(neighbour.node)].right_side)
        own = blocks[at(pivot.node)]
        nodes[at(pivot.node)].right_side = apply(own.p, own.q, rest)
    return sign
