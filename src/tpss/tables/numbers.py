"""Numbers as people write them: which of point and comma begins the decimals is found, not guessed.

A column as a whole says it; where it does not, as with nothing but ``1,234``, the other columns of the
file do, or that only one of both readings lies in the range of what the column holds.
"""

import math
import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

POINT, COMMA = ".", ","

IN_WORDS = {POINT: "decimal point", COMMA: "decimal comma"}

_MINUS = dict.fromkeys(map(ord, "\u2010\u2011\u2012\u2013\u2212\ufe63\uff0d"), "-")
"""Hyphens, dashes and minus signs of typography."""

_THOUSANDS = re.compile(r"(?<=\d)[ \u00a0\u2007\u2009\u202f'\u2019](?=\d{3}(?!\d))")
"""Spaces and apostrophes between groups of three digits."""


def _pattern(decimal: str, thousands: str) -> re.Pattern[str]:
    whole = rf"(?:[1-9]\d{{0,2}}(?:{re.escape(thousands)}\d{{3}})+|\d*)"
    return re.compile(
        rf"[+-]?(?=[\d{re.escape(decimal)}]){whole}(?:{re.escape(decimal)}\d*)?(?:[eE][+-]?\d+)?"
    )


_PATTERNS = {POINT: _pattern(POINT, COMMA), COMMA: _pattern(COMMA, POINT)}


def plain(text: str) -> str:
    """A number's text with a plain minus, and without spaces or apostrophes between thousands."""
    if text.isascii() and " " not in text and "'" not in text:
        return text  # most are
    return _THOUSANDS.sub("", text.translate(_MINUS)).strip()


def number(text: str, decimal: str) -> float:
    """Number of a plain text; NaN if it is none."""
    if not _PATTERNS[decimal].fullmatch(text):
        return math.nan
    thousands = COMMA if decimal == POINT else POINT
    try:
        return float(text.replace(thousands, "").replace(decimal, "."))
    except ValueError:  # a sign alone, or a point
        return math.nan


_POST = re.compile(r"(\d+(?:[.,]\d+)?)\s*\+\s*(\d{1,4}(?:[.,]\d+)?)")


def is_post(text: str) -> bool:
    """Whether a text is a post of the line, metres behind a kilometre: 438+500, or 12,4 + 35."""
    return "+" in text and _POST.fullmatch(text) is not None


def post_km(text: str) -> float:
    """Position of a post. [km]"""
    match = _POST.fullmatch(text)
    assert match is not None, "it is one"
    km, metres = (float(part.replace(",", ".")) for part in match.groups())
    return float(f"{km + metres * 1e-3:.13g}")


class Readings(NamedTuple):
    """How the numbers of a column may be read.

    Attributes
    ----------
    possible : tuple of str
        Signs that may begin the decimals of all of its numbers; none where they contradict each other.
    example : str
        A number that the signs read differently, or one that contradicts those before; empty if none.
    """

    possible: tuple[str, ...]
    example: str


def readings_of(texts: Sequence[str]) -> Readings:
    """How the numbers of a column may be read; texts that are none are passed over."""
    possible: tuple[str, ...] = (POINT, COMMA)
    example = ""
    for text in texts:
        if POINT not in text and COMMA not in text:
            continue
        fitting = tuple(sign for sign, each in _PATTERNS.items() if each.fullmatch(text))
        if not fitting:
            continue
        both = tuple(sign for sign in possible if sign in fitting)
        if not both:
            return Readings((), text)
        possible, example = both, example or text
    return Readings(possible, example)


def signs_of(
    columns: Mapping[str, Sequence[str]], separator: str, ranges: Mapping[str, tuple[float, float]]
) -> tuple[dict[str, str], list[str]]:
    """The sign that begins the decimals of each column, and what is told of that.

    Columns whose numbers contradict each other, or can be read in both ways, have none.

    Parameters
    ----------
    columns : mapping of str to sequence of str
        Plain texts of the columns, by their headings.
    separator : str
        Of the columns; a comma leaves points to the decimals.
    ranges : mapping of str to tuple
        Lowest and highest number that a column may hold.
    """
    signs = {
        name: POINT
        for name, texts in columns.items()
        if separator == COMMA and not any(COMMA in text for text in texts)
    }
    readings = {name: readings_of(texts) for name, texts in columns.items() if name not in signs}
    signs |= {name: each.possible[0] for name, each in readings.items() if len(each.possible) == 1}
    common, notes = set(signs.values()), list[str]()
    if len(common) == 2:
        told = " and ".join(f"{IN_WORDS[sign]}s in {name}" for name, sign in signs.items())
        notes.append(f"columns differ in their decimals: {told}")
    for name, each in readings.items():
        if len(each.possible) < 2:
            continue
        if not each.example:  # whole numbers
            signs[name] = POINT
        elif len(common) == 1:
            signs[name] = next(iter(common))
            notes.append(_told(name, each.example, signs[name], "as in the other columns"))
        elif sign := _in_range(columns[name], ranges[name]):
            signs[name] = sign
            notes.append(_told(name, each.example, sign, "as all else is out of range"))
    return signs, notes


def _told(name: str, example: str, sign: str, why: str) -> str:
    value = number(example, sign)
    return f"{name} is read with a {IN_WORDS[sign]}, {why}: {example} is {value:g}"


def _in_range(texts: Sequence[str], ends: tuple[float, float]) -> str:
    """The only sign with which all numbers lie in a range; empty if that is none, or both."""
    low, high = ends
    fitting = []
    for sign in _PATTERNS:
        numbers = [value for text in texts if not math.isnan(value := number(text, sign))]
        if all(low <= value <= high for value in numbers):
            fitting.append(sign)
    return fitting[0] if len(fitting) == 1 else ""
