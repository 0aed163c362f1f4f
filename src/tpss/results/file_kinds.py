"""Types of files to which tables are exported, and forms of CSV for spreadsheets."""

from enum import StrEnum


class Kind(StrEnum):
    """A type of file, by its suffix."""

    CSV = "csv"
    XLSX = "xlsx"
    PARQUET = "parquet"


class Spreadsheet(StrEnum):
    """What begins the decimals in the spreadsheet that is to open CSV."""

    POINT = "point"
    COMMA = "comma"
