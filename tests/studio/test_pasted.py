"""Rows that were copied from a spreadsheet become items of a list."""

import pytest

from tpss.errors import ScenarioError
from tpss.studio.pasted import rows_of

GRADIENTS = "line.gradients", [("from_km", True), ("permille", True)]
STATIONS = "line.stations", [("name", False), ("position_km", True)]


@pytest.mark.parametrize(
    "text",
    [
        "0,0\t1,5\n12,5\t-3,25\n",
        "0.0\t1.5\n12.5\t-3.25",
        "0,0;1,5\n12,5;−3,25",
        "0.0,1.5\n12.5,-3.25",
    ],
    ids=["decimal commas", "decimal points", "semicolons", "commas"],
)
def test_cells_stand_in_the_order_of_the_page(text):
    assert rows_of(text, *GRADIENTS) == [
        {"from_km": 0.0, "permille": 1.5},
        {"from_km": 12.5, "permille": -3.25},
    ]


def test_headings_say_what_columns_are():
    text = "Neigung [‰]\tLage m\n1,5\t0\n-3,25\t12500\n"
    assert rows_of(text, *GRADIENTS) == [
        {"from_km": 0.0, "permille": 1.5},
        {"from_km": 12.5, "permille": -3.25},
    ]


def test_names_are_texts():
    assert rows_of("A\t1,5\nB 2\t3", *STATIONS) == [
        {"name": "A", "position_km": 1.5},
        {"name": "B 2", "position_km": 3.0},
    ]


def test_a_header_of_another_list_is_passed_over():
    rows = rows_of(
        "Stop\tMinutes\nMiddle\t2,5", "traffic.0.stops", [("station", False), ("dwell_min", True)]
    )
    assert rows == [{"station": "Middle", "dwell_min": 2.5}]


def test_empty_cells_are_left_out():
    assert rows_of("0\t1\n5\t\n", *GRADIENTS)[1] == {"from_km": 5.0}


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("0\t1\n5\tsteep", "not a number"),
        ("km\tHöhe\n0\t440\n1\t450", "altitudes"),
        ("0\t1\n" * 10_001, "rows"),
    ],
)
def test_what_cannot_be_read_is_told(text, problem):
    with pytest.raises(ScenarioError, match=problem):
        rows_of(text, *GRADIENTS)
