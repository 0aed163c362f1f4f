"""Tables of a result as CSV, Excel and Parquet: whole, with units in their headings, all or none."""

import io

import numpy as np
import openpyxl
import pandas as pd
import pytest

from tpss import ResultError, extras
from tpss.files import several
from tpss.results import export
from tpss.results.export import TABLES, with_units
from tpss.results.file_kinds import Kind, Spreadsheet

from scenarios import run

KINDS = [
    Kind.CSV,
    Kind.XLSX,
    pytest.param(
        Kind.PARQUET,
        marks=pytest.mark.skipif(
            bool(extras.absent("parquet")), reason="pyarrow comes with tpss[parquet]"
        ),
    ),
]


@pytest.fixture(scope="module")
def result():
    """Two trains, one that arrives, and one that is too heavy for its supply."""
    station = [{"name": "West", "position_km": 0.0, "type": "Q48/Q49", "converters": 2}]
    return run(
        {
            "supply.converter_stations": station,
            "traffic.0.headway_min": 15.0,
            "standards.voltage_limits.umin1_kv": 14.9,
            "standards.voltage_limits.umin2_kv": 14.5,
        }
    )


def read(folder, kind, name):
    if kind is Kind.XLSX:
        return pd.read_excel(folder / "result.xlsx", sheet_name=name)
    file = folder / f"{name}.{kind}"
    return pd.read_csv(file) if kind is Kind.CSV else pd.read_parquet(file)


def contents(folder):
    return {file.name: file.read_bytes() for file in folder.iterdir()}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", TABLES)
def test_a_table_comes_back_as_it_was(result, tmp_path, kind, name):
    export.export(result, kind, tmp_path)
    expected, found = with_units(TABLES[name](result)), read(tmp_path, kind, name)
    assert found.columns.tolist() == expected.columns.tolist()
    assert len(found) == len(expected)
    for column in expected:
        if expected[column].dtype == float:
            values = found[column].to_numpy(dtype=float)
            assert values == pytest.approx(expected[column].to_numpy(), rel=1e-9, nan_ok=True)
        else:
            assert found[column].fillna("").tolist() == expected[column].tolist()


def test_headings_carry_units(result):
    assert {"energy [MWh]", "distance [km]", "lowest voltage [kV]"} <= set(with_units(result.trips))
    steps = set(with_units(result.train_steps))
    assert {"time [min]", "speed [km/h]", "acceleration [m/s²]", "active power [MW]"} <= steps


def test_trains_have_a_row_for_each_instant_at_which_they_are_there(result):
    steps, dataset = result.train_steps, result.dataset
    assert len(steps) == int(np.isfinite(dataset.position).sum())
    first = steps[steps.train == "eastbound 1"]
    assert first.time_min.is_monotonic_increasing
    assert first.state.iloc[0] == "motoring"
    assert first.state.iloc[-1] == "arrived"
    speed = dataset.speed.sel(train="eastbound 1").dropna("time").to_numpy()
    assert first.speed_kmh.tolist() == pytest.approx((3.6 * speed).tolist())


def test_existing_files_are_not_overwritten(result, tmp_path):
    (tmp_path / "trips.csv").write_text("mine")
    (tmp_path / "notes.txt").write_text("mine too")
    before = contents(tmp_path)
    with pytest.raises(
        ResultError, match=r"trips.csv exists already; give another --out, or --force"
    ):
        export.export(result, Kind.CSV, tmp_path)
    assert contents(tmp_path) == before
    export.export(result, Kind.CSV, tmp_path, force=True)
    assert (tmp_path / "notes.txt").read_text() == "mine too"
    assert len(read(tmp_path, Kind.CSV, "trips")) == len(result.trips)


def test_several_existing_files_are_counted(result, tmp_path):
    export.export(result, Kind.CSV, tmp_path)
    with pytest.raises(ResultError, match=f"and {len(TABLES) - 1} more"):
        export.export(result, Kind.CSV, tmp_path)


def test_a_folder_of_that_name_is_never_replaced(result, tmp_path):
    (tmp_path / "trips.csv").mkdir()
    with pytest.raises(ResultError, match="is not a file, so it is not replaced"):
        export.export(result, Kind.CSV, tmp_path, force=True)


def test_a_file_is_no_folder(result, tmp_path):
    (tmp_path / "notes.txt").touch()
    with pytest.raises(ResultError, match=r"notes\.txt is not a folder"):
        export.export(result, Kind.CSV, tmp_path / "notes.txt")


@pytest.mark.parametrize("made", [True, False], ids=["old folder", "new folder"])
def test_a_full_disk_leaves_nothing_behind(result, tmp_path, monkeypatch, made):
    write, folder = several.write_new, tmp_path / "tables"
    if made:
        folder.mkdir()

    def until_full(path, content):
        if path.name == "losses.csv":
            raise OSError(28, "No space left on device")
        write(path, content)

    monkeypatch.setattr(several, "write_new", until_full)
    with pytest.raises(ResultError, match=r"tables cannot be written: No space left.*--out"):
        export.export(result, Kind.CSV, folder)
    assert list(tmp_path.rglob("*")) == ([folder] if made else [])


