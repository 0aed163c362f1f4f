"""The page of the geometry file: every key of the conductors of a line."""

from pathlib import Path
from typing import Any, Literal, get_args, get_origin

from markdown_pieces import code, table
from pydantic.fields import FieldInfo
from scenario_page import range_of

from tpss.conductors.geometry import Conductor, Geometry, Wire
from tpss.units import label

EXAMPLE = Path(__file__).parents[2] / "examples" / "geometry_2x25kv.toml"

INTRODUCTION = """# Geometry file

A file in [TOML](https://toml.io) with the conductors of a line, for `tpss line-constants` and
`tpss.load_geometry`. [Catenary from wires and rails](../how-to/line-constants.md) shows how it is used,
[line constants](../theory/line-constants.md) what is computed. Unknown keys are refused, all faults are
reported at once, and `tpss schema --geometry` makes editors know the format."""

WIRES = """`wire` of a conductor takes the name of an entry of the [library](library.md#wires), the name
of one of `wires`, or a table with these keys, also in a file of its own that it names."""


def page() -> str:
    """Text of the page."""
    parts = [INTRODUCTION, f"One such file is `examples/{EXAMPLE.name}`:"]
    parts.append(f"```toml\n{EXAMPLE.read_text('utf-8')}```")
    sections: list[tuple[str, type[Any], str]] = [
        ("The whole file", Geometry, ""),
        ("`[[conductors]]`", Conductor, ""),
        ("`[wires.NAME]`", Wire, WIRES),
    ]
    for title, part, words in sections:
        parts += [f"## {title}", *filter(None, [words]), _keys(part)]
    return "\n\n".join(parts)


def _keys(part: type[Any]) -> str:
    """Table of a part's keys."""
    rows = [
        (f"`{name}`", _value(field), label(name), _default(field), field.description or "")
        for name, field in part.model_fields.items()
    ]
    return table(("key", "value", "unit", "default", "meaning"), rows)


def _value(field: FieldInfo) -> str:
    """Range of a number, or the choices that there are."""
    if get_origin(field.annotation) is Literal:
        return " or ".join(code(choice) for choice in get_args(field.annotation))
    return range_of(field.metadata)


def _default(field: FieldInfo) -> str:
    if field.is_required():
        return "**required**"
    return "" if field.default in (None, {}) else code(field.default)
