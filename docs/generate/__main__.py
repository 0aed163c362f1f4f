"""Write the pages of the reference that follow from the program: ``python docs/generate``.

With ``--check`` nothing is written; the exit code is 1 if a page is out of date.
"""

import sys
from pathlib import Path

import command_line_page
import evidence_page
import gallery_page
import geometry_page
import library_page
import nomenclature_tables
import plan_page
import result_page
import scenario_page
import study_page

DOCS = Path(__file__).parents[1]
NOTE = "<!-- Written by `python docs/generate`: edit that, or the program, not this page. -->"
PAGES = {
    "gallery.md": gallery_page.page,
    "reference/command_line.md": command_line_page.page,
    "reference/evidence.md": evidence_page.page,
    "reference/geometry.md": geometry_page.page,
    "reference/library.md": library_page.page,
    "reference/plan.md": plan_page.page,
    "reference/result.md": result_page.page,
    "reference/scenario.md": scenario_page.page,
    "reference/study.md": study_page.page,
}


def main() -> int:
    """Write or check all pages; return the exit code."""
    check = sys.argv[1:] == ["--check"]
    texts = {DOCS / name: f"{NOTE}\n\n{page().strip()}\n" for name, page in PAGES.items()}
    texts[nomenclature_tables.PAGE] = nomenclature_tables.page()
    stale = []
    for file, text in texts.items():
        if file.exists() and file.read_text("utf-8") == text:
            continue
        stale.append(file.name)
        if not check:
            file.write_text(text, "utf-8")
    if stale:
        done = "out of date; run python docs/generate" if check else "written"
        print(f"{', '.join(stale)}: {done}")
    return int(check and bool(stale))


if __name__ == "__main__":
    sys.exit(main())