def test_files_that_were_replaced_come_back_if_one_cannot_be(result, tmp_path, monkeypatch):
    (tmp_path / "energy.csv").write_text("old")
    (tmp_path / "trips.csv").write_text("old too")
    before, rename = contents(tmp_path), type(tmp_path).rename

    def failing(path, target):
        if path.name == "trips.csv" and path.parent.name == "new":
            raise OSError(5, "Input/output error")
        return rename(path, target)

    monkeypatch.setattr(type(tmp_path), "rename", failing)
    with pytest.raises(ResultError, match="Input/output error"):
        export.export(result, Kind.CSV, tmp_path, force=True)
    assert contents(tmp_path) == before


@pytest.mark.parametrize(
    ("kind", "package", "remedy"),
    [(Kind.XLSX, "xlsxwriter", r"tpss\[excel\]"), (Kind.PARQUET, "pyarrow", r"tpss\[parquet\]")],
)
def test_a_missing_package_is_named_with_the_remedy(
    result, tmp_path, monkeypatch, kind, package, remedy
):
    monkeypatch.setattr(extras, "find_spec", lambda name: None if name == package else object())
    message = rf'{kind} files need {package}, not installed: pip install "{remedy}"'
    with pytest.raises(ResultError, match=message):
        export.export(result, kind, tmp_path / "tables")
    assert list(tmp_path.iterdir()) == []


def test_a_table_too_long_for_a_sheet_is_refused(result, tmp_path, monkeypatch):
    monkeypatch.setattr(export, "MOST_ROWS", 200)
    with pytest.raises(
        ResultError, match=r"the table \w+ has \d+ rows.*at most 199: choose csv or parquet"
    ):
        export.export(result, Kind.XLSX, tmp_path / "tables")
    assert list(tmp_path.iterdir()) == []


def test_csv_is_plain(result, tmp_path):
    """Decimal points, commas, empty cells for what is not known, ten digits."""
    export.export(result, Kind.CSV, tmp_path)
    text = (tmp_path / "trips.csv").read_text("utf-8")
    assert text.splitlines()[0].startswith("train,service,departure [min],arrival [min]")
    assert "eastbound 2,eastbound,15,,," in text
    assert "nan" not in text.lower()
    assert pd.read_csv(io.StringIO(text)).shape == result.trips.shape


def test_a_name_that_begins_like_a_formula_is_text_in_a_workbook(tmp_path):
    name = "=1+1"
    odd = run({"traffic.0.name": name, "simulation.duration_min": 1.0})
    export.export(odd, Kind.XLSX, tmp_path)
    sheet = openpyxl.load_workbook(tmp_path / "result.xlsx")["trips"]
    cell = next(cell for row in sheet.iter_rows(min_row=2) for cell in row if cell.value == name)
    assert cell.data_type == "s"


@pytest.fixture(scope="module")
def book(result, tmp_path_factory):
    folder = tmp_path_factory.mktemp("book")
    export.export(result, Kind.XLSX, folder)
    return openpyxl.load_workbook(folder / "result.xlsx")


def test_a_workbook_opens_with_its_figures_and_ends_with_the_steps(book):
    assert book.sheetnames[:3] == ["summary", "scenario", "trips"]
    assert book.sheetnames[2:] == [*TABLES]
    assert book.sheetnames[-1] == "steps"


def test_the_summary_tells_what_was_run_and_what_came_out(book, result):
    rows = {row[0]: row[1:] for row in book["summary"].values}
    assert rows["name"] == ("value", "unit")
    assert rows["scenario"][0] == result.scenario.name
    assert rows["status"][0] == result.status
    assert rows["audit"][0] == "passed"
    assert rows["TPSS version"][0] == result.summary["provenance"]["tpss_version"]
    lowest_kv = result.summary["lowest_voltage"]["voltage_kv"]
    assert rows["lowest voltage: voltage"] == (pytest.approx(lowest_kv, rel=1e-14), "kV")
    west_mwh = result.summary["station_energy_mwh"]["West"]
    assert rows["station energy: West"] == (pytest.approx(west_mwh, rel=1e-14), "MWh")


def test_the_scenario_stands_in_it_by_its_key_paths(book, result):
    rows = {row[0]: row[1:] for row in book["scenario"].values}
    document = result.scenario.as_document()
    assert rows["trains.freight.mass_t"] == (document["trains"]["freight"]["mass_t"], "t")
    station = document["supply"]["converter_stations"][0]
    assert rows["supply.converter_stations.0.name"][0] == station["name"]
    assert rows["line.length_km"] == (document["line"]["length_km"], "km")


