"""Rows that were copied from a spreadsheet, as items of a list of the scenario."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from tpss.errors import Finding, ScenarioError, shortened
from tpss.tables.kinds import GRADIENTS, SPEED_LIMITS, STATIONS, Kind
from tpss.tables.numbers import COMMA, POINT, number, plain, signs_of
from tpss.tables.read import sheet_of_text, table_of
from tpss.tables.sheet import SEPARATORS, UTF_8, Row, lines_of, split

PASTED = Path("pasted rows")
"""How findings name the text."""

MOST_ROWS = 10_000


class Headed(NamedTuple):
    """A list whose rows may come with headings: the kind of table, and its keys by quantities."""

    kind: Kind
    keys: Mapping[str, str]


HEADED = {
    "gradients": Headed(GRADIENTS, {"position": "from_km", "gradient": "permille"}),
    "speed_limits": Headed(SPEED_LIMITS, {"position": "from_km", "speed_limit": "speed_kmh"}),
    "stations": Headed(
        STATIONS,
        {"station": "name", "position": "position_km", "tracks": "tracks",
         "track_length": "track_length_m"},
    ),
}  # fmt: skip
"""Lists of a line by their keys; of others the columns stand in the order of those on the page."""

WHOLE = ("tracks",)
"""Keys of whole numbers."""


def rows_of(text: str, path: str, columns: Sequence[tuple[str, bool]]) -> list[dict[str, Any]]:
    """Items of a list, by a text with a row a line.

    Parameters
    ----------
    text : str
        Cells parted by tabs, semicolons or commas; decimals begin with a point or a comma.
    path : str
        Key path of the list.
    columns : sequence of (str, bool)
        Keys of the columns on the page, and whether they hold numbers.

    Raises
    ------
    ScenarioError
        There are too many rows, or cells that are no numbers where they should be.
    """
    headed = HEADED.get(path.rpartition(".")[2])
    lines = lines_of(text)
    if len(lines) > MOST_ROWS:
        problem, remedy = f"more than {MOST_ROWS:,} rows", "name them as a file of the scenario"
        raise ScenarioError([Finding(str(PASTED), "", f"{len(lines):,}", problem, remedy)])
    rows = split(PASTED, lines, _separator(text))
    if headed is not None and rows and not _is_of_values(rows[0], columns):
        return _by_headings(text, headed)
    return _by_their_order(rows if _is_of_values(rows[0], columns) else rows[1:], columns)


def _separator(text: str) -> str:
    """What parts cells: the first of tab, semicolon and comma that there is."""
    return next((each for each in SEPARATORS if each in text), "\t")


def _is_of_values(row: Row, columns: Sequence[tuple[str, bool]]) -> bool:
    """Whether a row holds numbers where numbers are to stand, and so is no header."""
    cells = [
        str(cell) for cell, (_, is_number) in zip(row.cells, columns, strict=False) if is_number
    ]
    return any(
        not math.isnan(number(plain(cell), sign)) for cell in cells for sign in (POINT, COMMA)
    )


def _by_headings(text: str, headed: Headed) -> list[dict[str, Any]]:
    table = table_of(sheet_of_text(PASTED, text, UTF_8, headed.kind), headed.kind)
    if "gradient" in headed.keys and "gradient" not in table.values:
        problem, remedy = "altitudes, which are no gradients", "name them as a file: gradients_file"
        raise ScenarioError([Finding(str(PASTED), "", "", problem, remedy)])
    names = [name for name in headed.keys if name in table.values]
    return [
        {
            headed.keys[name]: _whole(headed.keys[name], value)
            for name in names
            if (value := table.values[name][row]) is not None
        }
        for row in range(len(table))
    ]


def _by_their_order(
    rows: Sequence[Row], columns: Sequence[tuple[str, bool]]
) -> list[dict[str, Any]]:
    texts = {
        key: [plain(str(row.cells[k])) for row in rows if k < len(row.cells) and row.cells[k] != ""]
        for k, (key, is_number) in enumerate(columns)
        if is_number
    }
    signs, _ = signs_of(texts, "\t", dict.fromkeys(texts, (-math.inf, math.inf)))
    return [
        {
            key: _value(row, key, str(cell), is_number, signs)
            for cell, (key, is_number) in zip(row.cells, columns, strict=False)
            if cell != ""
        }
        for row in rows
    ]


def _value(row: Row, key: str, cell: str, is_number: bool, signs: Mapping[str, str]) -> Any:
    if not is_number:
        return cell
    value = number(plain(cell), signs.get(key, COMMA))
    if math.isnan(value):
        remedy = "write numbers with decimal points, or all with decimal commas"
        place = f"line {row.line}, {key}"
        raise ScenarioError([Finding(str(PASTED), place, shortened(cell), "not a number", remedy)])
    return _whole(key, value)


def _whole(key: str, value: Any) -> Any:
    return int(value) if key in WHOLE and isinstance(value, float) and value.is_integer() else value
