"""A page for each file of ``src/tpss`` that is named: its text in colours, an anchor at each line."""

import html
import posixpath
import re
import shutil
from pathlib import Path

from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import PythonLexer

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "tpss"
_NAME = re.compile(r"`([a-z_/]+\.py)`")
FOLDER = "source"
STYLES = {"light": "default", "dark": "github-dark"}

_PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{name} - TPSS</title>
<link rel="stylesheet" href="{style}">
</head>
<body>
<header><a href="{home}">TPSS</a> <a href="{equations}">From equation to code</a></header>
<main>
<h1>{name}</h1>
{text}
</main>
</body>
</html>
"""

_LOOKS = """body {
  margin: 1rem auto; max-width: 72rem; padding: 0 1rem;
  font-family: sans-serif; background: white; color: black;
}
header a { margin-right: 1rem; color: inherit; }
h1 { font-size: 1.3rem; }
:target { background: #ff02; outline: 1px solid; }
pre { font-size: 0.85rem; line-height: 1.4; overflow-x: auto; padding: 0.5rem; }
"""

_DARK = "body { background: #0d1117; color: #e6edf3; }\n"


def page_of(name: str) -> str:
    """Address of the page of a file, from the home of the site."""
    return f"{FOLDER}/{name.removesuffix('.py')}.html"


def write_pages(docs: Path) -> None:
    """Write the pages of all files that are named into the folder of the documentation."""
    shutil.rmtree(docs / FOLDER, ignore_errors=True)
    coloured = HtmlFormatter(linespans="line", cssclass="code")
    for name in sorted(_named(docs)):
        page = docs / page_of(name)
        page.parent.mkdir(parents=True, exist_ok=True)
        text = highlight((SOURCE / name).read_text("utf-8"), PythonLexer(), coloured)
        page.write_text(_PAGE.format(name=html.escape(name), text=text, **_links_of(name)), "utf-8")
    (docs / FOLDER).mkdir(exist_ok=True)
    (docs / FOLDER / "code.css").write_text(_style(), "utf-8")


def _named(docs: Path) -> set[str]:
    """Files of the source that stand in a page's code font."""
    pages = [*docs.rglob("*.md"), ROOT / "CHANGELOG.md"]
    names = {name for page in pages for name in _NAME.findall(page.read_text("utf-8"))}
    return {name for name in names if (SOURCE / name).is_file()}


def _links_of(name: str) -> dict[str, str]:
    """What the page of a file leads to, from there."""
    targets = {"style": f"{FOLDER}/code.css", "home": "index.html", "equations": "equations.html"}
    folder = posixpath.dirname(page_of(name))
    return {key: posixpath.relpath(target, folder) for key, target in targets.items()}


def _style() -> str:
    light, dark = (
        HtmlFormatter(style=style, cssclass="code").get_style_defs(".code")
        for style in STYLES.values()
    )
    return f"{_LOOKS}{light}\n@media (prefers-color-scheme: dark) {{\n{_DARK}{dark}\n}}\n"
