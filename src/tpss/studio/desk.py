"""The file that is open: what it says, with the edits of a page, and how it is saved."""

import hashlib
from dataclasses import dataclass, replace
from pathlib import Path
from threading import Lock
from typing import Any

from tpss.errors import Finding, ScenarioError
from tpss.files.whole import write_file
from tpss.scenario.files import read_text, read_toml
from tpss.scenario.given_path import named_as_given
from tpss.scenario.override import copy_of, put_in
from tpss.scenario.paths import NoSuchPlaceError, places_of
from tpss.scenario.scenario import Scenario
from tpss.studio.drafts import Drafts, OvertakenError
from tpss.studio.saved import changed_text
from tpss.studio.within import files_outside

Document = dict[str, Any]

Edits = list[list[Any]]
"""Key paths and new values, one after another; None takes out what is there."""

MOST_EDITS = 5_000
"""Edits that a page may send at once."""


@dataclass(frozen=True)
class Content:
    """What a file says, and a digest of how it says so."""

    text: str
    document: Document
    digest: str


class Desk:
    """A scenario's file in its folder.

    Parameters
    ----------
    file : Path
    folder : Path, optional
        Below which all files lie that it may name; by default that of the file.

    Raises
    ------
    ScenarioError
        The file cannot be read, is no TOML, or lies elsewhere.
    """

    def __init__(self, file: Path, folder: Path | None = None) -> None:
        self.file = file.resolve()
        self.folder = (folder or self.file.parent).resolve()
        self.given = str(file)
        if not self.file.is_relative_to(self.folder):
            problem, remedy = "not in the opened folder", "name a folder that holds it"
            raise ScenarioError([Finding(self.given, "--folder", str(folder), problem, remedy)])
        self.drafts = Drafts(self.file)
        self._saving = Lock()
        self.content = self.read()

    @property
    def name(self) -> str:
        """The file as it is called within the folder."""
        return self.file.relative_to(self.folder).as_posix()

    def read(self) -> Content:
        """What stands on the disk now."""
        with named_as_given(self.file, self.given):
            text, document = read_text(self.file), read_toml(self.file)
        return Content(text, document, hashlib.sha256(self.file.read_bytes()).hexdigest())

    def document(self, edits: Edits) -> Document:
        """The document with edits, made one after another.

        Raises
        ------
        ScenarioError
            There are too many, or one has no place.
        """
        if len(edits) > MOST_EDITS:
            problem, remedy = "too many edits at once", "save them, and go on"
            value = f"more than {MOST_EDITS:,}"
            raise ScenarioError([Finding(self.given, "", value, problem, remedy)])
        document: Document = copy_of(self.content.document)
        for path, value in edits:
            put_in(document, {str(path): _like(document, str(path), value)}, Path(self.given))
        return document

    def scenario(self, document: Document) -> Scenario:
        """The scenario of a document.

        Raises
        ------
        ScenarioError
            It has faults, or names a file outside the folder.
        """
        if outside := files_outside(document, self.file, self.folder):
            raise ScenarioError([replace(each, file=self.given) for each in outside])
        return Scenario.from_document(document, self.file)

    def changed_text(self, document: Document) -> str:
        """Text of the file if it said a document, with its comments.

        Raises
        ------
        NotSavedError
            It cannot be written so.
        """
        return changed_text(self.content.text, document, Path(self.given))

    def save(self, edits: Edits, digest: str) -> Content:
        """Write the file with edits, and give what it says then.

        Parameters
        ----------
        edits : list
        digest : str
            Of the file to which the edits were made.

        Raises
        ------
        OvertakenError
            The file on the disk is another one by now.
        ScenarioError, NotSavedError
        """
        with self._saving:
            if self.read().digest != digest or self.content.digest != digest:
                raise OvertakenError(
                    f"{self.name} was changed on the disk meanwhile: it is not overwritten. Open it "
                    "again, or save the edits under another name"
                )
            write_file(self.file, self.changed_text(self.document(edits)).encode())
            self.content = self.read()
            return self.content

    def reread(self) -> Content:
        """Take up what stands on the disk now."""
        with self._saving:
            self.content = self.read()
            return self.content


def _like(document: Document, path: str, value: Any) -> Any:
    """A whole number as the decimal one that it replaces: pages do not tell 10 from 10.0."""
    if not isinstance(value, int) or isinstance(value, bool):
        return value
    try:
        places = places_of(document, path)
    except NoSuchPlaceError:
        return value  # which is told of where it is put in
    decimal = places and all(isinstance(_at(document, place), float) for place in places)
    return float(value) if decimal else value


def _at(document: Any, place: str) -> Any:
    for key in place.split("."):
        if isinstance(document, dict):
            document = document.get(key)
        elif isinstance(document, list) and key.isdecimal() and int(key) < len(document):
            document = document[int(key)]
        else:
            return None
    return document
