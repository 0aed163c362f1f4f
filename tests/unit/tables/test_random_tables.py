"""Whatever is in a file, it is read right or refused with a remedy: never wrong in silence."""

import contextlib
import io
from pathlib import Path

import openpyxl
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tpss.errors import ScenarioError
from tpss.tables.kinds import GRADIENTS, KINDS
from tpss.tables.read import read_table

PLACE = Path("table.csv")


def read(content, kind=GRADIENTS, name=PLACE):
    return read_table(Path(name), kind, content=content)


@settings(max_examples=300, deadline=None)
@given(
    st.binary(max_size=300),
    st.sampled_from(list(KINDS.values())),
    st.sampled_from(["a.csv", "a.xlsx"]),
)
def test_any_bytes_are_a_table_or_a_fault(content, kind, name):
    with contextlib.suppress(ScenarioError):
        read(content, kind, name)


CELLS = st.text(alphabet="0123456789,.;+-\t\n\"' eEkmKV\u00a0\u2212ö#=", max_size=12)


@settings(max_examples=300, deadline=None)
@given(st.lists(st.lists(CELLS, max_size=4), max_size=6), st.sampled_from(",;\t|"))
def test_any_cells_below_a_header_are_a_table_or_a_fault(rows, separator):
    text = "\n".join(separator.join(row) for row in [["km", "Höhe"], *rows])
    with contextlib.suppress(ScenarioError):
        read(text.encode())


POSITIONS = st.lists(st.integers(0, 99_999), min_size=2, max_size=6, unique=True).map(sorted)
"""In units of the last decimal that is written."""


@st.composite
def dressed(draw):
    """Positions and gradients, and a file with them in random clothes."""
    at = draw(POSITIONS)
    rises = draw(st.lists(st.integers(-9_999, 9_999), min_size=len(at), max_size=len(at)))
    decimals = draw(st.tuples(st.integers(0, 4), st.integers(0, 4)))
    decimal = draw(st.sampled_from(".,"))
    separator = draw(st.sampled_from(",;\t")) if decimal == "." else draw(st.sampled_from(";\t"))
    thousands = draw(st.sampled_from(["", "\u00a0", "'", "."])) if decimal == "," else ""

    def text(value, places):
        shown = f"{value / 10**places:,.{places}f}"
        return shown.replace(",", "\0").replace(".", decimal).replace("\0", thousands)

    rows = [
        [text(km, decimals[0]), text(rise, decimals[1])] for km, rise in zip(at, rises, strict=True)
    ]
    header = [draw(st.sampled_from(["km", "Kilometer", "position_km", "Läge [km]"]))]
    header.append(draw(st.sampled_from(["Neigung [‰]", "gradient_permille", "LUTNING ‰"])))
    table = [header, *rows]
    if draw(st.booleans()):
        table = [[*row, "x"] for row in table]
    if draw(st.booleans()):
        table = [row[::-1] for row in table]
    lines = [separator.join(row) for row in table]
    if draw(st.booleans()):
        lines = ["Strecke 4711", "", *lines]
    end = draw(st.sampled_from(["\n", "\r\n"]))
    encoding = draw(st.sampled_from(["utf-8", "utf-8-sig", "utf-16"]))
    values = [km / 10 ** decimals[0] for km in at], [rise / 10 ** decimals[1] for rise in rises]
    return values, (end.join(lines) + end).encode(encoding)


@settings(max_examples=500, deadline=None)
@given(dressed())
def test_a_table_in_random_clothes_is_read_right_or_asked_about(made):
    """Numbers that may be read in two ways are refused, or read the other way, and a note says so."""
    (positions, gradients), content = made
    problems: list[str] = []
    try:
        table = read(content)
    except ScenarioError as error:
        problems = [finding.problem for finding in error.findings]
    if problems:
        assert all("is it" in problem for problem in problems)
        return
    told = " ".join(table.notes)
    for name, expected in (("position", positions), ("gradient", gradients)):
        heading = table.header.columns[name].heading
        is_right = table.numbers(name) == pytest.approx(expected)
        assert is_right or f"{heading} is read with" in told


NUMBERS = st.floats(-1e4, 1e4).map(lambda value: round(value, 6))


@settings(max_examples=30, deadline=None)
@given(st.lists(st.tuples(NUMBERS, NUMBERS), min_size=1, max_size=5))
def test_numbers_of_a_workbook_are_read_as_they_are(rows):
    book = openpyxl.Workbook()
    for row in [("km", "Neigung"), *rows]:
        book.active.append(row)
    file = io.BytesIO()
    book.save(file)
    table = read(file.getvalue(), name="a.xlsx")
    assert table.numbers("position") == [km for km, _ in rows]
    assert table.numbers("gradient") == [rise for _, rise in rows]
