"""Read the files of a scenario: TOML, and CSV profiles beside it."""

import tomllib
from pathlib import Path
from typing import Any

from tpss.errors import Finding, ScenarioError

PROFILE_COLUMNS = ("position_km", "gradient_permille")


def read_text(path: Path, named_by: str = "") -> str:
    """Text of a file, or a `ScenarioError` that says why it cannot be read."""
    try:
        return path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        problem, remedy = "there is no such file", _remedy_for_missing(path)
    except UnicodeDecodeError:
        problem, remedy = "the file is not text in UTF-8", "save it as UTF-8"
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
    return f"files of this kind there: {', '.join(here[:8])}" if here else "check the path"


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
        remedy = "mend the file at that place; https://toml.io describes the format"
        raise ScenarioError([Finding(str(path), "", "", f"not TOML: {error}", remedy)]) from error


def read_gradients(path: Path) -> list[dict[str, float]]:
    """Rows of a gradient profile: CSV with a header; lines that begin with # are comments.

    Raises
    ------
    ScenarioError
        The file cannot be read, or rows have faults; all are listed.
    """
    lines = [
        (number, text)
        for number, text in enumerate(read_text(path, "line.gradients_file").splitlines(), 1)
        if text.strip() and not text.lstrip().startswith("#")
    ]
    rows = [(number, [cell.strip() for cell in text.split(",")]) for number, text in lines]
    if not rows or tuple(rows[0][1]) != PROFILE_COLUMNS:
        found = ",".join(rows[0][1]) if rows else ""
        remedy = f"begin with the line {','.join(PROFILE_COLUMNS)}"
        key = f"line {rows[0][0]}" if rows else ""
        raise ScenarioError([Finding(str(path), key, found, "not the expected header", remedy)])
    findings: list[Finding] = []
    profile = [_read_row(path, number, cells, findings) for number, cells in rows[1:]]
    if not profile and not findings:
        remedy = "add rows of a position and a gradient"
        findings.append(Finding(str(path), "", "", "the profile has no rows", remedy))
    if findings:
        raise ScenarioError(findings)
    return profile


def _read_row(
    path: Path, number: int, cells: list[str], findings: list[Finding]
) -> dict[str, float]:
    row = ",".join(cells)
    if len(cells) != len(PROFILE_COLUMNS):
        problem = f"{len(cells)} values where {len(PROFILE_COLUMNS)} belong"
        remedy = "write a position and a gradient, separated by a comma, with decimal points"
        findings.append(Finding(str(path), f"line {number}", row, problem, remedy))
        return {}
    values = []
    for column, cell in zip(PROFILE_COLUMNS, cells, strict=True):
        try:
            values.append(float(cell))
        except ValueError:
            place = f"line {number}, {column}"
            remedy = "write a number with a decimal point and no unit"
            findings.append(Finding(str(path), place, cell, "not a number", remedy))
    return dict(zip(("from_km", "permille"), values, strict=False))
