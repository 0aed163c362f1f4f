"""The page of the scenario file: every key, from the schema that validates it."""

import inspect
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Any, Literal, get_args, get_origin

from annotated_types import Ge, Gt, Le, Lt
from library_page import KINDS
from markdown_pieces import anchor, code, prose, table
from pydantic import Field, TypeAdapter, ValidationError
from pydantic.fields import FieldInfo

from tpss import library
from tpss.scenario import Scenario
from tpss.scenario.absences import ABSENCES
from tpss.scenario.clock import OrClock
from tpss.scenario.fields import fields_of
from tpss.units import label

EXAMPLE = Path(__file__).parents[2] / "examples" / "thesis_160km.toml"

INTRODUCTION = """# Scenario file

A scenario is a file in [TOML](https://toml.io). Numbers carry their unit in the key's name; where a
number is asked for, a whole one will do. Unknown keys are refused, with the nearest known one as a
proposal if one is near, or with what is [not modelled](#not-modelled), and all faults of a file are
reported at once. Paths are relative to the file.

`--set` of `tpss run` and `Scenario.with_` reach a single value by its path,
`simulation.time_step_min` or `traffic.0.headway_min`. A key without a default may be left out
unless it is marked as required."""

NOT_MODELLED = (
    "Keys that ask for one of these are told so; what has no other way is to be left out."
)

GIVEN = {"model": ("locomotives", "the model's"), "system": ("voltage_limits", "the system's")}
"""Keys that name an entry of the library, its kind, and whose values the others then have."""

DEFAULTS = {
    "Line.gradients_file": "this or `gradients`",
    "Line.gradients": "this or `gradients_file`",
    "Line.speed_limits_file": "this or `speed_limits`",
    "Line.speed_limits": "this or `speed_limits_file`",
    "Line.stations_file": "this or `stations`",
    "Line.stations": "this or `stations_file`",
    "EffortTable.curve_file": "this, or the lists",
    "EffortTable.speed_kmh": "this, or `curve_file`",
    "EffortTable.force_kn": "this, or `curve_file`",
    "RetardationBands.curve_file": "this, or the lists",
    "RetardationBands.from_speed_kmh": "this, or `curve_file`",
    "RetardationBands.retardation_m_s2": "this, or `curve_file`",
    "Simulation.time_step_min": "chosen",
    "Simulation.until": "this, unless `duration_min`",
    "Traffic.headway_min": "this, `departures_min` or `departure_min`",
    "Traffic.departures_min": "this, `headway_min` or `departure_min`",
    "Traffic.departure_min": "this, `headway_min` or `departures_min`",
    "Scenario.traffic": "this or `timetables`",
    "Supply.frequency_hz": "the system's",
    "Supply.transformer_stations": "none",
    "Supply.mixed_stations": "none",
    "Supply.converter_stations": "none; there is a station of some kind",
    "ConverterLosses.idle_kw": "this, `curve` or `curve_file`",
    "ConverterLosses.curve": "this, `curve_file` or `idle_kw`",
    "ConverterLosses.curve_file": "this, `curve` or `idle_kw`",
    "ConverterLosses.feedback_quadratic_percent": "`quadratic_percent`",
    "VoltageLimits.system": "the supply's",
    "VoltageLimits.mean_useful_kv": "the system's, if any, with its `un_kv`",
    "VoltageLimits.mean_useful_fast_kv": "the system's, if any, with its `un_kv`",
    "HighVoltageLine.transformers_km": "this or `transformers`",
    "HighVoltageLine.transformers": "this or `transformers_km`",
}
"""Defaults that the schema does not know, such as of keys of which one is needed."""

HEAD = ("key", "value", "unit", "default", "meaning")
BOUNDS = {Ge: ("ge", "≥"), Gt: ("gt", ">"), Le: ("le", "≤"), Lt: ("lt", "<")}
WORDS = {float: "number", int: "whole number", str: "text", bool: "`true` or `false`"}

Part = type


def page() -> str:
    """Text of the page."""
    example = f"```toml\n{EXAMPLE.read_text('utf-8')}```"
    blocks = [INTRODUCTION, f"One such file is `examples/{EXAMPLE.name}`:", example]
    blocks += ["## The whole file", _keys(Scenario)]
    for part, (head, *others) in _heads(Scenario).items():
        blocks += [f"## `{head}`", prose(inspect.getdoc(part) or "")]
        blocks += [f"Likewise `{other}`." for other in others]
        blocks.append(_keys(part))
    blocks += ["## Not modelled", NOT_MODELLED, table(("not modelled", "instead"), _absences())]
    return "\n\n".join(blocks)


def _absences() -> list[tuple[str, str]]:
    return [(_sentence(each.words), _sentence(each.instead)) for each in ABSENCES]


def _sentence(words: str) -> str:
    return f"{words[0].upper()}{words[1:]}."