def cells(values, tmp_path):
    """The cells of a column in a workbook."""
    (content,) = export.contents_of({"a": pd.DataFrame({"a": values})}, Kind.XLSX, "b").values()
    (tmp_path / "b.xlsx").write_bytes(content)
    sheet = openpyxl.load_workbook(tmp_path / "b.xlsx")["a"]
    return [row[0] for row in sheet.iter_rows(min_row=2)]


@pytest.mark.parametrize(
    ("values", "shown"),
    [
        ([1234567.891, 3.0], "#,##0.0"),
        ([15.384123, 3.5e-17], "#,##0.000"),  # the noise shows as 0.000
        ([0.0123456, 0.0], "0.00000"),
        ([1.234e-7, 0.0], "0.00E+00"),
        ([3.5e-17, 0.0], "0.0"),
        ([2025.0, 2030.0], "General"),
        (["a", 15.384123456], "#,##0.000"),
        (["a", 15.38], "General"),
    ],
)
def test_numbers_show_the_digits_that_tell_something_and_keep_the_others(values, shown, tmp_path):
    found = cells(values, tmp_path)
    number = 1 if values[0] == "a" else 0
    assert found[number].number_format == shown
    assert [cell.value for cell in found] == values


def test_long_tables_have_formats_too(tmp_path):
    assert {cell.number_format for cell in cells([15.384123] * 60_000, tmp_path)} == {"#,##0.000"}


def test_what_is_no_number_stays_empty_and_what_is_infinite_is_said(tmp_path):
    found = cells([float("nan"), float("inf"), 1.5, True, None, "=1+1"], tmp_path)
    assert [cell.value for cell in found[1:4]] == ["inf", 1.5, True]
    assert (found[0].value, found[4].value) == (None, None)
    assert (found[5].value, found[5].data_type) == ("=1+1", "s")


def test_a_text_too_long_for_a_cell_ends_in_an_ellipsis(tmp_path):
    whole, cut = cells(["a" * 32_767, "b" * 32_768], tmp_path)
    assert whole.value == "a" * 32_767
    assert cut.value == "b" * 32_766 + "…"


def width_of(sheet, column):
    """Width of a column; neighbours of the same looks are described together."""
    dimensions = sheet.column_dimensions.values()
    return next(each.width for each in dimensions if each.min <= column <= each.max)


def test_columns_are_as_wide_as_what_they_show(book):
    """Also where the longest text comes late, as "eastbound 2" does among the steps of two trains."""
    for sheet in (book["summary"], book["steps"]):
        for column in sheet.iter_cols():
            width = width_of(sheet, column[0].column)
            texts = [cell.value for cell in column if isinstance(cell.value, str)]
            assert width > min(60, max(map(len, texts)))


def as_csv(table, spreadsheet):
    content = export.contents_of({"a": table}, Kind.CSV, "", spreadsheet)["a.csv"]
    return content.decode("utf-8")


FORMULAS = pd.DataFrame(
    {
        "train": ["=1+1", "+a", "-b", "@c", "\td", "plain", None],
        "=heading": [-1.5, 2.0] + 5 * [0.25],
    }
)


def test_csv_for_a_spreadsheet_has_no_formulas_and_its_numbers_are_untouched():
    lines = as_csv(FORMULAS, Spreadsheet.POINT).split("\r\n")
    assert lines[0] == "\ufefftrain,'=heading"
    assert lines[1:8] == [
        "'=1+1,-1.5", "'+a,2", "'-b,0.25", "'@c,0.25", "\\td,0.25", "plain,0.25", ",0.25",
    ]  # fmt: skip


def test_csv_for_a_spreadsheet_with_decimal_commas_is_separated_by_semicolons():
    lines = as_csv(FORMULAS, Spreadsheet.COMMA).split("\r\n")
    assert lines[1:3] == ["'=1+1;-1,5", "'+a;2"]


def test_texts_of_csv_show_what_steers_as_its_code():
    table = pd.DataFrame(
        {"train": ["a\u202eb", "plain", None, "a\u202eb"], "=a": [1.0, 2.0, 3.0, 4.0]}
    )
    assert as_csv(table, None) == "train,=a\na\\u202eb,1\nplain,2\n,3\na\\u202eb,4\n"


def test_csv_for_programs_is_left_as_it_is():
    assert as_csv(FORMULAS, None).split("\n")[:2] == ["train,=heading", "=1+1,-1.5"]


@pytest.mark.parametrize("kind", KINDS[1:])
def test_only_csv_needs_to_know_the_spreadsheet(kind):
    with pytest.raises(ResultError, match="--spreadsheet is of csv"):
        export.contents_of({"a": FORMULAS}, kind, "a.xlsx", Spreadsheet.POINT)
