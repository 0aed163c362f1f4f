"""Every page that shows commands, files or code shows what really happens; see `snippets`."""

import os
import shutil
import tomllib
from pathlib import Path

import pytest

from tpss.laws import registry

from snippets import Block, Reader, assert_same_output, blocks, decimals_in_prose, was_seen

DOCS = Path(__file__).parents[2] / "docs"
TUTORIAL = DOCS / "tutorial.md"
FOR_DEVELOPERS = [DOCS / "how-to" / f"{name}.md" for name in ("add-a-kind", "change-an-equation")]
FOR_AUTHORS = DOCS / "how-to" / "laws-of-your-own.md"
HOW_TO = sorted({*DOCS.glob("how-to/*.md")} - {*FOR_DEVELOPERS, FOR_AUTHORS})


def follow(page: Path, reader: Reader) -> None:
    """Do what a page says, block by block."""
    for block in blocks(page.read_text("utf-8")):
        try:
            reader.follow(block)
        except Exception as error:
            error.add_note(f"{page.relative_to(DOCS)}, line {block.line}")
            raise


def demand_seen_figures(page: Path, reader: Reader) -> None:
    numbers = decimals_in_prose(page.read_text("utf-8"))
    assert [number for number in numbers if not was_seen(number, reader.seen)] == []


class Beginner(Reader):
    """A reader of the tutorial: the first command goes to a shell, which has to find TPSS."""

    def follow(self, block: Block) -> None:
        super().follow(block)
        if block.language == "bash":
            self.in_shell = False


def test_the_tutorial_can_be_followed_and_quotes_what_it_prints(tmp_path):
    reader = Beginner(tmp_path)
    follow(TUTORIAL, reader)
    demand_seen_figures(TUTORIAL, reader)


@pytest.mark.parametrize("page", HOW_TO, ids=lambda page: page.stem)
def test_a_guide_can_be_followed_from_the_end_of_the_tutorial(page, tmp_path):
    """Guides go on with the tutorial's `line.toml`.

    Their plain commands are called in this process; what has pipes, quotes that a shell has to read, or
    other programs in it goes to a shell.
    """
    reader = Reader(tmp_path, in_shell=False)
    for block in blocks(TUTORIAL.read_text("utf-8")):
        if block.language == "toml":
            reader.follow(block)
    follow(page, reader)
    demand_seen_figures(page, reader)


class Developer(Reader):
    """A reader who makes files of the source too: blocks of `py` with a title."""

    def follow(self, block: Block) -> None:
        if block.language == "py" and block.title:
            (self.folder / block.title).write_text(block.text, "utf-8")
            self.seen += block.text
        else:
            super().follow(block)


@pytest.mark.parametrize("page", FOR_DEVELOPERS, ids=lambda page: page.stem)
def test_a_guide_for_developers_can_be_followed(page, tmp_path, monkeypatch):
    """In a copy of the source, which is what runs there: as plain Python, not to be compiled."""
    source = DOCS.parent / "src"
    shutil.copytree(source, tmp_path / "src", ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setenv("PYTHONPATH", str(tmp_path / "src"))
    monkeypatch.setenv("NUMBA_DISABLE_JIT", "1")
    developer = Developer(tmp_path)
    follow(page, developer)
    demand_seen_figures(page, developer)


class Author(Developer):
    """A reader who installs the package that a page shows, as pip would leave it."""

    def follow(self, block: Block) -> None:
        super().follow(block)
        if block.language == "sh" and block.text == "pip install .\n":
            self._install()

    def _install(self) -> None:
        project = tomllib.loads((self.folder / "pyproject.toml").read_text("utf-8"))["project"]
        name, version = project["name"], project["version"]
        info = self.folder / f"{name.replace('-', '_')}-{version}.dist-info"
        info.mkdir()
        metadata = f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n"
        (info / "METADATA").write_text(metadata, "utf-8")
        lines = [
            f"[{group}]\n" + "".join(f"{key} = {value}\n" for key, value in points.items())
            for group, points in project["entry-points"].items()
        ]
        (info / "entry_points.txt").write_text("\n".join(lines), "utf-8")


def test_laws_of_one_s_own_can_be_installed_and_named(tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=os.pathsep)
    monkeypatch.syspath_prepend(str(tmp_path))
    author = Author(tmp_path, in_shell=False)
    for block in blocks(TUTORIAL.read_text("utf-8")):
        if block.language == "toml":
            author.follow(block)
    try:
        follow(FOR_AUTHORS, author)
    finally:
        registry._of_packages.cache_clear()
        registry._registered.clear()
    demand_seen_figures(FOR_AUTHORS, author)


def test_output_is_the_expected_one_up_to_the_last_digit():
    assert_same_output("lowest 13.56 kV, ...\n...\nat 7 km", "lowest  13.57 kV, x\na\nb\nat 7 km\n")


@pytest.mark.parametrize("expected", ["13.54 kV", "13.56 V", "13.56 kV\nmore", "...\n13.7 kV"])
def test_other_output_is_told(expected):
    with pytest.raises(AssertionError):
        assert_same_output(expected, "13.56 kV\n")


def test_figures_in_prose_are_those_that_were_seen():
    page = "Here 13.6 kV and `1.0`.\n\n```text\n99.9\n```\n\nThen 2.5 MWh."
    assert decimals_in_prose(page) == ["13.6", "2.5"]
    assert was_seen("13.6", "lowest 13.559 kV")
    assert not was_seen("2.5", "lowest 13.559 kV")
