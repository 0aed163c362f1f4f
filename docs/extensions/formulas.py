"""Formulas as MathML, which browsers draw by themselves: no script, no fonts, no network."""

import html
import re

from latex2mathml.converter import convert
from markdown import Extension, Markdown
from markdown.postprocessors import Postprocessor

_FORMULA = re.compile(
    r'<(span|div) class="arithmatex">\\([(\[])(.*?)\\[)\]]</\1>',
    re.DOTALL,
)
_WORD_BELOW = re.compile(r"_\{([A-Za-z,]*[A-Za-z]{2}[A-Za-z,]*)\}")


class Formulas(Extension):
    """Replaces what `arithmatex` has marked as a formula."""

    def extendMarkdown(self, md: Markdown) -> None:  # noqa: N802, its name in Markdown
        """Work on pages that are else done."""
        md.postprocessors.register(_InMathML(md), "formulas", -10)


class _InMathML(Postprocessor):
    def run(self, text: str) -> str:
        return _FORMULA.sub(_in_mathml, text)


def _in_mathml(match: re.Match[str]) -> str:
    tag, kind, tex = match.groups()
    # A word below a symbol stands upright; letters there would be a product.
    tex = _WORD_BELOW.sub(r"_{\\text{\1}}", html.unescape(tex))
    display = "block" if kind == "[" else "inline"
    return f'<{tag} class="formula">{convert(tex, display=display)}</{tag}>'
