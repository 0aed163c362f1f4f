"""Encoding of what commands print: whatever they say, it arrives."""

import codecs
import io
import sys


def say_everything() -> None:
    """Let standard output and standard error take every character.

    Redirected into files or pipes, Windows gives them a code page of 256 characters, without Ω or ‰.
    There they are UTF-8, as all that is written. A terminal keeps its encoding, as it would show any
    other as gibberish: what it lacks is told by its code.
    """
    for stream in (sys.stdout, sys.stderr):
        # Of a program without a console they are missing; those of a notebook take text as it is.
        if not isinstance(stream, io.TextIOWrapper) or _is_unicode(stream.encoding):
            continue
        if stream.isatty():
            stream.reconfigure(errors="backslashreplace")
        else:
            stream.reconfigure(encoding="utf-8")


def _is_unicode(encoding: str) -> bool:
    return codecs.lookup(encoding).name.startswith("utf")
