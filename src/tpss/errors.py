"""What can go wrong, as types: bad input, a failed audit, a result that cannot be read."""

import difflib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Finding:
    """One fault of an input: where it is, what it is, and how to mend it."""

    file: str
    key: str
    value: str
    problem: str
    remedy: str

    def __str__(self) -> str:
        value = f" = {self.value}" if self.value else ""
        key = f": {self.key}{value}" if self.key else ""
        return f"{self.file}{key}\n    {self.problem}\n    -> {self.remedy}"


def suggest(word: str, known: Iterable[str]) -> str:
    """Remedy for an unknown word: the nearest known one, if any is near, and all there are."""
    names = sorted(known)
    near = difflib.get_close_matches(word, names, n=1, cutoff=0.5)
    listed = f"choose from {', '.join(names)}"
    return f"did you mean {near[0]}? {listed}" if near else listed


class TpssError(Exception):
    """Base of all errors that TPSS raises on purpose."""


class ScenarioError(TpssError):
    """The input has faults; `findings` lists all of them."""

    def __init__(self, findings: Sequence[Finding]) -> None:
        self.findings = tuple(findings)
        count = len(self.findings)
        head = f"{count} fault{'s' if count > 1 else ''} in the input:"
        super().__init__("\n".join([head, *(str(finding) for finding in self.findings)]))


class LibraryError(TpssError):
    """The library has no such kind or entry."""


class TooLargeError(TpssError):
    """A run would not fit into memory."""


class ResultError(TpssError):
    """A result folder cannot be written or read."""


class StudyError(TpssError):
    """A study cannot be run, or its folder cannot be written or read."""


class ApproximatorError(TpssError):
    """An approximator cannot be trained, written or read."""
