"""Networks with elements out of service, and what no source reaches then."""

import numpy as np

from tpss.powerflow.assembly import BranchPart, SectionPart, assemble
from tpss.powerflow.completion import unfed_nodes
from tpss.powerflow.in_service import constant_admittance, in_service
from tpss.powerflow.network import UNFED
from tpss.sources.converter import ConverterLaw
from tpss.sources.kinds import Source, SourceKind

from networks import BT, SYSTEM


def sources(*nodes):
    """Converter stations of two units at nodes."""
    law = ConverterLaw.row(no_load_voltage_v=16.5e3, droop_v_per_var=0.0)
    return Source.array(
        Source.row(
            node=node, kind=SourceKind.CONVERTER, installed=2, controlled=False, rating_va=10e6,
            converter=law,
        )
        for node in nodes
    )  # fmt: skip


def ladder():
    """Two contact-line sections 0-1-2, a branch down from each node to 3-4-5, joined by branches."""
    sections = [SectionPart(k, k + 1, 1e4 * k, 1e4 * (k + 1), BT, 0.0) for k in range(2)]
    ends = [(0, 3), (1, 4), (2, 5), (3, 4), (4, 5)]
    branches = [BranchPart(a, b, complex(1.0 + a, 2.0 + b)) for a, b in ends]
    return assemble(6, sections, branches, sources(0, 2), SYSTEM)


def test_with_all_in_service_nothing_changes():
    intact = ladder()
    same = in_service(intact, {}, [])
    np.testing.assert_array_equal(same.admittance_s, intact.admittance_s)
    assert same.source_of_node.tolist() == intact.source_of_node.tolist() == [0, -1, 1, -1, -1, -1]


def test_a_network_without_a_branch_is_one_assembled_without_it_in_the_same_pattern():
    """Of the branch between 1 and 4 nothing is left in their blocks."""
    intact, opened = ladder(), in_service(ladder(), {}, [1])
    others = in_service(intact, {}, [0, 2, 3, 4])
    parts = constant_admittance(opened) + constant_admittance(others)
    np.testing.assert_allclose(parts, constant_admittance(intact))
    assert (np.abs(constant_admittance(opened)) > 0.0).sum() == 5 + 2 * 4  # node 1 has none
    assert opened.branches.admittance_s[1] == 0.0


def test_a_source_that_is_out_leaves_a_node_without_one():
    out = in_service(ladder(), {0: 0, 1: 1}, [])
    assert out.source_of_node.tolist() == [-1, -1, 1, -1, -1, -1]
    assert out.sources.installed.tolist() == [0, 1]


def test_nodes_are_fed_through_branches_in_service_and_sections():
    """Without the branches down, the nodes 3 to 5 are an island of their own."""
    down = in_service(ladder(), {}, [0, 1, 2])
    assert down.source_of_node.tolist() == [0, -1, 1, UNFED, UNFED, UNFED]
    cut = in_service(ladder(), {}, [0, 1, 3])
    assert cut.source_of_node.tolist() == [0, -1, 1, UNFED, -1, -1]
    assert in_service(ladder(), {0: 0, 1: 0}, []).source_of_node.tolist() == [UNFED] * 6


def test_the_intact_network_is_not_changed():
    intact = ladder()
    before = intact.sources.tobytes(), intact.branches.tobytes(), intact.admittance_s.tobytes()
    in_service(intact, {0: 0}, [0])
    after = intact.sources.tobytes(), intact.branches.tobytes(), intact.admittance_s.tobytes()
    assert after == before
    assert not unfed_nodes(intact).any()
