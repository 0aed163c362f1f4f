"""What differs between two documents: paths that make one of the other, in a file too."""

import tomllib
from pathlib import Path

import pytest
import tomli_w
from hypothesis import given
from hypothesis import strategies as st

from tpss.scenario.override import override, parse_assignment
from tpss.studio.changed import as_options, as_python, changes_between
from tpss.studio.saved import changed_text

HERE = Path("line.toml")

leaves = st.booleans() | st.integers(0, 9) | st.floats(0.0, 9.0) | st.text("ab.*+", max_size=3)
keys = st.sampled_from(["a", "b", "name", "0", "a.b", "*", "+"])
values = st.recursive(
    leaves,
    lambda inside: st.lists(inside, max_size=4) | st.dictionaries(keys, inside, max_size=3),
    max_leaves=12,
)
documents = st.dictionaries(st.sampled_from(["a", "b", "c"]), values, max_size=3)


def changed(before, changes):
    for path, value in changes:
        before = override(before, {path: value}, HERE)
    return before


@given(documents, documents)
def test_the_changes_make_one_document_of_the_other(before, after):
    assert changed(before, changes_between(before, after)) == after


@given(documents)
def test_nothing_differs_from_itself(document):
    assert changes_between(document, document) == []


@given(documents, documents)
def test_a_file_with_the_changes_says_the_other_document(before, after):
    text = changed_text(tomli_w.dumps(before), after, HERE)
    assert tomllib.loads(text) == after


@pytest.mark.parametrize(
    ("before", "after", "changes"),
    [
        ({"a": 1}, {"a": 2}, [("a", 2)]),
        ({"a": 1}, {}, [("a", None)]),
        ({"a": {"b": [1, 2]}}, {"a": {"b": [1, 3]}}, [("a.b.1", 3)]),
        ({"a": [1, 2]}, {"a": [1, 2, 3]}, [("a.+", 3)]),
        ({"a": [1, 2, 3, 4]}, {"a": [1, 4]}, [("a.2", None), ("a.1", None)]),
        ({"a": [1, 3]}, {"a": [1, 2, 3]}, [("a", [1, 2, 3])]),
        ({"a": [{"k": 1}]}, {"a": [{"k": 2}]}, [("a.0.k", 2)]),
        ({"a": True}, {"a": 1}, [("a", 1)]),
        ({"t": {"x.y": 1}}, {"t": {"x.y": 2}}, [("t", {"x.y": 2})]),
    ],
)
def test_a_change_names_as_little_as_can_be(before, after, changes):
    assert changes_between(before, after) == changes


COMMENTED = """\
# Of this line.
a = 1   # the first

[[stations]]
name = "West"  # in the west
km = [0.0, 1.0]   # from, to

# At last.
[[stations]]
name = "East"
"""


def test_comments_stay_where_they_were():
    after = tomllib.loads(COMMENTED)
    after["stations"][0]["km"][1] = 2.5
    after["a"] = 4
    written = changed_text(COMMENTED, after, HERE)
    assert written == COMMENTED.replace("1.0]", "2.5]").replace("a = 1", "a = 4")


def test_a_table_that_loses_its_only_part_stays():
    text = 'a = 1  # one\n\n[supply.high_voltage_line]\ntype = "132kV"\n'
    changed = changed_text(text, {"a": 1, "supply": {}}, HERE)
    assert tomllib.loads(changed) == {"a": 1, "supply": {}}
    assert changed.startswith("a = 1  # one\n")


def test_an_item_more_is_parted_from_what_follows():
    text = '[[stations]]\nname = "West"\n\n[other]\nb = 1\n'
    after = tomllib.loads(text)
    after["stations"].append({"name": "East"})
    assert changed_text(text, after, HERE) == (
        '[[stations]]\nname = "West"\n\n[[stations]]\nname = "East"\n\n[other]\nb = 1\n'
    )


def test_options_of_the_command_line_say_the_same():
    changes = [("a.0.name", "it's"), ("b.+", {"k": [1.5, True], "t": 'say "no"'}), ("c", None)]
    words = as_options(changes)
    assert words.count("--set") == 3
    import shlex

    texts = [text for text in shlex.split(words) if text != "--set"]
    assert [parse_assignment(text) for text in texts] == changes


def test_the_program_makes_the_same_scenario(tmp_path, file):
    import tpss

    changes = [
        ("supply.converter_stations.0.converters", 3),
        ("supply.high_voltage_line.transformers_km.+", 16.0),
        ("supply.high_voltage_line.transformers_km.+", 18.0),
    ]
    program = as_python(str(file), changes)
    found: dict[str, object] = {}
    exec(program, found)
    expected = changed(tomllib.loads(file.read_text("utf-8")), changes)
    assert found["scenario"] == tpss.Scenario.from_document(expected, file)
