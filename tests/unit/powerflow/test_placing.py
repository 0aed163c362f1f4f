"""Which section a train stands under, and in which order.

Sections used below: 0 to 10 km, 10 to 30 km, 30 to 40 km.
"""

import itertools

import numpy as np
import pytest

from tpss.powerflow.network import SHORTEST_PIECE_M, Standing
from tpss.powerflow.placing import section_at, stands_behind
from tpss.track.leg import along_one_line

from networks import BT, STIFF, constant_loads, network_of, place, sources

SECTIONS = [(0, 1, 0.0, 10e3, BT, 0.0), (1, 2, 10e3, 30e3, BT, 0.0), (2, 3, 30e3, 40e3, BT, 0.0)]
NETWORK = network_of(4, SECTIONS, [], sources((0, STIFF)))
(LEG,) = along_one_line(len(SECTIONS))[0]
NEAREST = np.nextafter


@pytest.mark.parametrize("near", [0, 1, 2])
@pytest.mark.parametrize(
    ("position_m", "section"),
    [
        (0.0, 0),
        (NEAREST(10e3, 0.0), 0),
        (10e3, 1),  # at a border: under the section that begins there
        (NEAREST(10e3, 1e9), 1),
        (NEAREST(30e3, 0.0), 1),
        (30e3, 2),
        (40e3, 2),  # at the end of the line there is no other
        (-5.0, 0),  # the outer sections have no end
        (40.1e3, 2),
    ],
)
def test_a_train_at_a_border_stands_under_the_next_section_wherever_one_searches_from(
    as_run, near, position_m, section
):
    assert as_run(section_at)(position_m, near, LEG, NETWORK.sections) == section


def test_a_line_of_one_section_has_no_border(as_run):
    (leg,) = along_one_line(1)[0]
    for position_m in (-1.0, 0.0, 10e3, 99e3):
        assert as_run(section_at)(position_m, 0, leg, NETWORK.sections[:1]) == 0


@pytest.mark.parametrize(
    ("section", "place_m", "train", "behind"),
    [(1, 11e3, 2, False), (2, 5.0, 2, True), (1, 12.1e3, 2, True), (0, 99e3, 9, False),
     (1, 12e3, 2, False), (1, 12e3, 4, True)],
)  # fmt: skip
def test_order_is_by_section_then_place_then_number(as_run, section, place_m, train, behind):
    other = Standing.array([Standing.row(train=3, section=1, place_m=12e3, piece_m=0.0,
                                         voltage_v=0j, good_v=0j, passed_v=0j)])[0]  # fmt: skip
    assert as_run(stands_behind)(section, place_m, train, other) == behind


@pytest.mark.parametrize("order", list(itertools.permutations(range(4))))
def test_trains_are_found_under_their_sections_in_order_however_they_come(order):
    positions = [10e3, 9.9e3, 40e3, 30e3]
    case = place(NETWORK, constant_loads([positions[i] for i in order], [1e6] * 4))
    standing = case.flow.standing
    assert [positions[order[i]] for i in standing.train] == sorted(positions)
    assert standing.section.tolist() == [0, 1, 2, 2]
    assert case.flow.sections.first.tolist() == [0, 1, 2]
    assert case.flow.sections.end.tolist() == [1, 2, 4]
    assert standing.piece_m == pytest.approx([9.9e3, SHORTEST_PIECE_M, SHORTEST_PIECE_M, 10e3])
    assert case.flow.sections.closing_m == pytest.approx([100.0, 20e3, SHORTEST_PIECE_M])
