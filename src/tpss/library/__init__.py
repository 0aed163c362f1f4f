"""Data that ship with the package: locomotives, catenaries, converters, transformers, lines, limits.

Each kind is a TOML file of this folder, each entry a table with units in its keys and a ``source``.
"""

import json
import tomllib
from functools import cache
from importlib.resources import files
from typing import Any

KINDS = tuple(
    sorted(file.name[:-5] for file in files(__package__).iterdir() if file.name.endswith(".toml"))
)


@cache
def entries(kind: str) -> dict[str, dict[str, Any]]:
    """All entries of a kind by name, with their sources."""
    return tomllib.loads(files(__package__).joinpath(f"{kind}.toml").read_text("utf-8"))


def values(kind: str, name: str) -> dict[str, Any]:
    """The values of an entry, without its source."""
    return {key: value for key, value in entries(kind)[name].items() if key != "source"}


@cache
def networks() -> dict[str, Any]:
    """Coefficients of the locomotives' neural networks, as printed."""
    text = files(__package__).joinpath("networks.json").read_text("utf-8")
    coefficients: dict[str, Any] = json.loads(text)
    return coefficients
