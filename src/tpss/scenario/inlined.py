"""A document without the names of files, and where its parts came from."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tpss.errors import Finding
from tpss.scenario.curve_files import CurveOfFile
from tpss.scenario.own_library import Entries
from tpss.scenario.profiles import Profile
from tpss.scenario.timetable import TimetabledTrain

Location = tuple[int | str, ...]


@dataclass
class Inlined:
    """A document without file names, and where its parts came from."""

    document: dict[str, Any]
    source: Path
    entries: Entries = field(default_factory=dict)
    """Entries of a library of one's own."""
    findings: list[Finding] = field(default_factory=list)
    files: dict[Location, Path] = field(default_factory=dict)
    """Files by the tables that they gave."""
    names: dict[Location, str] = field(default_factory=dict)
    """Names, in these files, of the tables that are entries of a library of one's own."""
    own: dict[Location, set[str]] = field(default_factory=dict)
    """Keys of such a table that the scenario itself gives."""
    unread: set[Location] = field(default_factory=set)
    """Tables whose file could not be read."""
    profiles: dict[Location, Profile] = field(default_factory=dict)
    """Lists that came from tables in files, by their places."""
    curves: dict[Location, CurveOfFile] = field(default_factory=dict)
    """Curves that came from tables in files, by their places."""
    notes: list[str] = field(default_factory=list)
    """What is told of how files were read."""

    timetabled: dict[int, TimetabledTrain] = field(default_factory=dict)
    """Trains that came from timetables, by the numbers of their entries of the traffic."""

    def origin(self, location: Location) -> tuple[Path, Location]:
        """File that holds a value, and the value's place in it."""
        for rows, profile in self.profiles.items():
            if location[: len(rows)] == rows and len(location) > len(rows) + 1:
                row, key = location[len(rows) : len(rows) + 2]
                return profile.path, (profile.place(int(row), str(key)),)
        for place, curve in self.curves.items():
            if location[: len(place)] == place and len(location) > len(place):
                key, *indices = location[len(place) :]
                return curve.path, (curve.place(str(key), [int(i) for i in indices]),)
        if location[:1] == ("traffic",) and location[1:]:
            train = self.timetabled.get(int(location[1]))
            if train is not None:
                path, place = train.origin(location[2:])
                return path or self.source, place
        for table, file in self.files.items():
            below = location[len(table) :]
            if below and location[: len(table)] == table and below[0] not in self.own[table]:
                return file, (self.names[table], *below) if table in self.names else below
        return self.source, location

    def is_unread(self, location: Location) -> bool:
        """Whether a location lies in a table whose file could not be read."""
        return any(location[: len(table)] == table for table in self.unread)
