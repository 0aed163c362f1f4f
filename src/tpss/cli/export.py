"""The command ``tpss export``."""

from pathlib import Path

from tpss.results.contents import TABLES
from tpss.results.export import export
from tpss.results.file_kinds import Kind
from tpss.results.result import load_result


def export_result(folder: Path, kind: Kind, out: Path | None, force: bool) -> None:
    """Export the tables of a result, and print where they are.

    Raises
    ------
    ResultError
        The folder holds no result, or the files cannot be written.
    """
    place = folder / TABLES if out is None else out
    files = export(load_result(folder), kind, place, force=force)
    print(f"Wrote into {place}: {', '.join(file.name for file in files)}")
