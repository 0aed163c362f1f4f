"""Links between several nodes: the line behind a transformer by its closed form, and what an
autotransformer shares out.
"""

import numpy as np
import pytest

from tpss.powerflow.assembly import SectionPart, assemble
from tpss.powerflow.completion import unfed_nodes
from tpss.powerflow.in_service import constant_admittance, in_service, places_of_blocks
from tpss.powerflow.links import LinkPart
from tpss.powerflow.solve import solve

from networks import BT, STIFF, SYSTEM, constant_loads, highest_root, place, sources

UK = 0.08 + 2.5j
RATIO = 0.9


def behind_a_transformer(load):
    """A stiff source at node 0, a transformer to node 1, and 30 km of line with a train at its end."""
    section = SectionPart(1, 2, 0.0, 30e3, BT, 0.0)
    link = LinkPart((1, 0), (1.0, -RATIO), UK)
    network = assemble(3, [section], [], sources((0, STIFF)), SYSTEM, links=[link])
    return place(network, constant_loads([30e3], [load]))


def test_a_line_behind_a_transformer_is_one_of_its_ratio_and_impedance():
    """U is the root for E = 0.9 · 16.5 kV behind uk and the line, at whose end the train stands.

    The source feeds the current times the ratio.
    """
    load = 2e6 + 0.5e6j
    case = behind_a_transformer(load)
    assert solve(False, case.network, case.flow, case.loads)[0] == 1.0
    expected = highest_root(RATIO * 16.5e3, UK + BT * 30e3, load)
    assert abs(case.train_voltage[0]) == pytest.approx(expected, rel=1e-9)
    current = np.conj(load / case.train_voltage[0])
    assert case.flow.nodes[0].leaving_current_a == pytest.approx(RATIO * current, rel=1e-9)


def test_what_a_transformer_puts_into_the_system_is_its_weights_times_each_other():
    """Y = y w wᵀ: an autotransformer's (1, -2, 1) leaves each winding the same current."""
    weights, nodes, y = np.array([1.0, -2.0, 1.0]), (1, 2, 3), 1.0 / UK
    sections = [SectionPart(0, 1, 0.0, 1e3, BT, 0.0)]
    link = LinkPart(nodes, tuple(weights), UK)
    network = assemble(4, sections, [], sources((0, STIFF)), SYSTEM, links=[link])
    place_of = places_of_blocks(network.pattern) | {(n, n): n for n in range(4)}
    put_in = constant_admittance(network)
    found = [[put_in[place_of[a, b]] for b in nodes] for a in nodes]
    np.testing.assert_allclose(found, y * np.outer(weights, weights))
    assert not unfed_nodes(network).any()


def test_a_transformer_that_is_out_feeds_nothing_and_leaves_nothing_in_the_system():
    network = in_service(behind_a_transformer(1e6 + 0j).network, {}, [], {0: 0.0})
    assert not constant_admittance(network).any()
    assert unfed_nodes(network).tolist() == [False, True, True]
