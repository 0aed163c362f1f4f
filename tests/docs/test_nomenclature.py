"""The nomenclature lists every name, and no name that is gone."""

import re
from pathlib import Path

import numpy as np
import pytest

from tpss.driving.data import Stop
from tpss.powerflow.network import Branch, Section
from tpss.powerflow.system import System
from tpss.sources.kinds import Source
from tpss.vehicle.terms import Demand
from tpss.vehicle.train import Decision, Forces, Motion, Passage, Plan, Timetable
from tpss.vehicle.train_type import TrainType

from scenarios import run

PAGE = (Path(__file__).parents[2] / "docs" / "nomenclature.md").read_text("utf-8")


def table_after(words: str) -> list[dict[str, str]]:
    """Rows of the first table after some words of the page, by the heads of its columns."""
    text = PAGE[PAGE.index(words) :]
    lines = re.search(r"(?:^\|.*\|$\n?)+", text, re.MULTILINE)[0].splitlines()
    head, _, *rows = [[cell.strip(" `") for cell in line.split("|")[1:-1]] for line in lines]
    return [dict(zip(head, row, strict=True)) for row in rows]


PARTS = (Timetable, Motion, Plan, Decision, Forces, Passage)
RECORDS = (TrainType, Demand, *PARTS, Stop, Section, Branch, Source)


def type_of(dtype: np.dtype, name: str) -> np.dtype:
    """Type of a field, by its name or by the names on the way to it, with dots."""
    for part in name.split("."):
        dtype = dtype.fields[part][0]
    return dtype


@pytest.mark.parametrize("record", RECORDS, ids=lambda record: record.__name__)
def test_a_record_s_fields_are_those_of_its_table(record):
    """Those of records in it stand there with a dot; what is a number has a unit, but for counts."""
    rows = table_after(f"\n`{record.__name__}`")
    fields = [row["name"] for row in rows if "." not in row["name"]]
    assert fields == list(record.dtype.names)
    for row in rows:
        kind = type_of(record.dtype, row["name"]).base.kind
        assert row["meaning"]
        assert row["unit"] or kind not in "fc", row


def test_a_system_s_fields_are_those_of_its_table():
    rows = table_after("`System` in")
    assert [row["name"] for row in rows] == list(System._fields)
    assert all(row["meaning"] and row["unit"] for row in rows)


@pytest.fixture(scope="module")
def dataset():
    return run().dataset


def test_variables_of_a_result_stand_there_with_their_dimensions_and_units(dataset):
    """Units are written as people write them: m/s² for m/s2, and a code for a flag's 1."""
    listed = {row["name"]: (row["dimensions"], row["unit"]) for row in table_after("Variables of")}
    found = {
        name: (", ".join(variable.dims), variable.attrs["units"].replace("s2", "s²"))
        for name, variable in dataset.data_vars.items()
    }
    found["train_state"] = (found["train_state"][0], "code")
    assert listed == found


def test_a_state_is_known_at_the_last_instant_and_an_interval_value_is_not(dataset):
    states = {row["name"] for row in table_after("Variables of") if row["kind"] == "state"}
    last = dataset.isel(time=-1).drop_vars(["train_state", "load_flow_passes"])
    known = {name for name, values in last.data_vars.items() if values.notnull().any()}
    assert known == states


def test_coordinates_of_a_result_stand_there_with_their_units(dataset):
    listed = {row["name"]: (row["dimension"], row["unit"]) for row in table_after("Coordinates of")}
    found = {name: (", ".join(c.dims), c.attrs["units"]) for name, c in dataset.coords.items()}
    assert listed == found
