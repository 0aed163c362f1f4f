"""Kinds of files that tables are exported to."""

from enum import StrEnum


class Kind(StrEnum):
    """A kind of file, by its suffix."""

    CSV = "csv"
    XLSX = "xlsx"
    PARQUET = "parquet"
