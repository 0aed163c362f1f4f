"""Where a page names a file of ``src/tpss``, the name leads to its text.

A page names a file as inline code, ``physics/converter.py``, and may name a function right after it.
On the site both become links, so that every equation is one click from its code.
"""

import posixpath
import re

from markdown import Extension, Markdown
from markdown.postprocessors import Postprocessor
from source_pages import ROOT, SOURCE, page_of
from zensical.extensions.context import ContextPreprocessor

_NAMED = re.compile(r'(?<!">)<code>([a-z_/]+\.py)</code>(?:\s<code>(\w+)</code>)?')


class SourceLinks(Extension):
    """Turns names of source files into links."""

    def extendMarkdown(self, md: Markdown) -> None:  # noqa: N802, its name in Markdown
        """Work on pages that are else done."""
        md.postprocessors.register(_Linked(md), "source_links", -20)


class _Linked(Postprocessor):
    def run(self, text: str) -> str:
        context = ContextPreprocessor.from_markdown(self.md)
        if context is None:
            raise RuntimeError("the page is not known: build the site by python docs/site")
        url = context.page.url
        return _NAMED.sub(lambda match: _link(match, posixpath.dirname(url)), text)


def _link(match: re.Match[str], folder: str) -> str:
    """Link of a name on a page of a folder.

    Raises
    ------
    LookupError
        There is no such file below ``src/tpss``, or no such function in it.
    """
    name, function = match.groups()
    path = SOURCE / name
    if not path.is_file():
        if "/" in name and not (ROOT / name).is_file():
            raise LookupError(f"a page names {name}, which does not exist")
        return match[0]
    url = posixpath.relpath(page_of(name), folder or ".")
    linked = f'<a href="{url}"><code>{name}</code></a>'
    if function is None:
        return linked
    line = _line_of(function, path.read_text("utf-8"))
    if not line:
        raise LookupError(f"a page names {function} of {name}, which is not there")
    return f'{linked} <a href="{url}#line-{line}"><code>{function}</code></a>'


def _line_of(function: str, text: str) -> int:
    """Line of a file on which a function or a method begins, or 0."""
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith(f"def {function}("):
            return number
    return 0
