"""Completion of words of the command line by the shell."""

import shlex
from pathlib import Path

import typer

from tpss import library
from tpss.results.contents import FIGURE_NAMES


def scenario_files(incomplete: str) -> list[str]:
    """TOML files that begin like this; none, and so the shell's own choice, if a folder may be meant."""
    folder, slash, beginning = incomplete.rpartition("/")
    place = Path(folder + slash)
    matches = [path for path in place.glob("*") if path.name.startswith(beginning)]
    names = [f"{folder}{slash}{path.name}" for path in matches if path.suffix == ".toml"]
    left_to_the_shell = any(path.is_dir() for path in matches) or any(
        shlex.quote(name) != name for name in names
    )
    return [] if left_to_the_shell else sorted(names)


def library_kinds(incomplete: str) -> list[str]:
    """Kinds of the library that begin like this."""
    return [kind for kind in library.KINDS if kind.startswith(incomplete)]


def library_names(context: typer.Context, incomplete: str) -> list[str]:
    """Names of the kind before them that begin like this."""
    from tpss.scenario.own_library import own_entries  # it loads pydantic, which no help needs

    kind = context.params.get("kind")
    shipped = library.entries(kind) if kind in library.KINDS else {}
    own = own_entries().get(str(kind), {})
    return [name for name in {**shipped, **own} if name.startswith(incomplete)]


def figures(incomplete: str) -> list[str]:
    """Names of figures that begin like this."""
    return [name for name in (*FIGURE_NAMES, "all") if name.startswith(incomplete)]


def examples(incomplete: str) -> list[str]:
    """Names of examples that begin like this."""
    from tpss.cli.new import LIST
    from tpss.examples import names

    return [name for name in (LIST, *names()) if name.startswith(incomplete)]
