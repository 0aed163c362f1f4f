"""What the package says of itself, and what comes with it."""

import re
import tomllib
from importlib.metadata import version
from pathlib import Path

import pytest

import tpss

ROOT = Path(__file__).parents[2]
PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
PROJECT = PYPROJECT["project"]
TARGETS = PYPROJECT["tool"]["hatch"]["build"]["targets"]


def test_the_versions_of_the_package_agree():
    citation = (ROOT / "CITATION.cff").read_text("utf-8")
    (cited,) = re.findall(r"^version: (.*)$", citation, re.MULTILINE)
    assert cited == PROJECT["version"] == tpss.__version__ == version("tpss")


def test_the_citation_names_what_a_reader_looks_for():
    citation = (ROOT / "CITATION.cff").read_text("utf-8")
    for key in ("cff-version: 1.2.0", "message: ", "title: ", "authors:", "license: MIT"):
        assert re.search(f"^{key}", citation, re.MULTILINE), key


def test_the_source_distribution_has_what_its_tests_and_readers_need():
    for name in TARGETS["sdist"]["include"]:
        assert (ROOT / name).exists(), name
    assert {"CITATION.cff", "examples", "tests", ".ci"} <= set(TARGETS["sdist"]["include"])


def test_the_examples_are_packed_from_the_folder_that_users_of_the_source_see():
    assert TARGETS["wheel"]["force-include"] == {"examples": "tpss/examples/files"}
    own, packed = ROOT / "examples", tpss.examples.folder()
    files = [path.relative_to(own) for path in own.rglob("*") if path.is_file()]
    assert files == [path.relative_to(packed) for path in packed.rglob("*") if path.is_file()]
    assert all((own / file).read_bytes() == (packed / file).read_bytes() for file in files)


@pytest.mark.parametrize("name", tpss.examples.names())
def test_an_example_begins_with_what_it_is(name):
    sentence = tpss.examples.names()[name]
    assert 20 < len(sentence) < 200
    assert sentence[-1] in ".?"


def test_an_example_brings_the_files_that_its_files_refer_to():
    assert list(tpss.examples.files_of("plan-network")) == [
        "plan_network.toml", "network.toml", "network_timetable.csv", "network_timetable_dense.csv",
    ]  # fmt: skip
    assert "own/freight.toml" in tpss.examples.files_of("own-trains")


def test_an_example_that_there_is_not_is_an_error():
    with pytest.raises(tpss.ResultError, match="did you mean network"):
        tpss.examples.path("networks")


def test_python_versions_are_told_from_the_lowest_on():
    told = [line for line in PROJECT["classifiers"] if re.search(r":: 3\.\d+$", line)]
    assert told[0].endswith(PROJECT["requires-python"].removeprefix(">="))
    assert "Typing :: Typed" in PROJECT["classifiers"]
    assert (Path(tpss.__file__).parent / "py.typed").is_file()
