"""What is read ends, is no larger than it should be, and does not grow when it is unpacked."""

import io
import json
import os
import zipfile
from pathlib import Path

import pytest

import tpss
from tpss.errors import Finding, ScenarioError, alike_together, told
from tpss.files.archive import BombError, demand_bounded
from tpss.files.content import content_of
from tpss.files.json_text import DEEPEST, parse_json
from tpss.files.read import demand_readable, read_bytes
from tpss.importers.documents import read_json
from tpss.importers.xml_tree import read_xml
from tpss.scenario.files import read_toml

IS_POSIX = os.name == "posix"
of_posix = pytest.mark.skipif(not IS_POSIX, reason="Windows has other pipes")

MOST = 100


@pytest.fixture
def pipe(tmp_path):
    """A pipe into which nobody writes: to open it would wait for ever."""
    os.mkfifo(tmp_path / "pipe")
    return tmp_path / "pipe"


@of_posix
@pytest.mark.parametrize(
    "read",
    [read_toml, read_json, read_xml, tpss.load_scenario, tpss.load_study, tpss.load_approximator],
    ids=lambda read: read.__name__,
)
def test_a_pipe_is_refused_at_once_whatever_is_asked_of_it(pipe, read):
    with pytest.raises(tpss.TpssError, match="it is a pipe, not a file"):
        read(pipe)


@of_posix
@pytest.mark.parametrize("read", [read_bytes, demand_readable])
def test_what_is_no_file_is_refused(pipe, read, tmp_path):
    for path, words in ((pipe, "pipe"), (Path("/dev/zero"), "device"), (tmp_path, "directory")):
        with pytest.raises(OSError, match=words):
            read(path, MOST)


def test_a_file_is_read_up_to_its_bound(tmp_path):
    file = tmp_path / "a"
    file.write_bytes(b"x" * MOST)
    assert read_bytes(file, MOST) == b"x" * MOST
    file.write_bytes(b"x" * (MOST + 1))
    with pytest.raises(OSError, match=r"it has 0.000101 MB, more than the 0.0001 MB that are read"):
        read_bytes(file, MOST)


def test_a_sparse_file_of_gigabytes_is_refused_by_its_size(tmp_path):
    file = tmp_path / "line.toml"
    with file.open("wb") as opened:
        opened.truncate(3_000_000_000)
    with pytest.raises(ScenarioError, match=r"it has 3e\+03 MB, more than the 100 MB"):
        tpss.load_scenario(file)


@of_posix
def test_a_name_of_a_file_may_be_in_another_form_of_unicode(tmp_path):
    """An ö of two characters, as some systems store it, and one of one, as most people type it."""
    (tmp_path / "Ho\u0308he.csv").write_bytes(b"x")
    assert content_of(tmp_path / "H\u00f6he.csv") == b"x"


@pytest.mark.parametrize("text", ['{"a": 1, "a": 2}', '[{"b": {"c": 1, "c": 1}}]'])
def test_a_key_that_is_twice_in_json_is_refused(text):
    with pytest.raises(ValueError, match="is there twice in one table"):
        parse_json(text)
    assert parse_json('[{"a": 1}, {"a": 2}]') == [{"a": 1}, {"a": 2}]


@pytest.mark.parametrize("depth", [DEEPEST + 1, 100_000])
def test_json_that_is_nested_beyond_use_is_refused(depth):
    with pytest.raises(ValueError, match="within each other"):
        parse_json("[" * depth + "]" * depth)
    assert parse_json("[" * DEEPEST + "]" * DEEPEST)


def test_a_faulty_json_names_its_file(tmp_path):
    file = tmp_path / "train.json"
    file.write_text(json.dumps({"mass": 1.5})[:-1] + ', "mass": 122}')
    with pytest.raises(ScenarioError, match=r"train.json\n.*the key 'mass' is there twice"):
        read_json(file)


@pytest.mark.parametrize(
    "text",
    [f"{'.'.join('a' * 600)} = 1", f"[{'.'.join('a' * 40)}]", ".".join(['"a b"'] * 40) + " = 1"],
    ids=["key", "table", "quoted"],
)  # fmt: skip
def test_a_key_of_hundreds_of_parts_is_refused(tmp_path, text):
    file = tmp_path / "line.toml"
    file.write_text(f"format = 1\n{text}")
    with pytest.raises(ScenarioError) as caught:
        tpss.load_scenario(file)
    (finding,) = caught.value.findings
    assert finding.key == "line 2"
    assert "a key of more than 32 parts" in finding.problem


def test_numbers_and_words_with_many_points_are_no_such_key(tmp_path):
    file = tmp_path / "a.toml"
    numbers = ", ".join(["0.5"] * 100)
    file.write_text(f'a = [{numbers}]\nb = "See ... and so on" # {"a." * 40}\n')
    assert len(read_toml(file)["a"]) == 100


def test_toml_that_is_nested_beyond_use_is_refused(tmp_path):
    file = tmp_path / "a.toml"
    file.write_text("a = " + "[" * 70 + "]" * 70)
    with pytest.raises(ScenarioError, match="within each other"):
        read_toml(file)


def packed(name, content):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(name, content)
    return file.getvalue()


def test_an_archive_that_unpacks_to_too_much_is_refused():
    with pytest.raises(BombError, match="it unpacks to 5 MB, more than the 1 MB"):
        demand_bounded(packed("a", bytes(5_000_000)), 1_000_000)


def test_a_part_that_unpacks_to_hundreds_of_times_its_size_is_refused():
    with pytest.raises(BombError, match="times its size"):
        demand_bounded(packed("a", bytes(20_000_000)), 100_000_000)
    demand_bounded(packed("a", os.urandom(1000)), 1_000_000)


def test_a_part_with_a_doctype_is_refused():
    with pytest.raises(BombError, match="DOCTYPE"):
        demand_bounded(packed("a.xml", '<?xml version="1.0"?><!DOCTYPE a []>'), 1_000_000)


def test_a_workbook_that_is_a_bomb_is_a_finding(tmp_path):
    from tpss.tables.kinds import GRADIENTS
    from tpss.tables.read import read_table

    (tmp_path / "a.xlsx").write_bytes(packed("xl/workbook.xml", bytes(30_000_000)))
    with pytest.raises(ScenarioError, match=r"unpacks to 30 MB, \d+ times its size"):
        read_table(tmp_path / "a.xlsx", GRADIENTS)


def finding(k, key="line {}"):
    return Finding("a.csv", key.format(k), "x", f"not a number: {k}", "write a number")


def test_alike_findings_of_lines_are_told_once():
    (one,) = alike_together(finding(k) for k in range(2, 62))
    assert (one.key, one.problem) == ("line 2", "not a number: 2; and 59 more like it")


def test_findings_of_a_scenario_s_keys_are_all_told():
    assert len(alike_together(finding(k, "traffic.{}.to") for k in range(5))) == 5


def test_of_many_findings_a_hundred_are_printed_and_the_others_counted():
    text = told([finding(k, "traffic.{}.to") for k in range(1200)])
    assert "traffic.99.to" in text
    assert "traffic.100.to" not in text
    assert text.endswith("... and 1,100 more faults, not shown")
    error = ScenarioError([finding(k, "traffic.{}.to") for k in range(1200)])
    assert str(error).startswith("1,200 faults in the input:")
    assert len(error.findings) == 1200
