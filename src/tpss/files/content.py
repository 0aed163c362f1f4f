"""What is in a file that a user has named; what is wrong with it is a finding."""

from pathlib import Path

from tpss.errors import Finding, ScenarioError
from tpss.files.read import MEGABYTE, read_bytes

MOST_TEXT = 100 * MEGABYTE
"""Longest text that is read: tables of a million rows are shorter. [byte]"""


def content_of(path: Path, named_by: str = "", most_bytes: int = MOST_TEXT) -> bytes:
    """What is in a file, perhaps one that is named by a key of another.

    Raises
    ------
    ScenarioError
        It cannot be read, is no file, or too long.
    """
    try:
        return read_bytes(path, most_bytes)
    except FileNotFoundError:
        problem, remedy = "there is no such file", _remedy_for_missing(path)
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
