"""Tables of offices, understood without a scenario: what they are, and what is made of them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from tpss.errors import Finding, ScenarioError, suggest
from tpss.files.content import content_of
from tpss.scenario.curve_files import CurveOfFile, braking_from, effort_from
from tpss.scenario.profiles import (
    Profile,
    gradients_from,
    limits_from,
    losses_from,
    stations_from,
)
from tpss.scenario.timetable_rows import text_of_cell
from tpss.tables.aliases import ALIASES
from tpss.tables.header import find_header
from tpss.tables.kinds import (
    BRAKING,
    EFFORT,
    GRADIENTS,
    KINDS,
    LOSSES,
    SPEED_LIMITS,
    STATIONS,
    TIMETABLE,
    Kind,
)
from tpss.tables.read import Table, sheet_of, table_of
from tpss.tables.workbook import of_workbook

SHOWN = 3
"""First values of a column that are shown."""


class Made(NamedTuple):
    """What is made of a table: columns by their headings in files of TPSS, and notes."""

    columns: dict[str, list[Any]]
    notes: list[str]


@dataclass(frozen=True)
class OfficeTable:
    """A table that was understood, and what is made of it."""

    table: Table
    made: Made

    @property
    def kind(self) -> Kind:
        """What kind of table it is."""
        return self.table.kind

    @property
    def file(self) -> str:
        """Name of the file that is written of it."""
        return f"{self.kind.name.replace('-', '_')}.csv"

    @property
    def taken(self) -> list[str]:
        """What was taken."""
        count = len(next(iter(self.made.columns.values())))
        return [f"{count} rows of {', '.join(self.made.columns)}"]

    @property
    def left_out(self) -> list[str]:
        """Columns that mean nothing here."""
        return [f"column {name}" for name in self.table.header.passed_over]

    @property
    def assumed(self) -> list[str]:
        """What was found out or taken for granted while it was read."""
        return [note for note in self.made.notes if "passed over: " not in note]


def read_office_table(
    named: str, decimal: str = "", smoothed_over_km: float | None = None
) -> OfficeTable:
    """A table, its kind by its headings unless that is named.

    Parameters
    ----------
    named : str
        ``FILE`` or ``KIND=FILE``.
    decimal : str
        What begins the decimals, if that is known.
    smoothed_over_km : float, optional
        Length over which altitudes are averaged. [km]

    Raises
    ------
    ScenarioError
        The file cannot be read or has faults, or its kind is not clear; all faults are listed.
    """
    before, equals, behind = named.partition("=")
    is_kind = equals and before in KINDS
    path = Path(behind if is_kind else named)
    content = content_of(of_workbook(path)[0])
    kind = KINDS[before] if is_kind else _kind_of(path, content)
    table = table_of(sheet_of(path, content, kind), kind, decimal)
    if kind is GRADIENTS:
        return OfficeTable(table, _of_rows(gradients_from(table, smoothed_over_km)))
    return OfficeTable(table, _MAKERS[kind.name](table))


def _kind_of(path: Path, content: bytes) -> Kind:
    """The only kind of table whose header a file has.

    Raises
    ------
    ScenarioError
        There is none, or there are several.
    """
    found = [
        kind
        for kind in KINDS.values()
        if find_header(sheet_of(path, content, kind).rows, kind) is not None
    ]
    if len(found) == 1:
        return found[0]
    names = ", ".join(kind.name for kind in found or KINDS.values())
    problem = (
        f"it may be one of several tables: {names}" if found else "no header of a table is found"
    )
    remedy = f"say what it is, as in {(found or [GRADIENTS])[0].name}={path.name}"
    if not found:
        remedy += f", of {names}; tpss import csv --headings lists what they are called"
    raise ScenarioError([Finding(str(path), "", "", problem, remedy)])


def _of_rows(profile: Profile) -> Made:
    """Columns of a profile's rows."""
    keys = list(dict.fromkeys(key for row in profile.rows for key in row))
    columns = {_OWN.get(key, key): [row.get(key) for row in profile.rows] for key in keys}
    return Made(columns, profile.notes)


_OWN = {"from_km": "position_km", "permille": "gradient_permille"}
"""Headings of files by the keys of a scenario, where they differ."""


def _of_curve(curve: CurveOfFile) -> Made:
    """Columns of a curve, with a row for each of its values."""
    lists = dict(curve.lists)
    if "voltage_kv" not in lists:
        return Made(
            {_OF_CURVES.get(key, key): values for key, values in lists.items()}, curve.notes
        )
    rows = [
        (voltage, speed, force)
        for voltage, forces in zip(lists["voltage_kv"], lists["force_kn"], strict=True)
        for speed, force in zip(lists["speed_kmh"], forces, strict=True)
    ]
    voltages, speeds, forces = map(list, zip(*rows, strict=True))
    return Made({"speed_kmh": speeds, "voltage_kv": voltages, "force_kn": forces}, curve.notes)


_OF_CURVES = {"from_speed_kmh": "speed_kmh"}


def _of_timetable(table: Table) -> Made:
    """Columns of a timetable, as texts."""
    columns: dict[str, list[Any]] = {
        ALIASES[name].key: [text_of_cell(table, row, name) for row in range(len(table))]
        for name in table.values
    }
    return Made(columns, table.notes)


_MAKERS: dict[str, Callable[[Table], Made]] = {
    SPEED_LIMITS.name: lambda table: _of_rows(limits_from(table)),
    STATIONS.name: lambda table: _of_rows(stations_from(table)),
    LOSSES.name: lambda table: _of_rows(losses_from(table)),
    EFFORT.name: lambda table: _of_curve(effort_from(table)),
    BRAKING.name: lambda table: _of_curve(braking_from(table)),
    TIMETABLE.name: _of_timetable,
}


def demand_one_of_each(tables: Sequence[OfficeTable]) -> None:
    """Refuse two tables of one kind, which would be written into one file.

    Raises
    ------
    ScenarioError
    """
    seen: dict[str, Path] = {}
    for each in tables:
        if each.kind.name in seen:
            problem = f"{seen[each.kind.name]} has {each.kind.name} too"
            remedy = "import them one by one, with a folder for each"
            raise ScenarioError([Finding(str(each.table.path), "", "", problem, remedy)])
        seen[each.kind.name] = each.table.path


def decimal_named(word: str) -> str:
    """The sign of a word, point or comma.

    Raises
    ------
    ScenarioError
    """
    signs = {"point": ".", "comma": ",", "": ""}
    if word not in signs:
        remedy = suggest(word, ["point", "comma"])
        raise ScenarioError([Finding("--decimal", word, "", "neither point nor comma", remedy)])
    return signs[word]
