"""Formulas as MathML, which browsers draw by themselves: no script, no fonts, no network."""

import html
import re

from markdown import Extension, Markdown
from markdown.postprocessors import Postprocessor

from tpss.studio.formulas import mathml

_FORMULA = re.compile(
    r'<(span|div) class="arithmatex">\\([(\[])(.*?)\\[)\]]</\1>',
    re.DOTALL,
)


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
    return f'<{tag} class="formula">{mathml(html.unescape(tex), kind == "[")}</{tag}>'
