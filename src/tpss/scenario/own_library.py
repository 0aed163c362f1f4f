"""Libraries of one's own: folders with files like those of `tpss.library`, whose entries add to these.

A scenario takes such an entry as it would take a file of its own: its values come in place of its name.
"""

import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

from tpss import library
from tpss.errors import Finding, ScenarioError, shortened, suggest
from tpss.scenario.completed import completed
from tpss.scenario.files import read_toml
from tpss.scenario.given_path import from_here

VARIABLE = "TPSS_LIBRARY"
"""Variable of the environment that names a folder; empty: none, not even that of the user."""

BASED_ON = "based_on"
"""Key of an entry that names the one whose values it starts from."""

SUFFIX = ".toml"

NOT_OWN = {
    "systems": "choose a shipped system, with frequency_hz next to it for another frequency",
    "voltage_limits": "write what differs into [standards.voltage_limits] of the scenario",
    "rail_limits": "write a table of your own as rails of [standards]",
}
"""Kinds that scenarios refer to where nothing is named too, and what to do instead of adding to them."""

KINDS = tuple(kind for kind in library.KINDS if kind not in NOT_OWN)
"""Kinds to which entries may be added."""

_chosen: ContextVar[Path | None] = ContextVar("library")


@dataclass(frozen=True)
class OwnEntry:
    """An entry of a library of one's own."""

    file: Path
    name: str
    based_on: str
    """Name of the entry that it starts from; empty if it gives all values itself."""
    source: str
    """Where its values come from; empty if it does not say so."""
    values: Mapping[str, Any]
    """All its values, those that it starts from too."""


Entries = Mapping[str, Mapping[str, OwnEntry]]
"""Entries by kind and name."""

NONE: Entries = {kind: {} for kind in KINDS}


@contextmanager
def using(folder: str | Path | None) -> Iterator[None]:
    """Read scenarios with a library of one's own, or with none, whatever the environment says."""
    token = _chosen.set(None if folder is None else Path(folder).absolute())
    try:
        yield
    finally:
        _chosen.reset(token)


def folder_in_use() -> Path | None:
    """Folder whose entries add to the library: as chosen, or of the environment, or of the user."""
    try:
        return _chosen.get()
    except LookupError:
        pass  # nothing was chosen
    named = os.environ.get(VARIABLE)
    if named is not None:
        return Path(named).expanduser().absolute() if named else None
    folder = user_folder()
    return folder if folder.is_dir() else None


def user_folder() -> Path:
    """Folder that is read where no other one is named, if it exists."""
    from platformdirs import user_data_path

    return user_data_path("tpss", appauthor=False) / "library"


def own_entries() -> Entries:
    """All entries of the library of one's own that is in use.

    Raises
    ------
    ScenarioError
        The folder or a file cannot be read, or entries have faults; all are listed.
    """
    folder = folder_in_use()
    if folder is None:
        return NONE
    try:
        stats = [(file.name, file.stat()) for file in folder.iterdir() if file.suffix == SUFFIX]
    except OSError as error:
        remedy = f"name a folder with files such as catenaries.toml, by --library or {VARIABLE}"
        problem = f"no library: {error.strerror or error}"
        raise ScenarioError([Finding(from_here(folder), "", "", problem, remedy)]) from error
    # Files that were changed are read again, others are not.
    return _entries_of(folder, tuple(sorted((n, s.st_mtime_ns, s.st_size) for n, s in stats)))


@lru_cache(maxsize=16)
def _entries_of(folder: Path, files: tuple[tuple[str, int, int], ...]) -> Entries:
    findings: list[Finding] = []
    entries = dict(NONE)
    for name, _, _ in files:
        file, kind = folder / name, name.removesuffix(SUFFIX)
        if kind not in KINDS:
            remedy = NOT_OWN.get(kind) or suggest(kind, KINDS)
            problem = "no kind of the library to which entries can be added"
            findings.append(Finding(from_here(file), "", "", problem, remedy))
            continue
        try:
            entries[kind] = _OfKind(
                kind, file, read_toml(Path(from_here(file))), findings
            ).entries()
        except ScenarioError as error:
            findings += error.findings
    if findings:
        raise ScenarioError(findings)
    return entries


@dataclass
class _OfKind:
    """The file of a kind, on its way to entries."""

    kind: str
    file: Path
    document: Mapping[str, Any]
    findings: list[Finding]
    faulty: set[str] = field(default_factory=set)

    def entries(self) -> dict[str, OwnEntry]:
        """The entries without fault; the faults of the others are added to the findings."""
        for name, table in self.document.items():
            self._check(name, table)
        found = {}
        for name, table in self.document.items():
            values = self._values(name, ())
            if values is not None:
                source, base = str(table.get("source", "")), table.get(BASED_ON, "")
                found[name] = OwnEntry(self.file, name, base, source, values)
        return found

    def _check(self, name: str, table: Any) -> None:
        if name.endswith(SUFFIX):
            problem = f"a name that ends in {SUFFIX}, as those of files do"
            self._fault(name, (name,), "", problem, "give the entry another name")
        if not isinstance(table, dict):
            shown = shortened(repr(table))
            remedy = f"write a table [{name}] with the keys of an entry"
            self._fault(name, (name,), shown, "not a table", remedy)
            return
        if name in self._shipped and table.get(BASED_ON) != name:
            problem = "the library that ships with TPSS has an entry of this name"
            remedy = (
                f'give the entry another name, or write {BASED_ON} = "{name}" to change keys of it'
            )
            self._fault(name, (name,), "", problem, remedy)
            return
        base = table.get(BASED_ON)
        if base is None:
            return
        known = {*self._shipped, *self.document} - ({name} - {*self._shipped})
        if not isinstance(base, str) or base not in known:
            problem = f"neither the library nor this file has such an entry in {self.kind}"
            remedy = suggest(str(base), known)
            self._fault(name, (name, BASED_ON), shortened(repr(base)), problem, remedy)

    def _values(self, name: str, above: Sequence[str]) -> dict[str, Any] | None:
        """All values of an entry; None if it, or one that it starts from, has a fault."""
        if name in self.faulty:
            return None
        table = self.document[name]
        own = {key: value for key, value in table.items() if key not in ("source", BASED_ON)}
        base = table.get(BASED_ON)
        if base is None:
            return own
        if base in above:
            problem = f"a circle: {' -> '.join([*above, name, base])}"
            remedy = "let one of them give all values itself"
            self._fault(name, (name, BASED_ON), repr(base), problem, remedy)
            return None
        shipped = base == name or base not in self.document
        start = library.values(self.kind, base) if shipped else self._values(base, (*above, name))
        return None if start is None else completed(own, start)

    def _fault(
        self, name: str, place: tuple[str, ...], value: str, problem: str, remedy: str
    ) -> None:
        self.faulty.add(name)
        self.findings.append(Finding(from_here(self.file), ".".join(place), value, problem, remedy))

    @property
    def _shipped(self) -> Mapping[str, Any]:
        return library.entries(self.kind)
