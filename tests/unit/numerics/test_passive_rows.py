"""Rows of a linear system that are always the same are eliminated once, whatever the others are."""

import numpy as np
import pytest

from tpss.numerics.block_lu import (
    Block,
    Unknown,
    carry_over,
    eliminate_passive,
    find_pattern,
    solve_blocks,
    substitute_passive,
)

NOTHING_HELD = np.zeros(9, dtype=bool)


def ladder(points: int) -> tuple[list[tuple[int, int]], list[int]]:
    """A contact line, and a feeder of passive nodes joined to it at each point."""
    edges = [(2 * k, 2 * k + 1) for k in range(points)]
    edges += [(2 * k + i, 2 * k + i + 2) for k in range(points - 1) for i in (0, 1)]
    return edges, [2 * k + 1 for k in range(points)]


def solve(edges, passive, constant, pairs, right, held=None):
    """Solution of the system whose passive rows are eliminated first, by the steps of a pass."""
    pattern, place = find_pattern(right.size, edges, passive)
    values = np.zeros(len(place), dtype=complex)
    for at, value in constant.items():
        values[place[at]] = value
    factors = eliminate_passive(pattern, values, NOTHING_HELD if held is None else held)
    blocks, nodes = Block.blank(len(place)), Unknown.blank(right.size)
    blocks.p, nodes.right_side = factors, right
    for at, (p, q) in pairs.items():
        blocks[place[at]].p += p
        blocks[place[at]].q += q
    for k in range(pattern.once):
        carry_over(k, pattern, factors, nodes)
    sign = solve_blocks(pattern, blocks, nodes)
    substitute_passive(pattern, factors, nodes)
    return nodes.right_side, sign, pattern


def dense(n, constant, pairs):
    """The same as a real matrix of twice the size: p δ + q δ̄ for each block."""
    whole = np.zeros((2 * n, 2 * n))
    for (i, j), value in constant.items():
        whole[2 * i : 2 * i + 2, 2 * j : 2 * j + 2] += [
            [value.real, -value.imag],
            [value.imag, value.real],
        ]
    for (i, j), (p, q) in pairs.items():
        whole[2 * i : 2 * i + 2, 2 * j : 2 * j + 2] += [
            [p.real + q.real, -p.imag + q.imag],
            [p.imag + q.imag, p.real - q.real],
        ]
    return whole


def test_the_solution_is_that_of_the_whole_system():
    """Contact line of random pairs over a feeder of plain numbers, eight nodes and one on a spur."""
    rng = np.random.default_rng(5)
    edges, passive = ladder(4)
    edges, passive, n = [*edges, (3, 8)], [*passive, 8], 9

    def number():
        return complex(*rng.normal(size=2))

    constant = {(i, i): 9.0 + number() for i in range(n)}
    constant |= {at: number() for i, j in edges for at in ((i, j), (j, i))}
    line = [0, 2, 4, 6]
    pairs = {(i, j): (number(), number()) for i in line for j in line if abs(i - j) <= 2}
    right = rng.normal(size=n) + 1j * rng.normal(size=n)
    found, sign, pattern = solve(edges, passive, constant, pairs, right)
    whole = dense(n, constant, pairs)
    expected = np.linalg.solve(whole, np.column_stack([right.real, right.imag]).ravel())
    assert pattern.once > 0
    assert found == pytest.approx(expected[::2] + 1j * expected[1::2], rel=1e-12)
    assert sign == np.sign(np.linalg.det(whole))


def test_a_node_that_is_held_has_the_right_side_for_its_solution():
    """x₂ = r₂ = 3, whatever its row was, as it is joined to nothing that is not held; x₀ = r₀ / 2."""
    constant = {(0, 0): 2.0 + 0j, (1, 1): 2.0 + 0j, (2, 2): 0j}
    held = np.array([False, False, True])
    found, _, _ = solve([(0, 1), (1, 2)], [2], constant, {}, np.array([4.0 + 0j, 6.0, 3.0]), held)
    assert found.tolist() == [2.0, 3.0, 3.0]


@pytest.mark.parametrize("points", [3, 50])
def test_as_many_rows_are_eliminated_once_as_makes_the_others_cheapest(points):
    """All of a short feeder; of a long one not so many that all of the line is coupled to all of it."""
    edges, passive = ladder(points)
    chosen, place = find_pattern(2 * points, edges, passive)
    _, none = find_pattern(2 * points, edges)
    assert 0 < chosen.once <= points
    assert (chosen.once == points) == (points == 3)
    assert len(place) < 1.5 * len(none)


def test_elimination_costs_in_proportion_to_the_length():
    def places(points):
        edges, passive = ladder(points)
        return find_pattern(2 * points, edges, passive)[0].places.size

    assert places(400) - places(200) == pytest.approx(2 * (places(200) - places(100)), rel=0.05)
