"""Read the files of a scenario that are TOML."""

import re
import tomllib
from pathlib import Path
from typing import Any

from tpss.errors import Finding, ScenarioError, shortened
from tpss.files.content import MOST_TEXT, content_of
from tpss.files.json_text import demand_depth
from tpss.printable import in_nfc

MOST_PARTS = 32
"""Keys of a key path in TOML: each is a table within the one before, and reading them takes time and
memory by the square of their number."""

_PART = r"""(?:[\w-]+|"[^"\n]*"|'[^'\n]*')"""
_LONG_KEY = re.compile(rf"(?<![\w-]){_PART}(?:[ \t]*\.[ \t]*{_PART}){{{MOST_PARTS}}}")


def read_text(path: Path, named_by: str = "", most_bytes: int = MOST_TEXT) -> str:
    """Text of a file, or a `ScenarioError` that says why it cannot be read."""
    content = content_of(path, named_by, most_bytes)
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        byte = f"byte 0x{error.object[error.start]:02x}"
        problem, remedy = "the file is not text in UTF-8", "save it as UTF-8"
        raise ScenarioError([Finding(str(path), f"line {line}", byte, problem, remedy)]) from error
    return in_nfc(text.replace("\r\n", "\n").replace("\r", "\n"))


def read_toml(path: Path, named_by: str = "") -> dict[str, Any]:
    """Document of a TOML file, perhaps one that is named by a key of another.

    Raises
    ------
    ScenarioError
        The file cannot be read or is not TOML.
    """
    text = read_text(path, named_by)
    if long := _long_key(text):
        problem = f"a key of more than {MOST_PARTS} parts"
        raise ScenarioError([Finding(str(path), *long, problem, "write tables within each other")])
    try:
        document = tomllib.loads(text)
        demand_depth(document)
        return document
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


def _long_key(text: str) -> tuple[str, str] | None:
    """Place and text of a line with a key of too many parts; None if there is none."""
    for number, line in enumerate(text.split("\n"), 1):
        if line.count(".") >= MOST_PARTS and _LONG_KEY.search(line.partition("#")[0]):
            return shown_line(text, number)
    return None
