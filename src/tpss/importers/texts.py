"""Files that an importer writes, and what it says of them: what was taken, left out and assumed."""

from pathlib import Path
from textwrap import wrap
from typing import Protocol

from tpss.files.several import save_files
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

    Either all of them are written, or none.

    Raises
    ------
    ResultError
        Files exist and may not be replaced, or cannot be written.
    """
    return save_files(folder, {name: text.encode() for name, text in texts.items()}, force)
