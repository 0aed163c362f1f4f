"""Edits that are not saved yet, kept beside the scenario's file so that closing a page loses nothing."""

import json
from dataclasses import dataclass
from pathlib import Path
from threading import Lock
from typing import Any

from tpss.errors import TpssError
from tpss.files.json_text import read_json_file
from tpss.files.whole import write_file

FOLDER = ".tpss-studio"
"""Folder of drafts, beside the file."""


class OvertakenError(TpssError):
    """Another page has changed what this one knows of."""


@dataclass(frozen=True)
class Draft:
    """Edits of a file: those made, and those undone."""

    revision: int = 0
    """How many times a draft was kept; a page that knows of fewer is overtaken by another one."""
    digest: str = ""
    """Of the file that was edited."""
    edits: tuple[Any, ...] = ()
    undone: tuple[Any, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """For a page."""
        return dict(vars(self))


class Drafts:
    """The draft of a file, one for all pages that edit it."""

    def __init__(self, file: Path) -> None:
        self.place = file.parent / FOLDER / f"{file.name}.json"
        self._lock = Lock()

    def read(self) -> Draft:
        """The draft; one without edits if there is none, or if what is there is none."""
        if not self.place.is_file():
            return Draft()
        try:
            told = read_json_file(self.place)
            return Draft(
                int(told["revision"]), str(told["digest"]), tuple(told["edits"]),
                tuple(told["undone"]),
            )  # fmt: skip
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise TpssError(f"{self.place} is no draft: {error}; move it away") from error

    def keep(self, draft: Draft) -> Draft:
        """Write a draft that follows the one of its revision, and give it its own.

        Raises
        ------
        OvertakenError
            Another page has kept one meanwhile.
        """
        with self._lock:
            before = self.read()
            if before.revision != draft.revision:
                raise OvertakenError("another page has edited this file meanwhile")
            kept = Draft(before.revision + 1, draft.digest, draft.edits, draft.undone)
            self.place.parent.mkdir(exist_ok=True)
            write_file(self.place, json.dumps(kept.as_dict()).encode())
            return kept
