"""Where tracks of OSRD lie on the lines of a network: the table that an import leaves for exports."""

import csv
import io
from collections.abc import Collection, Iterable
from pathlib import Path
from typing import NamedTuple

from tpss.errors import ResultError
from tpss.files.content import MOST_TEXT
from tpss.files.read import read_bytes


class OsrdTrack(NamedTuple):
    """Where a track lies on a line; positions on it fall where it runs against the kilometres."""

    line: str
    from_km: float
    to_km: float
    track: str
    begin_m: float
    """Position on the track at `from_km`. [m]"""
    end_m: float
    """Position on the track at `to_km`. [m]"""

    def part_m(self, from_km: float, to_km: float) -> tuple[float, float] | None:
        """Positions on the track between which it lies on a stretch, the lower first. [m]"""
        low, high = max(self.from_km, from_km), min(self.to_km, to_km)
        if high <= low:
            return None
        slope = (self.end_m - self.begin_m) / (self.to_km - self.from_km)
        begin, end = (round(self.begin_m + slope * (km - self.from_km), 3) for km in (low, high))
        return min(begin, end), max(begin, end)


def tracks_text(tracks: Iterable[OsrdTrack]) -> str:
    """A table of tracks, as `read_tracks` takes it."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(OsrdTrack._fields)
    writer.writerows([f"{x:.10g}" if isinstance(x, float) else x for x in each] for each in tracks)
    return text.getvalue()


def read_tracks(path: Path, lines: Collection[str]) -> list[OsrdTrack]:
    """Tracks of a table, on the lines of a result.

    Raises
    ------
    ResultError
        It cannot be read, is no such table, or names lines that the result does not have.
    """
    try:
        rows = list(csv.reader(io.StringIO(read_bytes(path, MOST_TEXT).decode("utf-8-sig"))))
    except (OSError, ValueError, csv.Error) as error:
        raise ResultError(
            f"{path} cannot be read: {error}; name the tracks.csv of an import"
        ) from error
    if not rows or tuple(rows[0]) != OsrdTrack._fields:
        raise ResultError(f"{path} has not the header {','.join(OsrdTrack._fields)}")
    tracks = []
    for number, cells in enumerate(rows[1:], 2):
        try:
            line, from_km, to_km, track, begin_m, end_m = cells
            found = OsrdTrack(
                line, float(from_km), float(to_km), track, float(begin_m), float(end_m)
            )
            if not found.to_km > found.from_km:
                raise ValueError("no length")
        except ValueError as error:
            raise ResultError(f"{path}: line {number} is not a track: {','.join(cells)}") from error
        if line not in lines:
            place = f"{path}: line {number}: no line {line} in the result"
            raise ResultError(f"{place}; lines: {', '.join(lines)}")
        tracks.append(found)
    return tracks
