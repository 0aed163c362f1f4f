"""The workbook of a plan: the tables of its folder, to be opened as they are."""

import openpyxl
import pandas as pd
import pytest

from tpss.planning import excel
from tpss.planning.excel import HOLDS, WORKBOOK
from tpss.planning.plan import Economics

from solved_plans import solved


@pytest.fixture(scope="module")
def tables(tmp_path_factory):
    return solved(tmp_path_factory.mktemp("plan")) / "tables"


@pytest.fixture(scope="module")
def book(tables):
    return openpyxl.load_workbook(tables / WORKBOOK)


def test_it_has_a_sheet_for_each_table_and_one_that_says_what_they_hold(book):
    assert book.sheetnames == ["contents", *HOLDS]
    first = [[cell.value for cell in row] for row in book["contents"].iter_rows(min_row=2)]
    assert [row[0] for row in first][:-1] == list(HOLDS)
    assert "all money is in MSEK of 2024, real" in first[-1]


@pytest.mark.parametrize("name", [name for name in HOLDS if name != "switching_values"])
def test_its_figures_are_those_of_the_files(name, book, tables):
    file = pd.read_csv(tables / f"{name}.csv")
    sheet = pd.DataFrame(book[name].values)
    assert len(sheet) == len(file) + 1
    for k, column in enumerate(file):
        if pd.api.types.is_float_dtype(file[column]):
            own = sheet[k].iloc[1:].astype(float).to_numpy()
            assert own == pytest.approx(file[column].to_numpy(), nan_ok=True)


def width_of(sheet, column):
    """Width of a column; neighbours of the same looks are described together."""
    dimensions = sheet.column_dimensions.values()
    return next(each.width for each in dimensions if each.min <= column <= each.max)


def test_it_opens_well(book):
    """Headings stay in sight and filter, columns are wide enough, thousands are told apart."""
    sheet = book["decisions"]
    assert sheet.freeze_panes == "A2"
    assert sheet.auto_filter.ref == f"A1:L{sheet.max_row}"
    headings = {cell.value: cell for cell in sheet[1]}
    assert headings["operation per year"].font.bold
    for cell in sheet[1]:
        width = width_of(sheet, cell.column)
        texts = [each.value for each in sheet[cell.column_letter] if isinstance(each.value, str)]
        assert width >= min(40, max(map(len, texts)))
    letter = headings["operation per year"].column_letter
    assert sheet[f"{letter}2"].number_format.startswith("#,##0.0")
    assert sheet["B2"].number_format == "General"  # a year has no comma


def test_a_table_too_long_for_a_sheet_is_named_with_its_file(monkeypatch, tmp_path):
    monkeypatch.setattr(excel, "MOST_ROWS", 2)
    tables = {name: pd.DataFrame({"cost": [1.5, 2.0]}) for name in HOLDS}
    tables["configurations"] = pd.DataFrame({"cost": [1.0, 2.0, 3.0]})
    money = Economics.model_construct(currency="MEUR", price_year=2025)
    (tmp_path / "book.xlsx").write_bytes(excel.excel_of(tables, money))
    book = openpyxl.load_workbook(tmp_path / "book.xlsx")
    assert "configurations" not in book.sheetnames
    rows = {row[0]: row for row in book["contents"].values}
    assert rows["configurations"][2:] == (3, "configurations.csv, for its length")
