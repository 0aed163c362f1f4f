"""Files that are missing, of another kind, or spoilt: each fault is reported with its line."""

import math
import shutil
from typing import Any

import pytest

from faults import (
    EAST,
    ENTRY,
    FILE,
    FREIGHT,
    HV,
    INLINE,
    faults_of,
    finding_at,
    stops,
)  # fmt: skip

from conftest import EXAMPLES

HEADER = "position_km,gradient_permille\n"


@pytest.fixture
def copied(tmp_path):
    """The scenario with its profile, to be spoilt."""
    shutil.copy(FILE, tmp_path)
    shutil.copy(EXAMPLES / "gradients_a_160km.csv", tmp_path)
    return tmp_path / FILE.name


def spoilt(remedy: str, profiles: dict[str, tuple[str, str, str]]) -> list[Any]:
    """Text of a profile, place and value of its fault, by name; all with one remedy."""
    return [pytest.param(*profile, remedy, id=name) for name, profile in profiles.items()]


PROFILES = [
    *spoilt("begin with the line position_km,gradient_permille", {
        "header": ("a,b\n0,1\n", "line 1", "a,b"),
        "other-column": ("position_km,radius\n0,1\n", "line 1", "position_km,radius"),
        "empty": ("", "line 1", ""),
        "comments-only": ("# nothing\n", "line 1", ""),
    }),
    *spoilt("add rows", {
        "header-only": ("# a\n" + HEADER, "line 2", HEADER.strip()),
        "semicolons": (
            "# a\n\nposition_km;gradient_permille\n", "line 3", "position_km;gradient_permille"
        ),
    }),
    *spoilt("decimal point and no unit", {
        "cell": (HEADER + "0,1\n5,steep\n", "line 3, gradient_permille", "steep"),
        "unit": (HEADER + "0 km,1\n", "line 2, position_km", "0 km"),
        "comment-behind-a-value": (
            HEADER + "0,1 # steep\n", "line 2, gradient_permille", "1 # steep"
        ),
        "nan": (HEADER + "# a\n0,nan\n", "line 3, gradient_permille", "nan"),
    }),
    *spoilt("leave out the row", {
        "empty-cell": (HEADER + "0,\n", "line 2, gradient_permille", ""),
    }),
    *spoilt("close each quote", {"quotes": (HEADER + '"0,1\n5,2\n', "line 2", '"0,1')}),
    *spoilt("separated by a comma", {
        "one-cell": (HEADER + "0,1\n\n# b\n5\n", "line 5", "5"),
        "three-cells": (HEADER + "0,0,1\n", "line 2", "0,0,1"),
        "semicolon-in-a-row": (HEADER + "0;1\n", "line 2", "0;1"),
    }),
    *spoilt("finite number", {
        "infinite": (HEADER + "0,1\n1e999,2\n", "line 3, position_km", "inf"),
    }),
    *spoilt("less than or equal to 100", {
        "staircase": (HEADER + "0,1\n5,300\n", "line 3, gradient_permille", "300.0"),
        "position-in-millimetres": (HEADER + "0,1\n1e9,2\n", "line 3, position_km", "1000000000.0"),
    }),
    *spoilt("ascending order", {
        "unsorted": (HEADER + "0,1\n\n5,2\n3,1\n7,0\n", "line 5, position_km", "3"),
    }),
    *spoilt("each position once", {"twice": (HEADER + "0,1\n0,2\n", "line 3, position_km", "0")}),
]  # fmt: skip


@pytest.mark.parametrize(("text", "key", "value", "remedy"), PROFILES)
def test_a_fault_of_a_profile_is_reported_with_its_line(copied, text, key, value, remedy):
    profile = copied.with_name("gradients_a_160km.csv")
    profile.write_text(text, encoding="utf-8")
    (finding,) = faults_of({}, copied)
    assert finding.file == str(profile)
    assert (finding.key, finding.value) == (key, value)
    assert remedy in finding.remedy


def test_every_fault_of_a_profile_is_reported(copied):
    profile = copied.with_name("gradients_a_160km.csv")
    profile.write_text(HEADER + "a,b\n1\n2,3,4\n", encoding="utf-8")
    keys = [finding.key for finding in faults_of({}, copied)]
    assert keys == ["line 3", "line 2, position_km", "line 2, gradient_permille"]


def test_a_fault_of_many_rows_is_told_once(copied):
    profile = copied.with_name("gradients_a_160km.csv")
    rows = "".join(f"{k},steep\n" for k in range(60))
    profile.write_text(HEADER + rows, encoding="utf-8")
    (finding,) = faults_of({}, copied)
    assert finding.key == "line 2, gradient_permille"
    assert finding.problem == "not a number; and 59 more like it"