def _heads(part: Part, path: str = "") -> dict[Part, list[str]]:
    """The heads of the tables of all parts below a part, the outer one first."""
    found: dict[Part, list[str]] = {}
    for name, field in fields_of(part).items():
        for inner in _parts_in(field.annotation):
            head = _head(f"{path}{field.alias or name}", field)
            found.setdefault(inner, []).append(head)
            for below, heads in _heads(inner, f"{head.strip('[]')}.").items():
                found.setdefault(below, []).extend(heads)
    return found


def _head(path: str, field: FieldInfo) -> str:
    """Head of the table at a path, as TOML writes it."""
    if _holds(field, tuple):
        return f"[[{path}]]"
    return f"[{path}.NAME]" if _holds(field, dict) else f"[{path}]"


def _holds(field: FieldInfo, container: type) -> bool:
    """Whether the field is such a container, or may be."""
    choices = (field.annotation, *get_args(field.annotation))
    return any(get_origin(choice) is container for choice in choices)


def _parts_in(annotation: Any) -> list[Part]:
    """The parts of a scenario inside an annotation such as ``tuple[Station, ...]``."""
    if isinstance(annotation, type) and fields_of(annotation):
        return [annotation]
    return [part for inner in get_args(annotation) for part in _parts_in(inner)]


def _keys(part: Part) -> str:
    """Table of a part's keys."""
    return table(HEAD, [_row(part, name) for name in fields_of(part)])


def _row(part: Part, name: str) -> tuple[str, ...]:
    field = fields_of(part)[name]
    key = field.alias or name
    parts = _parts_in(field.annotation)
    meaning = field.description or (inspect.getdoc(parts[0]) or "" if parts else "")
    return (
        f"`{key}`",
        _value(field),
        label(f"_{key}"),
        _default(part, name),
        prose(meaning.split("\n\n")[0]),
    )


def _value(field: FieldInfo) -> str:
    """What may be written: its kind, range, choices, library names."""
    words = _words(field.annotation, field.metadata)
    kind = _library_kind(field)
    if kind is None:
        return words
    names = ", ".join(code(entry) for entry in library.entries(kind))
    choices = f"library name ({names})"
    return f"{choices}, or a {words}" if _parts_in(field.annotation) else choices


def _words(annotation: Any, metadata: Iterable[Any] = ()) -> str:
    """What an annotation admits, in words."""
    inner = get_args(annotation)
    if isinstance(annotation, type) and fields_of(annotation):
        return f"[table](#{anchor(_heads(Scenario)[annotation][0])})"
    if annotation in WORDS:
        words = ", ".join(filter(None, (WORDS[annotation], range_of(metadata))))
        return f"{words}, or a time of the clock" if OrClock() in metadata else words
    if get_origin(annotation) is Literal:
        return " or ".join(code(choice) for choice in inner)
    if get_origin(annotation) is tuple:
        return f"list: {_words(inner[0])}"
    if get_origin(annotation) is Annotated:
        return _words(inner[0], [*inner[1:], *metadata])
    if get_origin(annotation) is dict:
        return _words(inner[1])
    alternatives = [_words(each, metadata) for each in inner if each is not type(None)]
    return " or ".join(dict.fromkeys(filter(None, alternatives)))


def range_of(metadata: Iterable[Any]) -> str:
    """Range of a number, as ``0.1 to 10`` or ``> 0, ≤ 5``."""
    found: dict[type, float] = {}
    for item in metadata:
        for bound in item.metadata if isinstance(item, FieldInfo) else [item]:
            if type(bound) in BOUNDS:
                found[type(bound)] = getattr(bound, BOUNDS[type(bound)][0])
    if set(found) == {Ge, Le}:
        return f"{found[Ge]:,.10g} to {found[Le]:,.10g}"
    return ", ".join(f"{BOUNDS[kind][1]} {bound:,.10g}" for kind, bound in found.items())


def _default(part: Part, name: str) -> str:
    field = fields_of(part)[name]
    written = DEFAULTS.get(f"{part.__name__}.{name}")
    if written is not None:
        return written
    for key, (kind, whose) in GIVEN.items():
        if key in fields_of(part) and name in _keys_of_every_entry(kind):
            return whose
    if field.is_required():
        return "**required**"
    return "" if field.default in (None, (), "") else code(field.default)


def _keys_of_every_entry(kind: str) -> set[str]:
    return set.intersection(*(set(entry) for entry in library.entries(kind).values()))


def _library_kind(field: FieldInfo) -> str | None:
    """Kind of library entries all of whose names a key accepts, if any; of several the largest."""
    adapter = TypeAdapter(Annotated[field.annotation, Field(), *field.metadata])
    if _admits(adapter, "no-such-entry"):
        return None
    admitted = [
        kind for kind in KINDS if all(_admits(adapter, name) for name in library.entries(kind))
    ]
    return max(admitted, key=lambda kind: len(library.entries(kind)), default=None)


def _admits(adapter: TypeAdapter[Any], value: str) -> bool:
    try:
        adapter.validate_python(value)
    except ValidationError:
        return False
    return True
