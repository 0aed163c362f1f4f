"""Types of one's own, which stations name: a wrong name is told with all names, a faulty type once."""

import copy
import tomllib
from typing import Any

import pytest

from tpss import Finding, Scenario, ScenarioError, library

from conftest import EXAMPLES
from scenarios import SHORT_LINE

KINDS = {
    "converters": ("converter_stations", "converter_types", "rating_mva"),
    "rectifiers": ("rectifier_stations", "rectifier_types", "no_load_voltage_kv"),
}
"""Kinds of the library: who names them, where own ones stand, and a key that must be positive."""


def document_of(kind: str) -> dict[str, Any]:
    """A document whose stations have the types `mine` and, the last one, `other`."""
    if kind == "converters":
        document = copy.deepcopy(SHORT_LINE)
    else:
        document = tomllib.loads((EXAMPLES / "metro_750v.toml").read_text("utf-8"))
        del document["variants"]
    stations, types, _ = KINDS[kind]
    table = library.values(kind, next(iter(library.entries(kind))))
    supply = document["supply"]
    supply[types] = {"mine": dict(table), "other": dict(table)}
    for station in supply[stations]:
        station["type"] = "mine"
    supply[stations][-1]["type"] = "other"
    return document


def faults_of(document: dict[str, Any]) -> tuple[Finding, ...]:
    with pytest.raises(ScenarioError) as caught:
        Scenario.from_document(document, "line.toml")
    return caught.value.findings


@pytest.mark.parametrize("kind", KINDS)
def test_an_unknown_type_is_told_with_the_names_of_one_s_own(kind: str) -> None:
    document, (stations, types, _) = document_of(kind), KINDS[kind]
    document["supply"][stations][0]["type"] = "mnie"
    (finding,) = faults_of(document)
    assert (finding.key, finding.value) == (f"supply.{stations}.0.type", "'mnie'")
    assert finding.problem == f"the library has no such entry in {kind}, nor has supply.{types}"
    assert finding.remedy.startswith("did you mean mine? choose from ")
    for name in ("mine", "other", *library.entries(kind)):
        assert name in finding.remedy


@pytest.mark.parametrize("kind", KINDS)
def test_a_faulty_type_is_the_only_fault(kind: str) -> None:
    """The stations that name it, and those that name a sound one beside it, have none."""
    document, (_, types, key) = document_of(kind), KINDS[kind]
    document["supply"][types]["mine"][key] = -1.0
    (finding,) = faults_of(document)
    assert finding.key == f"supply.{types}.mine.{key}"


@pytest.mark.parametrize("kind", KINDS)
def test_types_that_are_no_table_are_the_only_fault(kind: str) -> None:
    document, (_, types, _) = document_of(kind), KINDS[kind]
    document["supply"][types] = ["mine", "other"]
    (finding,) = faults_of(document)
    assert (finding.key, finding.problem) == (f"supply.{types}", "not a table")


def test_an_own_type_stands_for_an_entry_of_the_library_but_for_no_other_own_type() -> None:
    document = document_of("converters")
    document["supply"]["converter_types"]["mine"] = "Q48/Q49"
    assert Scenario.from_document(document).supply.converter_stations[0].type.rating_mva == 10.0
    document["supply"]["converter_types"]["mine"] = "other"
    (finding,) = faults_of(document)
    assert (finding.key, finding.value) == ("supply.converter_types.mine", "'other'")
    assert finding.problem == "the library has no such entry in converters"
