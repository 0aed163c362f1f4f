"""Read the files of a scenario: TOML, and CSV profiles next to it."""

import re
import tomllib
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

from tpss.errors import Finding, ScenarioError, shortened


class Columns(NamedTuple):
    """Columns of a CSV file of numbers, of which the first increases."""

    names: dict[str, str]
    """Headings by the corresponding keys of a scenario."""
    ascending: str
    """What increases, in words."""
    row: str
    """What a row is, in words."""


GRADIENTS = Columns(
    {"from_km": "position_km", "permille": "gradient_permille"},
    "position",
    "a position and a gradient",
)
LOSSES = Columns(
    {"load_percent": "load_percent", "loss_kw": "loss_kw"}, "load", "a load and the losses at it"
)


class Profile(NamedTuple):
    """Rows of a CSV file, as in a scenario, and where they came from."""

    path: Path
    rows: list[dict[str, float]]
    lines: list[int]
    """Number of each row's line in the file, counted from 1."""
    columns: Columns

    def place(self, row: int, key: str) -> str:
        """Place in the file of a row's value."""
        return f"line {self.lines[row]}, {self.columns.names[key]}"


def read_text(path: Path, named_by: str = "") -> str:
    """Text of a file, or a `ScenarioError` that says why it cannot be read."""
    try:
        return path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        problem, remedy = "there is no such file", _remedy_for_missing(path)
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        byte = f"byte 0x{error.object[error.start]:02x}"
        problem, remedy = "the file is not text in UTF-8", "save it as UTF-8"
        raise ScenarioError([Finding(str(path), f"line {line}", byte, problem, remedy)]) from error
    except ValueError:
        problem, remedy = "not a file name", "name a file"
    except OSError as error:
        problem = f"the file cannot be read: {error.strerror}"
        remedy = "check that it is a file and that you may read it"
    raise ScenarioError([Finding(str(path), named_by, "", problem, remedy)])


def _remedy_for_missing(path: Path) -> str:
    if not path.parent.is_dir():
        return f"there is no folder {path.parent} either; check the path"
    here = sorted(p.name for p in path.parent.glob(f"*{path.suffix}"))
    return f"files of this type there: {', '.join(here[:8])}" if here else "check the path"


def read_toml(path: Path, named_by: str = "") -> dict[str, Any]:
    """Document of a TOML file, perhaps one that is named by a key of another.

    Raises
    ------
    ScenarioError
        The file cannot be read or is not TOML.
    """
    text = read_text(path, named_by)
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        at_line = re.search(r"at line (\d+)", str(error))
        place, value = shown_line(text, int(at_line[1])) if at_line else ("", "")
        remedy = "correct the file at that place; https://toml.io describes the format"
        finding = Finding(str(path), place, value, f"not TOML: {error}", remedy)
        raise ScenarioError([finding]) from error


def shown_line(text: str, number: int) -> tuple[str, str]:
    """Name of a line, counted from 1, and its text, as a finding shows them."""
    lines = text.split("\n")
    line = lines[number - 1].strip() if number <= len(lines) else ""
    return f"line {number}", shortened(line)


def read_profile(path: Path, named_by: str, columns: Columns = GRADIENTS) -> Profile:
    """Rows of numbers: CSV with a header; lines that begin with # are comments.

    Raises
    ------
    ScenarioError
        The file cannot be read, or rows have faults; all are listed.
    """
    lines = [
        (number, text)
        for number, text in enumerate(read_text(path, named_by).splitlines(), 1)
        if text.strip() and not text.lstrip().startswith("#")
    ]
    rows = [(number, [cell.strip() for cell in text.split(",")]) for number, text in lines]
    header = list(columns.names.values())
    if not rows or rows[0][1] != header:
        header_row = ",".join(rows[0][1]) if rows else ""
        remedy = f"begin with the line {','.join(header)}"
        key = f"line {rows[0][0]}" if rows else "line 1"
        raise ScenarioError(
            [Finding(str(path), key, header_row, "not the expected header", remedy)]
        )
    findings: list[Finding] = []
    read = [_read_row(path, number, cells, columns, findings) for number, cells in rows[1:]]
    if not read:
        place, value = f"line {rows[0][0]}", ",".join(header)
        remedy = f"add rows of {columns.row}"
        findings.append(Finding(str(path), place, value, "no rows follow the header", remedy))
    profile = Profile(path, read, [number for number, _ in rows[1:]], columns)
    if not findings:
        findings = _check_order(profile)
    if findings:
        raise ScenarioError(findings)
    return profile


def _check_order(profile: Profile) -> list[Finding]:
    """Faults of rows whose first column does not increase."""
    findings = []
    first, what = next(iter(profile.columns.names)), profile.columns.ascending
    for i, (before, after) in enumerate(pairwise(row[first] for row in profile.rows)):
        if after <= before:
            problem = f"the {what} does not increase: {after:g} follows {before:g}"
            remedy = f"put the rows in ascending order, each {what} once"
            place = profile.place(i + 1, first)
            findings.append(Finding(str(profile.path), place, f"{after:g}", problem, remedy))
    return findings


def _read_row(
    path: Path, number: int, cells: list[str], columns: Columns, findings: list[Finding]
) -> dict[str, float]:
    row, names = ",".join(cells), columns.names
    if len(cells) != len(names):
        problem = f"{len(cells)} values, expected {len(names)}"
        remedy = f"write {columns.row}, separated by a comma, with decimal points"
        findings.append(Finding(str(path), f"line {number}", row, problem, remedy))
        return {}
    values = []
    for column, cell in zip(names.values(), cells, strict=True):
        try:
            values.append(float(cell))
        except ValueError:
            place = f"line {number}, {column}"
            remedy = "write a number with a decimal point and no unit"
            findings.append(Finding(str(path), place, cell, "not a number", remedy))
    return dict(zip(names, values, strict=False))
