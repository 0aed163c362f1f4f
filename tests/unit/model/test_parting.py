"""What is parted, in words and in numbers of nodes."""

from tpss.model.contact_line import OUT
from tpss.model.parting import (
    edges_of_any,
    edges_of_both,
    joined_over,
    parting_of,
    representatives,
    set_apart,
)
from tpss.scenario.outages import Outage

from scenarios import short_line


def test_a_conductor_that_is_out_leaves_a_node_that_it_shares():
    """Tied to another one at a post: it gets a node of its own, on both sides the same."""
    words, pairs = set_apart([["", ""], ["", ""]], [["", OUT], ["", OUT]], anchored=False)
    assert words == [["", ", track 2, out"], ["", ", track 2, out"]]
    assert pairs == [(", track 2, out", "")]


def test_at_its_ends_it_is_parted_from_its_own_other_side():
    words, pairs = set_apart(
        [[", track 1", ", track 2"]] * 2, [["", ""], ["", OUT]], anchored=False
    )
    assert words == [[", track 1", ", track 2"], [", track 1", ", track 2, out"]]
    assert pairs == [(", track 2, out", ", track 2")]


def test_where_all_are_out_they_stay_as_they_are_unless_the_place_is_fed():
    all_out = [[OUT], [OUT]]
    assert set_apart([[""], [""]], all_out, anchored=False) == ([[""], [""]], [])
    words, pairs = set_apart([[""], [""]], all_out, anchored=True)
    assert words == [[", out"], [", out"]]
    assert pairs == [(", out", "")]


def test_a_break_joins_each_track_with_itself_or_all_with_all_where_their_number_changes():
    assert joined_over(["a", "b"], ["c", "d"]) == [("a", "c"), ("b", "d")]
    assert joined_over(["a"], ["c", "d"]) == [("a", "c"), ("a", "d")]


def test_nodes_that_are_joined_are_represented_by_one_that_of_a_source_if_there_is_one():
    """0-1-2 in a chain and 4-5, of which 2 and 5 have sources."""
    assert representatives(6, [(0, 1), (1, 2), (4, 5)], [2, 5]) == [2, 2, 2, 3, 5, 5]
    assert representatives(4, [(1, 3)], []) == [0, 1, 2, 1]


def test_both_states_couple_what_either_couples():
    assert edges_of_both([(0, 1), (2, 3)], [0, 1, 2, 3]) == []
    assert edges_of_both([(0, 1), (2, 3)], [0, 1, 1, 3]) == [
        (0, 1), (2, 3), (0, 1), (1, 3), (2, 1),
    ]  # fmt: skip


def test_sections_that_may_trip_leave_even_each_other():
    """Two of them, one after the other, at a place without a feed: both get nodes of their own."""
    words, pairs = set_apart([[""], [""]], [[", of 0-1 km"], [", of 1-2 km"]], anchored=False)
    assert words == [[", of 0-1 km"], [", of 1-2 km"]]
    assert pairs == [(", of 0-1 km", ""), (", of 1-2 km", "")]


def test_any_mixture_of_states_has_room():
    """Node 2 is one with 1 until a section trips, and 1 with 0 outside of an outage."""
    states = [representatives(4, [(0, 1), (1, 2)], [0]), representatives(4, [(1, 2)], [0])]
    assert states == [[0, 0, 0, 3], [0, 1, 1, 3]]
    assert edges_of_any([(2, 3)], states) == [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]


def test_only_closed_switches_that_close_again_are_joints():
    breaks = [{"name": f"B{k}", "position_km": 5.0 + k, "closed": k != 2} for k in range(3)]
    supply = short_line({"supply.section_breaks": breaks}).supply
    opens = ("B0", "B2", "West>line")
    for_a_time = parting_of(Outage(name="a", opens=opens, to_min=5.0), supply, guarded=False)
    assert for_a_time.switches == {"B0"}
    assert for_a_time.feeds == {"West>line"}
    throughout = parting_of(Outage(name="a", opens=opens), supply, guarded=False)
    assert throughout.switches == frozenset()
