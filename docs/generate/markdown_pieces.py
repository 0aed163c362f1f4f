"""Pieces of Markdown that several pages use."""

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from tpss.units import label


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Table of a head and rows; empty if there are no rows."""
    lines = [f"| {' | '.join(cell or ' ' for cell in row)} |" for row in rows]
    if not lines:
        return ""
    return "\n".join([f"| {' | '.join(head)} |", f"|{'---|' * len(head)}", *lines])


def described(meanings: Mapping[str, str], found: Iterable[str], head: str) -> str:
    """Table of names, units and meanings; what is found and what is described must agree."""
    names = list(found)
    if set(meanings) != set(names):
        raise SystemExit(f"{head}s without meaning or gone: {set(meanings) ^ set(names)}")
    rows = [(f"`{name}`", label(name), meanings[name]) for name in names]
    return table((head, "unit", "meaning"), rows)


def code(value: Any) -> str:
    """A value as it is written in TOML, as inline code."""
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    if isinstance(value, str):
        return f'`"{value}"`'
    return f"`{value}`" if not isinstance(value, tuple) else f"`{list(value)}`"


def prose(text: str) -> str:
    """A docstring's text as Markdown: its double backticks as single ones, its citations as links."""
    text = re.sub(r"``(.*?)``", r"`\1`", text)
    return re.sub(
        r"\[(\w+\d{4})\]_", lambda m: f"[{m[1]}](../bibliography.md#{m[1].lower()})", text
    )


def anchor(heading: str) -> str:
    """Anchor that the site gives a heading."""
    return re.sub(r"[\s]+", "-", re.sub(r"[^\w\s-]", "", heading).strip().lower())
