"""What can go wrong, as types: bad input, a failed audit, a result that cannot be read."""

import difflib
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from tpss.printable import printable


@dataclass(frozen=True)
class Finding:
    """One fault of an input: where it is, what it is, and how to correct it."""

    file: str
    key: str
    value: str
    problem: str
    remedy: str

    def __str__(self) -> str:
        value = f" = {self.value}" if self.value else ""
        key = f": {self.key}{value}" if self.key else ""
        lines = (f"{self.file}{key}", f"    {self.problem}", f"    -> {self.remedy}")
        return "\n".join(map(printable, lines))


MOST_TOLD = 100
"""Findings that are printed; of more their number is told."""


def told(findings: Sequence[Finding]) -> str:
    """Findings as they are printed: the first of them, and how many more there are."""
    texts = [str(finding) for finding in findings[:MOST_TOLD]]
    more = len(findings) - MOST_TOLD
    if more > 0:
        texts.append(f"... and {more:,} more fault{'s' if more > 1 else ''}, not shown")
    return "\n".join(texts)


_IN_A_LINE = re.compile(r"line \d+")


def alike_together(findings: Iterable[Finding]) -> list[Finding]:
    """Findings, those about lines of a file once for each kind: the first, and how many are like it.

    They are alike if they differ in nothing but numbers.
    """
    kinds: dict[tuple[str, ...], list[Finding]] = {}
    for k, each in enumerate(findings):
        of_a_line = _IN_A_LINE.match(each.key)
        texts = (each.file, each.key, each.problem, each.remedy)
        kind = tuple(_NUMBER.sub("#", text) for text in texts) if of_a_line else (str(k),)
        kinds.setdefault(kind, []).append(each)
    return [
        first
        if not more
        else replace(first, problem=f"{first.problem}; and {len(more)} more like it")
        for first, *more in kinds.values()
    ]


_NUMBER = re.compile(r"[-+]?\d+(?:[.,]\d+)*(?:e[-+]?\d+)?")


def suggest(word: str, known: Iterable[str]) -> str:
    """Remedy for an unknown word: the most similar known one, if any, and all of them."""
    names = sorted(known)
    choices = f"choose from {', '.join(names)}"
    return f"did you mean {close}? {choices}" if (close := closest(word, names)) else choices


NEAR = 0.7
"""Least similarity of a word that is proposed, from 0 to 1; of ``to_km`` and ``from_km`` it is 0.67."""

LEAST_BEGINNING = 3
"""Letters by which the beginning of a word stands for the whole."""


def closest(word: str, known: Sequence[str]) -> str:
    """The known word that is most similar to another, or begins with it; empty if none does."""
    near = difflib.get_close_matches(word, known, n=1, cutoff=NEAR)
    longer = [each for each in known if len(word) >= LEAST_BEGINNING and each.startswith(word)]
    return next(iter([*near, *sorted(longer, key=len)]), "")


def no_such(kind: str, name: str, known: Sequence[str]) -> tuple[str, str]:
    """Problem and remedy of a name that there is not: the most similar known one, if any, and all."""
    hint = f"did you mean {close}? " if (close := closest(name, known)) else ""
    several = f"{kind}es" if kind.endswith("ch") else f"{kind}s"
    return f"there is no such {kind}", f"{hint}{several}: {', '.join(known) or 'none'}"


def shortened(text: str) -> str:
    """The first characters of a long text."""
    return text if len(text) <= 60 else f"{text[:57]}..."


class TpssError(Exception):
    """Base of all errors that TPSS raises on purpose."""


class ScenarioError(TpssError):
    """The input has faults; `findings` lists all of them."""

    def __init__(self, findings: Sequence[Finding]) -> None:
        self.findings = tuple(findings)
        count = len(self.findings)
        head = f"{count:,} fault{'s' if count > 1 else ''} in the input:"
        super().__init__(f"{head}\n{told(self.findings)}")


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


class LanesError(TpssError):
    """Cases were to run in lanes, and cannot here."""


class AuditError(TpssError):
    """The audit of a run failed whose figures were to be used."""


class PlanError(TpssError):
    """A plan cannot be made, written or read."""


class NoPlanError(PlanError):
    """No plan meets the requirements, or none the budgets.

    Parameters
    ----------
    limit : str
        What no plan meets: ``requirement`` or ``budget``.
    problem : str
        Where, and by how much.
    nodes : sequence of int
        Nodes of the tree at which it is not met.
    """

    def __init__(self, limit: str, problem: str, nodes: Sequence[int]) -> None:
        self.limit = limit
        self.nodes = tuple(nodes)
        super().__init__(problem)
