"""Every page that shows commands, files or code shows what really happens; see `snippets`."""

import shutil
from pathlib import Path

import pytest

from snippets import Block, Reader, assert_same_output, blocks, decimals_in_prose, was_seen

DOCS = Path(__file__).parents[2] / "docs"
TUTORIAL = DOCS / "tutorial.md"
FOR_DEVELOPERS = DOCS / "how-to" / "add-a-kind.md"
HOW_TO = sorted({*DOCS.glob("how-to/*.md")} - {FOR_DEVELOPERS})


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


def test_the_tutorial_can_be_followed_and_quotes_what_it_prints(tmp_path):
    reader = Reader(tmp_path)
    follow(TUTORIAL, reader)
    demand_seen_figures(TUTORIAL, reader)


@pytest.mark.parametrize("page", HOW_TO, ids=lambda page: page.stem)
def test_a_guide_can_be_followed_from_the_end_of_the_tutorial(page, tmp_path):
    """Guides go on with the tutorial's `line.toml`.

    Other than the tutorial's, their plain commands are called in this process; what has pipes, quotes
    that a shell has to read, or other programs in it goes to a shell.
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


def test_every_kind_of_the_developer_s_guide_can_be_added(tmp_path, monkeypatch):
    """In a copy of the source, which is what runs there: as plain Python, not to be compiled."""
    source = DOCS.parent / "src"
    shutil.copytree(source, tmp_path / "src", ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setenv("PYTHONPATH", str(tmp_path / "src"))
    monkeypatch.setenv("NUMBA_DISABLE_JIT", "1")
    developer = Developer(tmp_path)
    follow(FOR_DEVELOPERS, developer)
    demand_seen_figures(FOR_DEVELOPERS, developer)


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
