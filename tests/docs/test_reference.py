"""Pages that follow from the program are up to date."""

import subprocess
import sys
from pathlib import Path

from tpss import library

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
