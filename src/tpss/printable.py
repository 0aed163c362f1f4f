"""Text of others that is printed: what would steer a terminal or turn a line round is shown escaped."""

import re
import unicodedata
from collections.abc import Mapping
from typing import Any

STEERING = ("Cc", "Cf", "Cs", "Zl", "Zp")
"""Categories of Unicode of characters that steer: control, format (which turns text round, or has no
width), halves of characters, and separators of lines and paragraphs."""

_ASCII = re.compile(r"[\x20-\x7e]*")


def steers(character: str) -> bool:
    """Whether a character is no part of a text, but says how it is shown."""
    return unicodedata.category(character) in STEERING


def steering(text: str) -> str:
    """The first character of a text that steers; empty if none does."""
    if _ASCII.fullmatch(text):
        return ""
    return next((each for each in text if steers(each)), "")


def printable(text: str, keep: str = "") -> str:
    r"""A text to be printed: what steers is shown as its code, such as ``\x1b`` and ``\u202e``.

    Parameters
    ----------
    text : str
    keep : str
        Steering characters that stay, such as the end of a line.
    """
    if _ASCII.fullmatch(text):
        return text
    return "".join(
        each if each in keep or not steers(each) else each.encode("unicode_escape").decode()
        for each in text
    )


def document_in_nfc(value: Any) -> Any:
    """A document, all texts of which, keys too, are in the form C of Unicode."""
    if isinstance(value, str):
        return in_nfc(value)
    if isinstance(value, Mapping):
        return {document_in_nfc(key): document_in_nfc(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return type(value)(document_in_nfc(each) for each in value)
    return value


def in_nfc(text: str) -> str:
    """A text in the form C of Unicode, in which an ö is one character however it was typed."""
    return unicodedata.normalize("NFC", text)
