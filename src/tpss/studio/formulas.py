"""Formulas of docstrings as MathML, which browsers draw by themselves, without script or network."""

import re
import textwrap
from collections.abc import Iterator

from latex2mathml.converter import convert

_DISPLAYED = re.compile(r"^( *)\.\. math::(.*)\n((?:\1 +.*\n|[ \t]*\n)*)", re.MULTILINE)
"""A directive, what stands beside it, and the lines below it that are further in."""

_INLINE = re.compile(r":math:`([^`]*)`")
_WORD_BELOW = re.compile(r"_\{([A-Za-z,]*[A-Za-z]{2}[A-Za-z,]*)\}")


def mathml(tex: str, displayed: bool) -> str:
    """A formula of LaTeX as MathML, on a line of its own or within one."""
    # A word below a symbol stands upright; letters there would be a product.
    tex = _WORD_BELOW.sub(r"_{\\text{\1}}", tex)
    return convert(tex, display="block" if displayed else "inline")


def in_pieces(docstring: str) -> list[dict[str, str]]:
    """A docstring as words and formulas, in their order.

    Returns
    -------
    list of dict
        Each has ``words``, or a ``formula`` in MathML.
    """
    return [piece for piece in _pieces(docstring + "\n") if any(piece.values())]


def _pieces(text: str) -> Iterator[dict[str, str]]:
    end = 0
    for found in _DISPLAYED.finditer(text):
        yield from _pieces_of_words(text[end : found.start()].rstrip() + "\n")
        tex = textwrap.dedent(f"{found[2].strip()}\n{found[3]}").strip()
        if "&" in tex or r"\\" in tex:  # lines below each other, as the directive has them
            tex = rf"\begin{{split}}{tex}\end{{split}}"
        yield {"formula": mathml(tex, displayed=True)}
        end = found.end()
    yield from _pieces_of_words(text[end:].rstrip())


def _pieces_of_words(text: str) -> Iterator[dict[str, str]]:
    end = 0
    for found in _INLINE.finditer(text):
        yield {"words": text[end : found.start()]}
        yield {"formula": mathml(found[1], displayed=False)}
        end = found.end()
    yield {"words": text[end:]}
