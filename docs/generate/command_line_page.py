"""The page of the command line: usage, arguments and options of every command."""

import inspect
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args, get_type_hints

from markdown_pieces import table
from typer.main import get_command

from tpss.cli.main import app

INTRODUCTION = """# Command line

`tpss` works on a [scenario file](scenario.md). `tpss COMMAND --help` prints what stands here, and
`tpss --install-completion` lets the shell complete commands and options.

| exit code | meaning |
|---|---|
| 0 | done |
| 2 | bad input; nothing was simulated |
| 3 | the line cannot carry its load, or a train stalls; results up to then are saved |
| 4 | the audit failed |
| 5 | a plan within a budget may not be the best one: the time was over |
| 130 | interrupted; results up to then are saved |"""

VALUES = {Path: "PATH", str: "TEXT", int: "NUMBER", float: "NUMBER"}
"""What stands for the value of an option that names none itself."""


def page() -> str:
    """Text of the page."""
    return "\n\n".join([INTRODUCTION, *filter(None, _sections(get_command(app), "tpss"))])


def _sections(command: Any, path: str) -> Iterator[str]:
    """A section for a command, then one for each command below it."""
    below = getattr(command, "commands", {})
    yield f"## `{path}`"
    yield _plain(command.help or "")
    words = [path, "[OPTIONS]", "COMMAND ..." if below else _arguments(command)]
    yield f"```text\n{' '.join(filter(None, words))}\n```"
    own = [parameter for parameter in command.params if "completion" not in parameter.name]
    yield table(("argument or option", "meaning"), [_row(each, command) for each in own])
    yield _example(command.epilog or "")
    for name, inner in sorted(below.items()):
        if not inner.hidden:
            yield from _sections(inner, f"{path} {name}")


def _arguments(command: Any) -> str:
    return " ".join(_name(p) for p in command.params if p.param_type_name == "argument")


def _name(parameter: Any) -> str:
    """Name of an argument, in brackets if it may be left out, with dots if there may be several."""
    name = f"{parameter.metavar or parameter.name.upper()}{'...' if parameter.nargs == -1 else ''}"
    return name if parameter.required else f"[{name}]"


def _row(parameter: Any, command: Any) -> tuple[str, str]:
    meaning = _plain(parameter.help or "").replace("|", "\\|")
    if parameter.param_type_name == "argument":
        return f"`{_name(parameter)}`", meaning
    value = "" if parameter.is_flag else f" {parameter.metavar or _value(parameter, command)}"
    return f"`{', '.join(parameter.opts)}{value}`", meaning


def _value(option: Any, command: Any) -> str:
    """Word for an option's value, by the type that its command declares."""
    declared = get_type_hints(command.callback)[option.name]
    kinds = [VALUES[kind] for kind in (declared, *get_args(declared)) if kind in VALUES]
    return kinds[0] if kinds else "VALUE"


def _plain(text: str) -> str:
    """A help text as Markdown, which would take what stands in angle brackets for HTML."""
    return inspect.cleandoc(text).replace("<", "&lt;")


def _example(epilog: str) -> str:
    """The calls at the end of a help text, ready to copy."""
    calls = [call for call in re.split(r"\s{2,}|, then ", epilog) if call.startswith("tpss ")]
    if not calls:
        return ""
    return "\n".join(["Example:\n", "```bash", *calls, "```"])
