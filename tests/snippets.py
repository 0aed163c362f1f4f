"""Run what a page of the documentation shows, in order, in a folder of its own.

A fenced block says by its language and its title what becomes of it:

    toml, csv   title="line.toml"            is added to the end of that file, which may be new
    toml        title="The whole line.toml"  must be that file as it stands now
    diff        title="line.toml"            changes that file: lines with - go, lines with + come
    bash                                     is run, in a shell or, plain calls of TPSS, in this process;
                                             title="Exit code 3" asks for that code
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
import shlex
import subprocess
import sys
import textwrap
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from unittest.mock import patch

from tpss.cli.main import main

_FENCE = re.compile(r'^( *)```(\w+)(?: title="(.*?)")?\n(.*?)^\1```$', re.MULTILINE | re.DOTALL)
_NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[+-]\d+)?")


WIDTH = "80"
"""Columns of the terminal."""

_OF_A_SHELL = frozenset("|&;<>()$`\\*?[]#~{}!")
"""Characters that mean more to a shell than themselves."""


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


def calls_of(commands: str) -> list[list[str]]:
    """Arguments of the calls of TPSS, if that is all there is, and no shell is needed to read them."""
    lines = [line for line in commands.replace("\\\n", " ").splitlines() if line.strip()]
    if any(_OF_A_SHELL & set(line) or not line.startswith("tpss ") for line in lines):
        return []
    return [shlex.split(line)[1:] for line in lines]


def call_here(calls: list[list[str]], folder: Path) -> tuple[int, str, str]:
    """Call TPSS in this process, until a call fails: a new one would have to import all of it anew.

    Returns
    -------
    int, str, str
        Exit code of the last call, and what they printed as output and as errors.
    """
    out, err, code = io.StringIO(), io.StringIO(), 0
    with (
        contextlib.chdir(folder),
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
        patch.dict(os.environ, {"COLUMNS": WIDTH}),
    ):
        for arguments in calls:
            with patch.object(sys, "argv", ["tpss", *arguments]):
                try:
                    main()
                except SystemExit as ended:
                    code = int(ended.code or 0)
            if code != 0:
                break
    return code, out.getvalue(), err.getvalue()


@dataclass
class Reader:
    """Someone who types what a page shows."""

    folder: Path
    output: str = ""
    """What the last block printed."""
    seen: str = ""
    """All that was typed and printed."""
    names: dict[str, Any] = field(default_factory=dict)
    in_shell: bool = True
    """Whether all commands are typed into a shell; otherwise plain ones are called in this process."""

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
        calls = [] if self.in_shell else calls_of(block.text)
        code, out, err = call_here(calls, self.folder) if calls else self._in_shell(block.text)
        expected = int(block.title.removeprefix("Exit code ") or 0)
        assert code == expected, out + err
        self._hear(out if expected == 0 else out + err)

    def _in_shell(self, commands: str) -> tuple[int, str, str]:
        path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
        done = subprocess.run(
            ["bash", "-e", "-o", "pipefail", "-c", commands],
            cwd=self.folder,
            env={**os.environ, "PATH": path, "COLUMNS": WIDTH},
            capture_output=True,
            text=True,
            check=False,
        )
        return done.returncode, done.stdout, done.stderr

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
