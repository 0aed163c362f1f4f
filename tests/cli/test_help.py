"""The command line teaches itself, completes words, and starts fast."""

import os
import re
import subprocess
import sys

import pytest
from typer.main import get_command

from tpss.cli.main import app

from conftest import EXAMPLES

COMMANDS = (
    "run", "report", "compare", "check", "export", "line-constants", "new", "library", "schema",
)  # fmt: skip
HEAVY = {"jinja2", "netCDF4", "numba", "numpy", "pandas", "plotly", "scipy", "xarray"}


def test_the_version_is_told(tpss_command):
    assert tpss_command("--version").out.startswith("tpss ")


def test_help_lists_the_commands_and_says_where_to_start(tpss_command):
    said = tpss_command("--help")
    assert said.code == 0
    assert "Start with: tpss new my-line" in said.out
    assert "--install-completion" in said.out
    for command in COMMANDS:
        assert f"│ {command} " in said.out


@pytest.mark.parametrize("command", COMMANDS)
def test_the_help_of_every_command_has_an_example(tpss_command, command):
    said = tpss_command(command, "--help")
    assert said.code == 0
    assert any(f"{word}: tpss {command}" in said.out for word in ("Example", "Examples"))


def arguments_of(command, path="tpss"):
    """What is written behind each command in its usage line, without the brackets that Typer adds."""
    for name, inner in getattr(command, "commands", {}).items():
        yield from arguments_of(inner, f"{path} {name}")
    for each in command.params:
        if each.param_type_name == "argument":
            yield pytest.param(each.metavar, id=f"{path} {each.name}")


@pytest.mark.parametrize("written", list(arguments_of(get_command(app))))
def test_arguments_are_named_in_capitals_without_brackets_of_their_own(written):
    assert re.fullmatch(r"(\[KIND=\])?[A-Z]+(\.csv)?", written)


def test_the_options_of_a_run_are_explained(tpss_command):
    said = tpss_command("run", "--help")
    for option in ("--out", "--set", "--force", "--quiet", "--show", "--report"):
        assert option in said.out


@pytest.mark.parametrize("arguments", [[], ["run"], ["import"], ["import", "csv"]])
def test_options_that_take_no_value_are_shown_without_one(tpss_command, arguments):
    assert "<bool>" not in tpss_command(*arguments, "--help").out


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["export", "r", "--to", "ods"], "'--to': 'ods' is not one of 'csv', 'xlsx', 'parquet'"),
        (["sweep", "s.toml", "--workers", "two"], "'--workers': 'two' is not a "),
        (["sweep", "s.toml", "--workers", "0"], "'--workers': "),
        (["spare-time", "line.toml", "--percent", "nan"], "'--percent': "),
    ],
)
def test_a_wrong_value_of_an_option_is_told_by_the_value_and_what_it_may_be(
    tpss_command, arguments, told
):
    said = tpss_command(*arguments)
    assert said.code == 2
    assert told in said.err
    assert "Value error" not in said.err
    assert arguments[-1] in said.err.replace(arguments[-2], "", 1)


@pytest.mark.parametrize(
    "arguments", [["--help"], ["run", "--help"], ["report", "--help"], ["library", "--help"]]
)
def test_help_imports_nothing_heavy(arguments):
    script = (
        "import sys\n"
        "from tpss.__main__ import main\n"
        "try:\n    main()\nexcept SystemExit:\n    print(*sys.modules, sep='\\n')\n"
    )
    call = [sys.executable, "-c", script, *arguments]
    done = subprocess.run(call, capture_output=True, text=True, check=True)
    assert not HEAVY & set(done.stdout.splitlines())


def completed(words: str, folder) -> list[str]:
    """What bash would offer for the last of some words."""
    environment = {
        **os.environ,
        "_TPSS_COMPLETE": "complete_bash",
        "COMP_WORDS": words,
        "COMP_CWORD": str(len(words.split(" ")) - 1),
    }
    call = [sys.executable, "-c", "from tpss.cli.main import app; app(prog_name='tpss')"]
    done = subprocess.run(
        call, env=environment, cwd=folder, capture_output=True, text=True, check=True
    )
    return done.stdout.split()


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        ("tpss sc", ["schema"]),
        ("tpss library ca", ["catenaries"]),
        ("tpss library transformers ", ["16MVA", "25MVA"]),
        ("tpss library catenarys ", []),
        ("tpss run examples/thesis_3", ["examples/thesis_3_3.toml", "examples/thesis_3_7_2.toml"]),
        ("tpss run exa", []),  # a folder is left to the shell
    ],
)
def test_words_are_completed(tmp_path, words, offered):
    (tmp_path / "examples").symlink_to(EXAMPLES)
    assert completed(words, tmp_path) == offered


def test_options_without_a_value_show_none(tpss_command):
    """Behind them begins what they do."""
    said = tpss_command("run", "--help")
    assert re.findall(r"--(quiet|force) (\S+)", said.out) == [
        ("force", "Replace"),
        ("quiet", "Print"),
    ]
