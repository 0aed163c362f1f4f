"""Pages that follow from the program are up to date."""

import re
import subprocess
import sys
from pathlib import Path

from tpss import library
from tpss.report.figures import FIGURES

ROOT = Path(__file__).parents[2]


def test_the_generated_pages_are_those_of_this_program():
    call = [sys.executable, "docs/generate", "--check"]
    done = subprocess.run(call, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_every_entry_of_the_library_has_its_page():
    page = (ROOT / "docs" / "reference" / "library.md").read_text("utf-8")
    folder = Path(library.__file__).parent
    for kind in (file.stem for file in folder.glob("*.toml")):
        for name in library.entries(kind):
            assert f"### {name}\n" in page, kind


def test_every_figure_has_its_picture_in_the_gallery():
    page = (ROOT / "docs" / "gallery.md").read_text("utf-8")
    pictures = re.findall(r"\]\((gallery/.*?)\)", page)
    assert {f"gallery/{name}.png" for name in FIGURES} <= set(pictures)
    assert [each for each in pictures if not (ROOT / "docs" / each).is_file()] == []
    drawn = {f"gallery/{file.name}" for file in (ROOT / "docs" / "gallery").iterdir()}
    assert drawn == set(pictures)
