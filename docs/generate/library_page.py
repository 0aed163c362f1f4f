"""The page of the library: every entry with its values and their source."""

from typing import Any

from markdown_pieces import code, prose, table

from tpss import library
from tpss.units import label

KINDS = {
    "catenaries": ("Contact-line systems", "`supply.catenary`"),
    "contact_lines": (
        "Contact lines and third rails of a direct current",
        "`contact_line` of `supply.catenary`",
    ),
    "rails": ("Running rails", "`rails` of `supply.catenary`"),
    "high_voltage_lines": ("High-voltage lines", "`supply.high_voltage_line.type`"),
    "transformers": (
        "Transformers",
        "`line_transformer` and `station_transformer` of `supply.high_voltage_line`",
    ),
    "station_transformers": (
        "Transformers of stations",
        "`transformer` of `supply.transformer_stations`",
    ),
    "converters": ("Converters", "`type` of `supply.converter_stations`"),
    "rectifiers": ("Rectifiers", "`type` of `supply.rectifier_stations`"),
    "locomotives": ("Trains", "`model` of a train"),
    "systems": ("Electrification systems", "`supply.system`"),
    "voltage_limits": ("Voltage limits", "`supply.system`, by which the result is judged"),
    "rail_limits": ("Limits of rails", "`standards.rails`, by which the result is judged"),
    "wires": ("Wires", "`wire` of conductors in a [geometry](geometry.md)"),
}
"""Title of each kind, and the keys that take its names."""

NETWORKS = {
    "tractive_effort": "largest force of the motors",
    "bridge_sine": "reactive power of the double bridge",
    "power_factor": "power factor",
}

INTRODUCTION = """# Library

What ships with TPSS as data. A scenario names an entry, or gives a table of its own with the [same
keys](scenario.md). A [library of your own](../how-to/own-library.md) adds entries to most kinds."""

MACHINES = """## Machines

A locomotive's machine is a set of neural networks with one hidden layer. Outside of the ranges on
which they were trained they extrapolate; the result counts the steps in which that happens. All
coefficients are those of [Boullanger2009](../bibliography.md#boullanger2009)."""


def page() -> str:
    """Text of the page."""
    blocks = [INTRODUCTION]
    for kind, (title, keys) in KINDS.items():
        blocks += [f"## {title}", f"Taken by {keys}."]
        for name, entry in library.entries(kind).items():
            blocks += [f"### {name}", _values(entry), f"Source: {prose(entry['source'])}."]
    return "\n\n".join([*blocks, MACHINES, "### Rc4", _networks()])


def _values(entry: dict[str, Any]) -> str:
    rows = [
        (f"`{key}`", f"{value:g}" if isinstance(value, int | float) else code(value), label(key))
        for key, value in _flat(entry).items()
        if key != "source"
    ]
    return table(("key", "value", "unit"), rows)


def _flat(entry: dict[str, Any]) -> dict[str, Any]:
    """Values by their key paths."""
    found: dict[str, Any] = {}
    for key, value in entry.items():
        inner = _flat(value) if isinstance(value, dict) else {"": value}
        found |= {f"{key}.{below}".rstrip("."): each for below, each in inner.items()}
    return found


def _networks() -> str:
    """Table of the machine's networks: what they give, inputs with their ranges, source."""
    rows = []
    for name, meaning in NETWORKS.items():
        network = library.networks()[name]
        ends = (network["inputs"], network["input_min"], network["input_max"])
        inputs = [f"`{text}` {low:g} to {high:g}" for text, low, high in zip(*ends, strict=True)]
        source = f"{network['source']}. {network['reading']}".replace("[", r"\[")
        rows.append((f"{meaning}, `{network['output']}`", ", ".join(inputs), source))
    return table(("network and its output", "inputs, with their ranges", "source"), rows)
