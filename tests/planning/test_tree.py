"""The tree of scenarios."""

import pytest

from tpss.errors import PlanError
from tpss.planning.tree import make_tree


def demonstration():
    """Headways in minutes of three scenarios, one until 2035."""
    rows = [[60, 60, 48], [60, 48, 30], [60, 40, 20]]
    return make_tree(["low", "base", "high"], [0.35, 0.40, 0.25], rows)


def test_equal_beginnings_are_one_node():
    """One node in the first stage, three in the second, three in the third."""
    tree = demonstration()
    assert tree.node_of.tolist() == [[0, 1, 4], [0, 2, 5], [0, 3, 6]]
    assert tree.parent.tolist() == [-1, 0, 0, 0, 1, 2, 3]
    assert tree.stage.tolist() == [0, 1, 1, 1, 2, 2, 2]
    assert tree.probability == pytest.approx([1.0, 0.35, 0.40, 0.25, 0.35, 0.40, 0.25])


def test_what_parted_stays_apart():
    """Equal values in stage 3 do not make one node of what differed in stage 2."""
    tree = make_tree(["a", "b"], [0.5, 0.5], [[1, 1, 1], [1, 2, 1]])
    assert tree.node_of.tolist() == [[0, 1, 3], [0, 2, 4]]


def test_it_says_when_scenarios_part():
    tree = make_tree(["a", "b", "c"], [0.2, 0.3, 0.5], [[1, 1, 1], [1, 1, 2], [1, 2, 2]])
    assert [(each.stage, each.groups) for each in tree.partings()] == [
        (1, (("a", "b"), ("c",))),
        (2, (("a",), ("b",))),
    ]


def test_a_part_at_the_first_stage_is_legal_and_said():
    tree = make_tree(["a", "b"], [0.2, 0.8], [[1], [2]])
    assert tree.parent.tolist() == [-1, -1]
    assert tree.partings()[0].stage == 0


def test_scenarios_that_never_part_are_one():
    tree = make_tree(["a", "b"], [0.2, 0.8], [[1, 2], [1, 2]])
    assert tree.nodes == 2
    assert tree.probability.tolist() == [1.0, 1.0]
    assert tree.partings() == ()


@pytest.mark.parametrize(
    ("names", "probabilities", "values", "words"),
    [
        (["a", "b"], [0.5, 0.4], [[1], [1]], "add up to 1, not 0.9"),
        (["a", "b"], [1.0, 0.0], [[1], [1]], "scenario b: a probability is positive"),
        (["a", "b"], [0.5, float("nan")], [[1], [1]], "scenario b: a probability is positive"),
        (["a", "b"], [0.5, 0.5], [[1, 2], [1]], "scenario b: a value a stage is needed"),
        (["a", "a"], [0.5, 0.5], [[1], [1]], "different names"),
        ([], [], [], "there is one at least"),
    ],
)
def test_faults_of_scenarios_are_named(names, probabilities, values, words):
    with pytest.raises(PlanError, match=words):
        make_tree(names, probabilities, values)
