"""Random networks against a slow, obvious load flow: dense admittance matrix and scipy's root finder."""

import math

import numpy as np
import pytest

from tpss.numerics.block_lu import Block, Unknown, find_pattern, solve_blocks
from tpss.powerflow.solve import solve

from networks import BT, ROTARY, constant_loads, network_of, place, solve_slowly, sources


def random_ladder(rng, n_points, n_trains):
    """A contact line with stations at both ends, a high-voltage line beside it, trains anywhere."""
    points = np.sort(np.append(rng.uniform(5e3, 95e3, n_points - 2), [0.0, 100e3]))
    b = 2 * math.pi * 16.7 * 10e-12
    sections = [(i, i + 1, points[i], points[i + 1], BT, b) for i in range(n_points - 1)]
    branches = [(i, n_points + i, 0.06 + 0.8j) for i in range(n_points)]
    branches += [
        (n_points + i, n_points + i + 1, (0.8e-6 + 1e-6j) * (points[i + 1] - points[i]))
        for i in range(n_points - 1)
    ]
    network = network_of(
        2 * n_points, sections, branches, sources((0, ROTARY), (n_points - 1, ROTARY))
    )
    positions = rng.uniform(100.0, 99.9e3, n_trains)
    powers = rng.uniform(0.0, 2.5e6, n_trains) + 1j * rng.uniform(-0.3e6, 1.5e6, n_trains)
    return place(network, constant_loads(list(positions), list(powers)))


@pytest.mark.parametrize("seed", range(12))
def test_voltages_agree_with_the_slow_solution(seed):
    rng = np.random.default_rng(seed)
    case = random_ladder(rng, int(rng.integers(2, 7)), int(rng.integers(0, 9)))
    share, _ = solve(False, case.network, case.flow, case.loads)
    assert share == 1.0
    expected = solve_slowly(case)
    found = np.concatenate([case.flow.nodes.voltage_v, case.train_voltage])
    assert np.abs(found - expected).max() < 16_500.0 * 1e-8


@pytest.mark.parametrize("seed", range(12))
def test_a_solution_takes_few_passes(seed):
    """Newton's method converges quadratically: a slow but converging fault would show here."""
    rng = np.random.default_rng(100 + seed)
    case = random_ladder(rng, 5, 8)
    _, passes = solve(False, case.network, case.flow, case.loads)
    assert passes <= 8
    case.loads.trains.motion.position_m += 20.0
    moved = place(case.network, case.loads)
    moved.flow.nodes[:], moved.flow.sections.current_a = (
        case.flow.nodes,
        case.flow.sections.current_a,
    )
    _, passes = solve(True, moved.network, moved.flow, moved.loads)
    assert passes <= 4


def test_block_elimination_equals_a_dense_solution():
    rng = np.random.default_rng(7)
    n, edges = 12, [(i, (i * 5 + 3) % 12) for i in range(12)] + [(i, i + 1) for i in range(11)]
    edges = [(i, j) for i, j in edges if i != j]
    pattern, place_of = find_pattern(n, edges)
    blocks, nodes = Block.blank(len(place_of)), Unknown.blank(n)
    dense = np.zeros((2 * n, 2 * n))
    for i, j in [(i, i) for i in range(n)] + edges + [(j, i) for i, j in edges]:
        p, q = rng.normal(size=2) @ [1, 1j], rng.normal(size=2) @ [1, 1j]
        p += 9.0 * (i == j)
        blocks[place_of[i, j]].p, blocks[place_of[i, j]].q = p, q
        # p δ + q conj(δ) as a 2 x 2 real matrix
        dense[2 * i : 2 * i + 2, 2 * j : 2 * j + 2] = [
            [p.real + q.real, -p.imag + q.imag],
            [p.imag + q.imag, p.real - q.real],
        ]
    right = rng.normal(size=2 * n)
    nodes.right_side = right[::2] + 1j * right[1::2]
    sign = solve_blocks(pattern, blocks, nodes)
    expected = np.linalg.solve(dense, right)
    assert nodes.right_side == pytest.approx(expected[::2] + 1j * expected[1::2], rel=1e-10)
    assert sign == np.sign(np.linalg.det(dense))


def test_elimination_of_a_ladder_costs_in_proportion_to_its_length():
    """Three nodes at each of n points: the places visited grow by the same number for each point."""

    def places(points):
        edges = [(3 * k + i, 3 * k + i + 1) for k in range(points) for i in range(2)]
        edges += [(3 * k + i, 3 * k + i + 3) for k in range(points - 1) for i in (0, 2)]
        return find_pattern(3 * points, edges)[0].places.size

    growth = places(200) - places(100)
    assert places(400) - places(200) == pytest.approx(2 * growth, rel=0.05)
