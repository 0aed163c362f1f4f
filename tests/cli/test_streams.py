"""Output that is redirected, as on Windows with a code page that lacks Ω and ‰: it is UTF-8."""

import io
import os
import subprocess
import sys

import pytest

from tpss.cli.streams import say_everything

from conftest import EXAMPLES

CODE_PAGES = ("cp1252", "ascii")


def redirected(code_page: str, *arguments: object) -> subprocess.CompletedProcess[bytes]:
    """The command line in a process of its own, whose output goes into pipes of a code page."""
    return subprocess.run(
        [sys.executable, "-m", "tpss", *map(str, arguments)],
        capture_output=True,
        env={**os.environ, "PYTHONIOENCODING": code_page, "PYTHONUTF8": "0", "COLUMNS": "200"},
    )


@pytest.mark.parametrize("code_page", CODE_PAGES)
@pytest.mark.parametrize(
    ("arguments", "sign"),
    [
        (("check", EXAMPLES / "thesis_160km.toml"), "Ω/km"),
        (("library", "catenaries"), "Ω/km"),
        (("schema",), "[‰]"),
    ],
    ids=lambda each: each[0] if isinstance(each, tuple) else each,
)
def test_redirected_output_is_utf_8(code_page, arguments, sign):
    said = redirected(code_page, *arguments)
    assert (said.returncode, said.stderr) == (0, b"")
    assert sign in said.stdout.decode("utf-8")


@pytest.mark.parametrize("code_page", CODE_PAGES)
def test_faults_that_are_redirected_are_utf_8(code_page):
    said = redirected(code_page, "library", "catenaries", "Ω")
    assert said.returncode == 2
    assert "'Ω'" in said.stderr.decode("utf-8")


class Terminal(io.TextIOWrapper):
    def isatty(self) -> bool:
        return True


def test_a_terminal_keeps_its_encoding_and_shows_what_it_lacks_by_its_code(monkeypatch):
    written = io.BytesIO()
    terminal = Terminal(written, encoding="latin-1")
    monkeypatch.setattr(sys, "stdout", terminal)
    say_everything()
    print("0.2 Ω at 20 °C", end="", flush=True)
    assert written.getvalue() == b"0.2 \\u03a9 at 20 \xb0C"


def test_what_takes_every_character_is_left_as_it_is(monkeypatch):
    strict = Terminal(io.BytesIO(), encoding="utf-16", errors="strict")
    monkeypatch.setattr(sys, "stdout", strict)
    monkeypatch.setattr(sys, "stderr", None)
    say_everything()
    assert (strict.encoding, strict.errors) == ("utf-16", "strict")
