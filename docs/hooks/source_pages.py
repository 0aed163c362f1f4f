"""Pages of the source: where a page names a file of ``src/tpss``, the name leads to its text.

A page names a file as inline code, ``physics/converter.py``, and may name a function right after it.
On the site both become links, so that every equation is one click from its code.
"""

import logging
import re
from pathlib import Path
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page
from mkdocs.utils import get_relative_url

SOURCE = Path(__file__).parents[2] / "src" / "tpss"
LOG = logging.getLogger("mkdocs.hooks.source_pages")
_NAMED = re.compile(r"<code>([a-z_/]+\.py)</code>(?:\s<code>(\w+)</code>)?")


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add a page for each file of the source."""
    for path in sorted(SOURCE.rglob("*.py")):
        name = path.relative_to(SOURCE)
        text = path.read_text("utf-8")
        page = f"---\nsearch:\n  exclude: true\n---\n# {name}\n\n"
        page += f"``````python\n{text}``````\n"
        files.append(File.generated(config, f"source/{name.with_suffix('.md')}", content=page))
    return files


def on_page_content(content: str, page: Page, **_: Any) -> str:
    """Turn names of source files into links; warn of one that leads nowhere."""
    if page.url.startswith("source/"):
        return content

    def link(match: re.Match[str]) -> str:
        name, function = match.groups()
        path = SOURCE / name
        if not path.is_file():
            if "/" in name:
                LOG.warning("%s names %s, which does not exist", page.file.src_uri, name)
            return match[0]
        url = get_relative_url(f"source/{Path(name).with_suffix('.html')}", page.url)
        linked = f'<a href="{url}"><code>{name}</code></a>'
        if function is None:
            return linked
        line = _line_of(function, path.read_text("utf-8"))
        if not line:
            LOG.warning("%s names %s of %s, which is not there", page.file.src_uri, function, name)
        return f'{linked} <a href="{url}#__codelineno-0-{line}"><code>{function}</code></a>'

    return _NAMED.sub(link, content)


def _line_of(function: str, text: str) -> int:
    """Line of a file on which a function or a method begins, or 0."""
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith(f"def {function}("):
            return number
    return 0
