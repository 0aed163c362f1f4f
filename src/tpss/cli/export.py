"""The commands ``tpss export`` and ``tpss export-profiles``."""

import json
from collections.abc import Sequence
from pathlib import Path

from tpss.cli.terminal import tell
from tpss.errors import ResultError
from tpss.files.refusals import explained, refuse_to_replace
from tpss.files.whole import write_file
from tpss.results.contents import TABLES
from tpss.results.electrical_profiles import electrical_profiles
from tpss.results.export import demand_package, export
from tpss.results.file_kinds import Kind, Spreadsheet
from tpss.results.osrd_tracks import read_tracks
from tpss.results.result import load_result
from tpss.units import kilometres


def export_result(
    folder: Path, kind: Kind, out: Path | None, force: bool, spreadsheet: Spreadsheet | None = None
) -> None:
    """Export the tables of a result, and print where they are.

    Raises
    ------
    ResultError
        The folder holds no result, or the files cannot be written.
    """
    demand_package(kind)
    place = folder / TABLES if out is None else out
    files = export(load_result(folder), kind, place, force=force, spreadsheet=spreadsheet)
    tell(f"Wrote into {place}: {', '.join(file.name for file in files)}")


def export_profiles_of(
    folder: Path,
    tracks: Path | None,
    out: Path,
    lowest: bool,
    stretch_km: float,
    band_v: float | None,
    power_classes: Sequence[str],
    force: bool,
) -> None:
    """Write the electrical profiles of a result, and print how much they cover.

    Raises
    ------
    ResultError
        The folder holds no result, its audit failed, or a file cannot be read or written.
    """
    result = load_result(folder)
    if not result.audit["passed"]:
        raise ResultError(f"the audit of {folder} failed: its voltages are not exported")
    refuse_to_replace(out, force, "a file", Path.is_file)
    document = electrical_profiles(
        result,
        read_tracks(tracks, result.scenario.lines_by_name) if tracks else (),
        stretch_km=stretch_km,
        band_v=band_v,
        lowest=lowest,
        power_classes=power_classes,
    )
    with explained(out):
        write_file(out, (json.dumps(document, indent=2, ensure_ascii=False) + "\n").encode())
    covered_km: dict[str, float] = {}
    for level in document["levels"]:
        if level["power_class"] == power_classes[0]:
            length_m = sum(part["end"] - part["begin"] for part in level["track_ranges"])
            covered_km[level["value"]] = length_m / 1e3
    bands = ", ".join(f"{value} on {kilometres(km)} km" for value, km in covered_km.items())
    tell(f"Wrote {out}: {bands or 'no stretch on which trains ran'}")
