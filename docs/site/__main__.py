"""Make the site: ``python docs/site build --strict``, or ``serve`` to see it while you write.

Zensical builds it by `mkdocs.yml`; here its Markdown is taught two more things, and the pages of the
source are written, which it copies.
"""

import sys
from pathlib import Path

from zensical.main import cli

DOCS = Path(__file__).parents[1]
sys.path.insert(0, str(DOCS / "extensions"))
from source_pages import write_pages  # noqa: E402, found where the line above says

if __name__ == "__main__":
    write_pages(DOCS)
    cli()
