"""Formulas as MathML, which browsers draw by themselves: no script, no fonts, no network."""

import html
import re
from typing import Any

from latex2mathml.converter import convert

_FORMULA = re.compile(
    r'<(span|div) class="arithmatex">\\([(\[])(.*?)\\[)\]]</\1>',
    re.DOTALL,
)
_WORD_BELOW = re.compile(r"_\{([A-Za-z,]*[A-Za-z]{2}[A-Za-z,]*)\}")


def on_page_content(content: str, **_: Any) -> str:
    """Replace each TeX formula of a page."""

    def replace(match: re.Match[str]) -> str:
        tag, kind, tex = match.groups()
        # A word below a symbol stands upright; letters there would be a product.
        tex = _WORD_BELOW.sub(r"_{\\text{\1}}", html.unescape(tex))
        display = "block" if kind == "[" else "inline"
        return f'<{tag} class="formula">{convert(tex, display=display)}</{tag}>'

    return _FORMULA.sub(replace, content)
