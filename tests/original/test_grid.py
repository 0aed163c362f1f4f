"""The grid of the original load flow, laid out by hand: a station, two trains, a node half-way, the end.

node 0 ---4 km--- train 3 ---6 km--- node 1 ---1 km--- train 4 ---9 km--- node 2
"""

import numpy as np
import pytest

from tpss.original.grid import lay_out

from networks import BT, STIFF, constant_loads, network_of, place, sources

B = 1e-9  # susceptance. [S/m]


@pytest.fixture
def grid():
    sections = [(0, 1, 0.0, 10e3, BT, B), (1, 2, 10e3, 20e3, BT, B)]
    network = network_of(3, sections, [(0, 2, 2 + 1j)], sources((0, STIFF)))
    case = place(network, constant_loads([11e3, 4e3], [1e6, 1e6]))
    return lay_out(2, case.network, case.flow)


def test_every_piece_between_neighbours_is_an_element_after_the_branches(grid):
    ends = list(zip(grid.start.tolist(), grid.end.tolist(), strict=True))
    assert ends == [(0, 2), (0, 3), (3, 1), (1, 4), (4, 2)]
    assert grid.admittance_s[0] == pytest.approx(1 / (2 + 1j))
    assert 1 / grid.admittance_s[1:] == pytest.approx(BT * np.array([4e3, 6e3, 1e3, 9e3]))
    assert grid.half_shunt_s == pytest.approx(0.5j * B * np.array([0.0, 4e3, 6e3, 1e3, 9e3]))


def test_rows_of_the_admittance_matrix_sum_to_the_shunts_of_their_nodes(grid):
    matrix = grid.admittance_matrix()
    lengths_m = np.array([4e3, 7e3, 9e3, 10e3, 10e3])  # of the pieces that meet at each node
    assert matrix.sum(axis=1) == pytest.approx(0.5j * B * lengths_m, abs=1e-15)
    assert matrix[0, 3] == pytest.approx(-1 / (BT * 4e3))
    assert matrix[0, 1] == 0.0
    assert (matrix == matrix.T).all()


def test_currents_of_the_sections_are_those_of_their_first_and_last_piece(grid):
    voltage_v = np.array([16.0, 15.8, 15.5, 15.9, 15.7]) * 1e3 + 0j
    entering, leaving = grid.section_currents_a(voltage_v)
    shunt = 0.5j * B
    assert entering[0] == pytest.approx(100.0 / (BT * 4e3) + shunt * 4e3 * 16.0e3)
    assert leaving[0] == pytest.approx(100.0 / (BT * 6e3) - shunt * 6e3 * 15.8e3)
    assert entering[1] == pytest.approx(100.0 / (BT * 1e3) + shunt * 1e3 * 15.8e3)
    assert leaving[1] == pytest.approx(200.0 / (BT * 9e3) - shunt * 9e3 * 15.5e3)
