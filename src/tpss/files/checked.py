"""Checksums by which damage is told when a file is read: in its name, or of what a document says."""

import hashlib
import json
import re
from pathlib import Path
from typing import Any

from tpss.files.read import MEGABYTE, read_bytes

MOST_BYTES = 2_000 * MEGABYTE
"""Longest file that is read. [byte]"""

CHECKSUM = "sha256"
"""Key of a document's checksum of everything else that it says."""

_DIGITS = 16
_CHECKED = re.compile(rf".*-([0-9a-f]{{{_DIGITS}}})\.\w+")


def checked_name(stem: str, ending: str, content: bytes) -> str:
    """Name of a file with some content, such as ``cases-7-8-0123456789abcdef.parquet``."""
    return f"{stem}-{_checksum(content)}{ending}"


def read_checked(file: Path) -> bytes:
    """What is in a file; one whose name has no checksum, as written before, is taken as it is.

    Raises
    ------
    OSError
        It cannot be read.
    ValueError
        It is not as it was written.
    """
    content = read_bytes(file, MOST_BYTES)
    named = _CHECKED.fullmatch(file.name)
    if named and named[1] != _checksum(content):
        raise ValueError("it is not as it was written: its checksum is another")
    return content


def _checksum(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:_DIGITS]


def document_checksum(document: dict[str, Any]) -> str:
    """Checksum of what a document of JSON says, however it is written and in whatever order."""
    as_read = json.loads(json.dumps(document))
    return hashlib.sha256(json.dumps(as_read, sort_keys=True).encode()).hexdigest()


def with_checksum(document: dict[str, Any]) -> dict[str, Any]:
    """A document of JSON with a checksum of what it says."""
    return {**document, CHECKSUM: document_checksum(document)}


def takes_checksum(document: dict[str, Any]) -> bool:
    """Take the checksum out of a document as it was read; whether it is right, or there is none."""
    written = document.pop(CHECKSUM, None)
    return written in (None, document_checksum(document))
