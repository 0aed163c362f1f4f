"""Nodes that follow others, to which nothing is joined: their voltage is that of the other one."""

import numpy as np
import pytest

from tpss.powerflow.assembly import SectionPart, assemble
from tpss.powerflow.chain import FLAT
from tpss.powerflow.following import FOLLOWS, following
from tpss.powerflow.network import UNFED
from tpss.powerflow.newton import MOST_PASSES, Solution, newton

from networks import BT, STIFF, SYSTEM, constant_loads, place, sources


def line(*nodes, room=()):
    """20 km in two sections between three of four nodes, a station at each end, node 3 to spare."""
    start, middle, end = nodes
    parts = [
        SectionPart(start, middle, 0.0, 10e3, BT, 0.0),
        SectionPart(middle, end, 10e3, 20e3, BT, 0.0),
    ]
    ends = sources((0, STIFF), (2, STIFF))
    return assemble(4, parts, [], ends, SYSTEM, room=room)


def solved(network):
    case = place(network, constant_loads([4e3, 15e3], [2e6 + 1e6j, 3e6]))
    status, _ = newton(1.0, FLAT, MOST_PASSES, case.network, case.flow, case.loads)
    assert status == Solution.SOLVED
    return case


def test_a_node_that_follows_has_the_voltage_of_the_other_and_changes_nothing_else():
    pair = following(line(0, 1, 2, room=[(1, 3)]), {3: 1})
    assert pair.source_of_node.tolist() == [0, -1, 1, FOLLOWS - 1]
    found, alone = solved(pair), solved(line(0, 1, 2))
    volts = found.flow.nodes.voltage_v
    assert volts[3] == pytest.approx(volts[1], rel=1e-14)
    assert abs(volts[1]) < 16.4e3
    np.testing.assert_allclose(volts[:3], alone.flow.nodes.voltage_v[:3], rtol=1e-13)
    np.testing.assert_allclose(found.train_voltage, alone.train_voltage, rtol=1e-13)
    np.testing.assert_allclose(found.fed, alone.fed, rtol=1e-11)


def test_it_follows_a_source_as_it_does_another_node():
    pair = following(line(0, 1, 2, room=[(0, 3)]), {3: 0})
    volts = solved(pair).flow.nodes.voltage_v
    assert volts[3] == pytest.approx(volts[0], rel=1e-14)


def test_where_the_other_is_not_fed_neither_is_it():
    """Two nodes that nothing reaches stay at 0."""
    parts = [SectionPart(0, 1, 0.0, 10e3, BT, 0.0)]
    network = assemble(4, parts, [], sources((0, STIFF)), SYSTEM, room=[(2, 3)])
    both = following(network, {3: 2})
    assert both.source_of_node.tolist() == [0, -1, UNFED, UNFED]


def test_networks_of_one_or_two_nodes_at_a_switch_have_the_same_blocks():
    """Closed, both sections meet at node 1; open, one of them ends at node 3."""
    edges = [(0, 1), (1, 2), (0, 3), (3, 2), (1, 3)]
    closed, opened = line(0, 1, 2, room=edges), line(0, 3, 2, room=edges)
    assert closed.admittance_s.shape == opened.admittance_s.shape
    np.testing.assert_array_equal(closed.pattern.places, opened.pattern.places)
