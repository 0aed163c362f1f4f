"""Types of files to which tables are exported."""

from enum import StrEnum


class Kind(StrEnum):
    """A type of file, by its suffix."""

    CSV = "csv"
    XLSX = "xlsx"
    PARQUET = "parquet"
