"""Tables of a result as files that other programs read: CSV, Excel, Parquet.

Headings carry the units, as in ``energy [MWh]``.
"""

from collections.abc import Callable, Mapping
from operator import attrgetter
from pathlib import Path

import pandas as pd

from tpss import units
from tpss.errors import ResultError
from tpss.extras import demand
from tpss.files.refusals import refuse_to_replace
from tpss.files.several import check_files, save_files
from tpss.files.single import save_file
from tpss.results.contents import TABLE_PLACES, WORKBOOK
from tpss.results.csv_texts import with_shown_texts, without_formulas
from tpss.results.file_kinds import Kind, Spreadsheet
from tpss.results.overview import overview
from tpss.results.result import Result
from tpss.results.workbook import MOST_ROWS, workbook

TABLES: dict[str, Callable[[Result], pd.DataFrame]] = {
    name: attrgetter(place) for name, place in TABLE_PLACES.items()
}
"""Tables by the names of their files, or of their sheets."""

NEEDS = {Kind.XLSX: "xlsx", Kind.PARQUET: "parquet"}
"""What file types need more than others, as `tpss.extras` calls it."""


def export(
    result: Result,
    kind: Kind,
    folder: Path,
    *,
    force: bool = False,
    spreadsheet: Spreadsheet | None = None,
) -> list[Path]:
    """Write the tables of a result into a folder, all of them or none.

    Parameters
    ----------
    result : Result
    kind : Kind
        Excel gets one file with one sheet per table, behind a summary and the scenario; the others get
        one file per table.
    folder : Path
        Made if it does not exist.
    force : bool
        Whether files of these names may be replaced.
    spreadsheet : Spreadsheet, optional
        CSV for a spreadsheet of such decimals, in which no text is a formula; None: for programs.

    Returns
    -------
    list of Path
        The files.

    Raises
    ------
    ResultError
        A file exists, the folder cannot be written, a package is missing, or a table is too long.
    """
    demand_package(kind)
    names = [WORKBOOK] if kind is Kind.XLSX else [f"{name}.{kind}" for name in TABLES]
    check_files(folder, names, force)
    tables = {name: table(result) for name, table in TABLES.items()}
    if kind is Kind.XLSX:
        tables = {**overview(result), **tables}
    return save_files(folder, contents_of(tables, kind, WORKBOOK, spreadsheet), force)


def export_workbook(result: Result, file: Path, *, force: bool = False) -> Path:
    """Write the tables of a result into a workbook.  See `Result.to_excel`."""
    if file.suffix.lower() != ".xlsx":
        raise ResultError(f"{file} does not end in .xlsx, by which Excel knows a workbook")
    demand_package(Kind.XLSX)
    refuse_to_replace(file, force, "a file", Path.is_file)
    tables = {**overview(result), **{name: table(result) for name, table in TABLES.items()}}
    (content,) = contents_of(tables, Kind.XLSX, WORKBOOK).values()
    return save_file(file, content, force)


def contents_of(
    tables: Mapping[str, pd.DataFrame],
    kind: Kind,
    workbook: str,
    spreadsheet: Spreadsheet | None = None,
) -> dict[str, bytes]:
    """Files of tables by their names: one for each, or the workbook.

    Raises
    ------
    ResultError
        A package is missing, a table is too long, or what is asked for is of CSV only.
    """
    demand_package(kind)
    if spreadsheet is not None and kind is not Kind.CSV:
        raise ResultError(
            f"--spreadsheet is of csv; {kind} keeps texts and numbers apart anyway: leave it out"
        )
    headed = {name: with_units(table) for name, table in tables.items()}
    if kind is Kind.XLSX:
        return {workbook: _workbook(headed)}
    return {f"{name}.{kind}": _bytes(table, kind, spreadsheet) for name, table in headed.items()}


def with_units(table: pd.DataFrame) -> pd.DataFrame:
    """A table with readable headings: words, and the unit in brackets."""
    return table.rename(columns=units.heading)


def demand_package(kind: Kind) -> None:
    """Raise a `ResultError` if the package is missing that files of a kind need."""
    if kind in NEEDS:
        demand(NEEDS[kind])


def _bytes(table: pd.DataFrame, kind: Kind, spreadsheet: Spreadsheet | None) -> bytes:
    if kind is Kind.PARQUET:
        return table.to_parquet(index=False, engine="pyarrow")
    table = with_shown_texts(table)
    if spreadsheet is None:
        return table.to_csv(index=False, float_format="%.10g", lineterminator="\n").encode()
    separator, decimal = (";", ",") if spreadsheet is Spreadsheet.COMMA else (",", ".")
    text = without_formulas(table).to_csv(
        index=False, float_format="%.10g", lineterminator="\r\n", sep=separator, decimal=decimal
    )
    return text.encode("utf-8-sig")  # by the mark, spreadsheets know that it is UTF-8


def _workbook(tables: Mapping[str, pd.DataFrame]) -> bytes:
    """A workbook with one sheet per table.

    Raises
    ------
    ResultError
        A table is too long for a sheet.
    """
    for name, table in tables.items():
        if len(table) >= MOST_ROWS:
            raise ResultError(
                f"the table {name} has {len(table)} rows, a sheet of Excel has at most "
                f"{MOST_ROWS - 1}: choose csv or parquet"
            )
    return workbook(tables)