def test_a_value_out_of_range_in_many_rows_is_told_once(copied):
    profile = copied.with_name("gradients_a_160km.csv")
    rows = "".join(f"{k},{300 + k}\n" for k in range(60))
    profile.write_text(HEADER + rows, encoding="utf-8")
    (finding,) = faults_of({}, copied)
    assert finding.key == "line 2, gradient_permille"
    assert finding.problem == "out of range; and 59 more like it"


def test_a_missing_profile_is_reported_with_those_that_are_there(copied):
    finding = finding_at(INLINE, faults_of({INLINE: "gradients_c.csv"}, copied))
    assert finding.file == str(copied.with_name("gradients_c.csv"))
    assert "gradients_a_160km.csv" in finding.remedy


def test_a_folder_in_place_of_a_profile_is_reported(copied):
    finding = finding_at(INLINE, faults_of({INLINE: "."}, copied))
    assert "check that it is a file" in finding.remedy


def test_a_missing_file_is_reported_with_those_that_are_there(copied):
    (finding,) = faults_of({}, copied.with_name("thesis.toml"))
    assert finding.file == str(copied.with_name("thesis.toml"))
    assert finding.problem == "there is no such file"
    assert "thesis_160km.toml" in finding.remedy


def test_a_missing_folder_is_reported(tmp_path):
    (finding,) = faults_of({}, tmp_path / "nowhere" / "thesis.toml")
    assert f"there is no folder {tmp_path / 'nowhere'}" in finding.remedy


def test_a_folder_in_place_of_a_file_is_reported(tmp_path):
    (finding,) = faults_of({}, tmp_path)
    assert finding.file == str(tmp_path)
    assert "check that it is a file" in finding.remedy


@pytest.mark.parametrize(
    ("content", "place", "value", "problem", "remedy"),
    [
        pytest.param(b"format = 1\nname = \n", "line 2", "name =", "Invalid value",
                     "correct the file", id="no-value"),
        pytest.param(b"name = 'a'\nname = 'b'\n", "line 2", "name = 'b'", "not TOML",
                     "correct the file", id="key-twice"),
        pytest.param(b"[line]\r\nlength_km = 160 km\r\n", "line 2", "length_km = 160 km",
                     "not TOML", "correct the file", id="unit-behind-a-number"),
        pytest.param(b"[line\n", "line 1", "[line", "not TOML", "correct the file", id="bracket"),
        pytest.param(b"x = [1,", "", "", "at end of document", "correct the file", id="cut-off"),
        pytest.param(b"position_km,gradient_permille\n", "line 1",
                     "position_km,gradient_permille", "not TOML", "toml.io", id="csv"),
        pytest.param(b"# a\nname = 'Lule\xe5'\n", "line 2", "byte 0xe5", "not text in UTF-8",
                     "UTF-8", id="latin-1"),
    ],
)  # fmt: skip
def test_a_file_that_is_not_toml_is_reported(tmp_path, content, place, value, problem, remedy):
    file = tmp_path / "line.toml"
    file.write_bytes(content)
    (finding,) = faults_of({}, file)
    assert (finding.file, finding.key, finding.value) == (str(file), place, value)
    assert problem in finding.problem
    assert remedy in finding.remedy


def test_an_empty_file_lacks_every_part(tmp_path):
    file = tmp_path / "line.toml"
    file.touch()
    keys = {finding.key for finding in faults_of({}, file)}
    assert keys == {"format", "name", "line", "supply", "trains", "traffic"}


def test_faults_of_all_kinds_are_reported_at_once(copied):
    """A field, a key, a name, an order, a conflict, a reference and a profile, each at fault."""
    copied.with_name("gradients_a_160km.csv").write_text(HEADER + "0,x\n", encoding="utf-8")
    changes = {
        "line.length_km": "160 km",
        "simulation.time_step": 0.5,
        "simulation.duration_min": 90.0,
        "supply.catenary": "BTX",
        "supply.frequency_hz": math.nan,
        f"{HV}.transformers_km": [80.0, 160.0],
        f"{EAST}.name": "West",
        f"{FREIGHT}.efficiency": 1.2,
        f"{ENTRY}.train": "fright",
        f"{ENTRY}.headway_min": 0.0,
        f"{ENTRY}.stops": stops("Midle"),
    }
    keys = {finding.key for finding in faults_of(changes, copied)}
    assert keys >= {
        "line 2, gradient_permille",
        "line.length_km",
        "simulation.time_step",
        "supply.catenary",
        "supply.frequency_hz",
        f"{HV}.transformers_km.1",
        "supply.converter_stations",
        f"{FREIGHT}.efficiency",
        f"{ENTRY}.train",
        f"{ENTRY}.headway_min",
        f"{ENTRY}.stops.0.station",
    }
