"""Files that an importer writes, and what it says of them: what was taken, left out and assumed."""

from pathlib import Path
from textwrap import wrap
from typing import Protocol

from tpss.errors import Finding, ScenarioError
from tpss.files.refusals import reason
from tpss.printable import printable

WIDTH = 100


class Told(Protocol):
    """How a file that was imported was used."""

    @property
    def taken(self) -> list[str]:
        """What was taken."""

    @property
    def left_out(self) -> list[str]:
        """What was left out, and why."""

    @property
    def assumed(self) -> list[str]:
        """What the file does not say, and was assumed."""


def sections(told: Told) -> list[tuple[str, list[str]]]:
    """Headings and items of the report on a file, empty ones left out."""
    every = [
        ("Taken", told.taken),
        ("Left out", told.left_out),
        ("Assumed, edit it", told.assumed),
    ]
    return [(title, items) for title, items in every if items]


def comments(head: str, told: Told) -> str:
    """What was taken from a file, left out and assumed, as comments of TOML or CSV."""
    lines = wrap(printable(head), WIDTH, initial_indent="# ", subsequent_indent="# ")
    for title, items in sections(told):
        lines.append(f"# {title}:")
        for item in items:
            lines += wrap(
                printable(item), WIDTH, initial_indent="#   - ", subsequent_indent="#     "
            )
    return "\n".join([*lines, "", ""])


def write(texts: dict[str, str], folder: Path, force: bool) -> list[Path]:
    """Write files into a folder, which is made if need be; return their paths.

    Raises
    ------
    ScenarioError
        Files exist and may not be replaced, or cannot be written.
    """
    targets = [folder / name for name in texts]
    existing = [target for target in targets if target.exists() and not force]
    if existing:
        remedy = "give another --out, or --force to replace it"
        raise ScenarioError(
            [Finding(str(target), "", "", "it exists already", remedy) for target in existing]
        )
    try:
        for target, text in zip(targets, texts.values(), strict=True):
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text, encoding="utf-8")
    except OSError as error:
        problem = f"it cannot be written: {reason(error)}"
        raise ScenarioError(
            [Finding(str(folder), "", "", problem, "give another --out")]
        ) from error
    return targets
