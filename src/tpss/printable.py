"""Text of others that is printed: what would steer a terminal or turn a line round is shown escaped."""

import re
import unicodedata

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


def in_nfc(text: str) -> str:
    """A text in the form C of Unicode, in which an ö is one character however it was typed."""
    return unicodedata.normalize("NFC", text)
