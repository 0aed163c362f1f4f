"""Run what a page of the documentation shows, in order, in a folder of its own.

A fenced block says by its language and its title what becomes of it:

    toml, csv   title="line.toml"            is added to the end of that file, which may be new
    toml        title="The whole line.toml"  must be that file as it stands now
    diff        title="line.toml"            changes that file: lines with - go, lines with + come
    bash                                     is run; title="Exit code 3" asks for that code
    python                                   is run, all blocks of a page in one namespace
    text        title="Output"               must be what the block before it has printed
    others                                   are shown only

Output is compared line by line, white space made even.  Numbers may differ by one in their last digit.
``...`` stands for anything within a line, and on a line of its own for any lines.
"""

import contextlib
import io
import os
import re
import subprocess
import sys
import textwrap
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

_FENCE = re.compile(r'^( *)```(\w+)(?: title="(.*?)")?\n(.*?)^\1```$', re.MULTILINE | re.DOTALL)
_NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[+-]\d+)?")


@dataclass(frozen=True)
class Block:
    """A fenced block of a page."""

    language: str
    title: str
    text: str
    line: int


def blocks(page: str) -> list[Block]:
    """All fenced blocks of a page."""
    return [
        Block(
            match[2],
            match[3] or "",
            textwrap.dedent(match[4]),
            page.count("\n", 0, match.start()) + 1,
        )
        for match in _FENCE.finditer(page)
    ]


@dataclass
class Reader:
    """Someone who types what a page shows."""

    folder: Path
    output: str = ""
    """What the last block printed."""
    seen: str = ""
    """All that was typed and printed."""
    names: dict[str, Any] = field(default_factory=dict)

    def follow(self, block: Block) -> None:
        """Do what a block says; an `AssertionError` says what came out otherwise."""
        if block.language in ("toml", "csv") and block.title.startswith("The whole "):
            name = block.title.removeprefix("The whole ")
            assert block.text.split() == (self.folder / name).read_text("utf-8").split()
        elif block.language in ("toml", "csv") and block.title:
            with (self.folder / block.title).open("a", encoding="utf-8") as file:
                file.write(block.text)
        elif block.language == "diff":
            self._change(block)
        elif block.language == "bash":
            self._run_shell(block)
        elif block.language == "python":
            self._run_python(block)
        elif block.title == "Output":
            assert_same_output(block.text, self.output)
        self.seen += block.text

    def _change(self, block: Block) -> None:
        lines = block.text.splitlines(keepends=True)
        before = "".join(line[1:] for line in lines if line[0] != "+")
        after = "".join(line[1:] for line in lines if line[0] != "-")
        file = self.folder / block.title
        text = file.read_text("utf-8")
        assert text.count(before) == 1, f"these lines are not once in {block.title}:\n{before}"
        file.write_text(text.replace(before, after), "utf-8")

    def _run_shell(self, block: Block) -> None:
        path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
        done = subprocess.run(
            ["bash", "-e", "-o", "pipefail", "-c", block.text],
            cwd=self.folder,
            env={**os.environ, "PATH": path, "COLUMNS": "80"},
            capture_output=True,
            text=True,
            check=False,
        )
        expected = int(block.title.removeprefix("Exit code ") or 0)
        assert done.returncode == expected, done.stdout + done.stderr
        self._hear(done.stdout if expected == 0 else done.stdout + done.stderr)

    def _run_python(self, block: Block) -> None:
        printed = io.StringIO()
        with contextlib.chdir(self.folder), contextlib.redirect_stdout(printed):
            exec(compile(block.text, f"line {block.line}", "exec"), self.names)
        self._hear(printed.getvalue())

    def _hear(self, output: str) -> None:
        self.output = output
        self.seen += output


def _lines(text: str) -> list[str]:
    """Lines with something on them, white space made even, the rules of tables left out."""
    made_even = (" ".join(line.split()) for line in text.splitlines())
    return [line for line in made_even if line.strip("─ ")]


def assert_same_output(expected: str, output: str) -> None:
    """Assert that the output is the expected one, as far as that says."""
    left = _lines(output)
    anything = False
    for line in _lines(expected):
        if line == "...":
            anything = True
            continue
        while anything and left and not _same(line, left[0]):
            left.pop(0)
        assert left, f"expected {line!r} at the end of\n{output}"
        assert _same(line, left[0]), f"expected {line!r}, not {left[0]!r}, in\n{output}"
        left.pop(0)
        anything = False
    assert anything or not left, f"not expected: {left}"


def _same(expected: str, line: str) -> bool:
    """Whether a line is the expected one, numbers within one of their last digit."""
    words = (re.escape(part) for part in _NUMBER.sub("#", expected).split("..."))
    numbers = _NUMBER.findall(expected)
    if "..." in expected:
        # Numbers that stand for anything are not counted: compare as many from the start.
        shape = ".*".join(words)
        found = _NUMBER.findall(line)[: len(numbers)]
    else:
        shape = "".join(words)
        found = _NUMBER.findall(line)
    is_like = re.fullmatch(shape, _NUMBER.sub("#", line)) is not None
    return is_like and len(found) == len(numbers) and all(map(_close, numbers, found))


def _close(expected: str, found: str) -> bool:
    _, point, decimals = expected.partition(".")
    unit = 10.0 ** -len(decimals) if point and "e" not in expected else 0.0
    return abs(float(expected) - float(found)) <= 1.01 * unit


def decimals_in_prose(page: str) -> list[str]:
    """Numbers with decimals in the text between the blocks; code and versions left out."""
    prose = re.sub(r"`.*?`", "", _FENCE.sub("", page))
    return re.findall(r"(?<![\w.])(?<!Python )\d+\.\d+(?![\w.]\w)", prose)


def was_seen(number: str, seen: str) -> bool:
    """Whether a number, or one that rounds to it, stands in a text."""
    digits = len(number.partition(".")[2])
    return any(f"{float(each):.{digits}f}" == number for each in _NUMBER.findall(seen))
