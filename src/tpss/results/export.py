"""Tables of a result as files that other programs read: CSV, Excel, Parquet.

Headings carry the units, as in ``energy [MWh]``.
"""

from collections.abc import Callable, Mapping
from importlib.util import find_spec
from operator import attrgetter
from pathlib import Path

import pandas as pd

from tpss import units
from tpss.errors import ResultError
from tpss.files.several import check_files, save_files
from tpss.results.contents import TABLE_PLACES, WORKBOOK
from tpss.results.file_kinds import Kind
from tpss.results.result import Result
from tpss.results.workbook import MOST_ROWS, workbook

TABLES: dict[str, Callable[[Result], pd.DataFrame]] = {
    name: attrgetter(place) for name, place in TABLE_PLACES.items()
}
"""Tables by the names of their files, or of their sheets."""

NEEDS = {Kind.XLSX: ("openpyxl", "openpyxl"), Kind.PARQUET: ("pyarrow", "tpss[parquet]")}
"""Package that a file type needs, and what to install for it."""


def export(result: Result, kind: Kind, folder: Path, *, force: bool = False) -> list[Path]:
    """Write the tables of a result into a folder, all of them or none.

    Parameters
    ----------
    result : Result
    kind : Kind
        Excel gets one file with one sheet per table, the others one file per table.
    folder : Path
        Made if it does not exist.
    force : bool
        Whether files of these names may be replaced.

    Returns
    -------
    list of Path
        The files.

    Raises
    ------
    ResultError
        A file exists, the folder cannot be written, a package is missing, or a table is too long.
    """
    _demand_package(kind)
    names = [WORKBOOK] if kind is Kind.XLSX else [f"{name}.{kind}" for name in TABLES]
    check_files(folder, names, force)
    tables = {name: table(result) for name, table in TABLES.items()}
    return save_files(folder, contents_of(tables, kind, WORKBOOK), force)


def contents_of(tables: Mapping[str, pd.DataFrame], kind: Kind, workbook: str) -> dict[str, bytes]:
    """Files of tables by their names: one for each, or the workbook.

    Raises
    ------
    ResultError
        A package is missing, or a table is too long.
    """
    _demand_package(kind)
    headed = {name: with_units(table) for name, table in tables.items()}
    if kind is Kind.XLSX:
        return {workbook: _workbook(headed)}
    return {f"{name}.{kind}": _bytes(table, kind) for name, table in headed.items()}


def with_units(table: pd.DataFrame) -> pd.DataFrame:
    """A table with readable headings: words, and the unit in brackets."""
    return table.rename(columns=units.heading)


def _demand_package(kind: Kind) -> None:
    package, to_install = NEEDS.get(kind, ("", ""))
    if package and find_spec(package) is None:
        raise ResultError(
            f'{kind} files need {package}, which is not installed: pip install "{to_install}", or '
            "choose another file type"
        )


def _bytes(table: pd.DataFrame, kind: Kind) -> bytes:
    if kind is Kind.PARQUET:
        return table.to_parquet(index=False, engine="pyarrow")
    return table.to_csv(index=False, float_format="%.10g", lineterminator="\n").encode()


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
