"""The command ``tpss library``: the data that ship with TPSS and one's own, with units and sources."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Any

import tomli_w
from rich import box
from rich.markup import escape
from rich.table import Table

from tpss import library, units
from tpss.cli.terminal import Console, print_in_parts, say, width_of
from tpss.errors import Finding, LibraryError, ScenarioError, suggest
from tpss.scenario.given_path import from_here
from tpss.scenario.own_library import OwnEntry, folder_in_use, own_entries

if TYPE_CHECKING:
    from tpss.scenario.fields import Part


@dataclass(frozen=True)
class Kind:
    """A kind of entries: what they are, and how a scenario uses one."""

    title: str
    module: str
    part: str
    """Part of a scenario, of `module`, that an entry gives the values of."""
    shown: tuple[str, ...]
    """Keys that a list shows."""
    place: str
    """Table of a scenario in which `key` takes the name of an entry."""
    key: str
    remark: str
    """How to change the values of the entry."""
    file: str = "scenario"
    """What sort of file that table stands in."""


OWN_TABLE = (
    "or a table of your own instead of the name, such as its values:\n\n{key} = {{ {values} }}"
)

KINDS = {
    "locomotives": Kind(
        "Trains: a locomotive with its wagons",
        "tpss.scenario.rolling_stock",
        "Train",
        ("mass_t", "adhesive_mass_t", "max_speed_kmh", "max_motor_current_a"),
        "[trains.freight]",
        "model",
        "and below the name any of its values that are to be changed",
    ),
    "catenaries": Kind(
        "Contact-line systems",
        "tpss.scenario.supply",
        "Catenary",
        ("r_ohm_per_km", "x_ohm_per_km", "capacitance_nf_per_km", "connection_r_ohm",
         "connection_x_ohm"),
        "[supply]",
        "catenary",
        OWN_TABLE,
    ),
    "contact_lines": Kind(
        "Contact lines and third rails of a direct current, of one track",
        "tpss.scenario.supply.direct_conductors",
        "DirectContactLine",
        ("r_ohm_per_km", "contact_wire_percent", "temperature_coefficient_per_k"),
        "[supply.catenary]",
        "contact_line",
        "with rails next to it; " + OWN_TABLE,
    ),
    "rails": Kind(
        "Running rails of a track, for a direct current",
        "tpss.scenario.supply.direct_conductors",
        "RunningRails",
        ("r_ohm_per_km", "temperature_coefficient_per_k"),
        "[supply.catenary]",
        "rails",
        "with contact_line next to it; " + OWN_TABLE,
    ),
    "converters": Kind(
        "Frequency converters",
        "tpss.scenario.supply",
        "ConverterType",
        ("rating_mva", "no_load_voltage_kv", "droop_kv_per_mvar"),
        "[[supply.converter_stations]]",
        "type",
        OWN_TABLE,
    ),
    "rectifiers": Kind(
        "Groups of rectifiers for direct current",
        "tpss.scenario.supply",
        "RectifierType",
        ("rated_current_a", "no_load_voltage_kv", "resistance_ohm"),
        "[[supply.rectifier_stations]]",
        "type",
        OWN_TABLE,
    ),
    "station_transformers": Kind(
        "Transformers of stations at a grid of the railway's frequency",
        "tpss.scenario.supply",
        "StationTransformer",
        ("rated_mva", "short_circuit_percent", "load_loss_kw", "no_load_loss_kw"),
        "[[supply.transformer_stations]]",
        "transformer",
        OWN_TABLE,
    ),
    "transformers": Kind(
        "Transformers between high-voltage line and contact line",
        "tpss.scenario.supply",
        "Transformer",
        ("r_ohm", "x_ohm"),
        "[supply.high_voltage_line]",
        "line_transformer",
        "and as station_transformer the one at the converter stations",
    ),
    "high_voltage_lines": Kind(
        "High-voltage lines beside the track",
        "tpss.scenario.supply",
        "LineType",
        ("r_ohm_per_km", "x_ohm_per_km"),
        "[supply.high_voltage_line]",
        "type",
        OWN_TABLE,
    ),
    "rail_limits": Kind(
        "Limits of the voltage of rails to earth, and of stray current",
        "tpss.scenario.rail_limits",
        "RailLimits",
        ("permanent_v", "short_v", "stray_ma_per_m"),
        "[standards]",
        "rails",
        "which is taken by itself for the current; " + OWN_TABLE,
    ),
    "voltage_limits": Kind(
        "Limits of the voltage at the pantograph",
        "tpss.scenario.standards",
        "VoltageLimits",
        ("umin2_kv", "umin1_kv", "un_kv", "umax1_kv", "umax2_kv", "mean_useful_kv"),
        "[supply]",
        "system",
        "whose limits judge the result; [standards.voltage_limits] may change any of these values",
    ),
    "systems": Kind(
        "Electrification systems",
        "tpss.scenario.supply",
        "System",
        ("nominal_kv", "frequency_hz", "base_kv", "base_mva"),
        "[supply]",
        "system",
        "with frequency_hz next to it for another frequency",
    ),
    "wires": Kind(
        "Wires, rails and cables, for tpss line-constants",
        "tpss.conductors.geometry",
        "Wire",
        ("r_ohm_per_km", "radius_mm", "gmr_mm", "temperature_coefficient_per_k"),
        "[[conductors]]",
        "wire",
        OWN_TABLE,
        "file of conductors",
    ),
}  # fmt: skip


def print_library(kind: str | None, name: str | None) -> None:
    """Print every kind, the entries of one, or one entry with all its values.

    Raises
    ------
    LibraryError
        There is no such kind or entry.
    """
    console = Console()
    if kind is None:
        for each in KINDS:
            _print_entries(each, console)
        _print_folder(console)
        say(console, "All values of an entry: tpss library KIND NAME")
        return
    kind = _known_kind(kind)
    entries = _entries(kind)
    if name is None:
        _print_entries(kind, console)
        _print_folder(console)
        say(console, f"All values of an entry: tpss library {kind} {next(iter(entries))}")
        return
    if name not in entries:
        remedy = suggest(name, entries)
        raise LibraryError(f"the library has no {name!r} in {kind}\n    -> {remedy}")
    _print_entry(kind, name, console)


def usage(kind: str, name: str) -> str:
    """Lines of a file that use an entry; none for limits of a system that no supply can have."""
    how = KINDS[kind]
    if how.key == "system" and name not in library.entries("systems"):
        return ""
    return f"{how.place}\n{tomli_w.dumps({how.key: name})}"


def _known_kind(kind: str) -> str:
    plain = kind.replace("-", "_")
    if plain in KINDS:
        return plain
    remedy = suggest(plain, KINDS)
    for each in KINDS:
        if kind in _entries(each):
            remedy = f"{kind} is one of the {each}: tpss library {each} {kind}"
    raise LibraryError(f"the library has no kind {kind!r}\n    -> {remedy}")


def _entries(kind: str) -> dict[str, dict[str, Any]]:
    """All entries of a kind by name, those of one's own library behind or in place of the shipped ones.

    Raises
    ------
    ScenarioError
        The library of one's own has faults, or keys that a scenario would refuse.
    """
    own = own_entries().get(kind, {})
    known = [field.alias or name for name, field in _part(kind).model_fields.items()]
    faults = [
        Finding(from_here(entry.file), f"{name}.{key}", "", "unknown key", suggest(key, known))
        for name, entry in own.items()
        for key in entry.values
        if key not in known
    ]
    if faults:
        raise ScenarioError(faults)
    sources = {name: {"source": _own_source(entry)} for name, entry in own.items()}
    return {**library.entries(kind), **{n: {**own[n].values, **sources[n]} for n in own}}


def _own_source(entry: OwnEntry) -> str:
    """File of an entry of one's own, the one that it starts from, and its source if it names one."""
    base = f", based on {entry.based_on}" if entry.based_on else ""
    return f"{from_here(entry.file)}{base}{f'; {entry.source}' if entry.source else ''}"


def _print_folder(console: Console) -> None:
    """Tell where entries come from, if they are not all shipped."""
    folder = folder_in_use()
    if folder is not None:
        say(
            console,
            f"Entries with a file are those of {from_here(folder)}; the others ship with TPSS.",
        )


def _part(kind: str) -> "type[Part]":
    how = KINDS[kind]
    part: type[Part] = getattr(import_module(how.module), how.part)
    return part


def _print_entries(kind: str, console: Console) -> None:
    how, entries = KINDS[kind], _entries(kind)
    console.print(f"\n[bold]{kind}[/bold]  {how.title}", highlight=False)
    is_wide = width_of(_values(entries, how.shown)) > console.width
    print_in_parts(how.shown, partial(_values, entries, broken=is_wide), console)
    sources = Table.grid(padding=(0, 2))
    for _ in ("name", "source"):
        sources.add_column(overflow="fold")
    for name, entry in entries.items():
        sources.add_row(f"  {escape(name)}:", escape(_source(entry)))
    console.print(sources)


def _values(
    entries: Mapping[str, Mapping[str, Any]], keys: Sequence[str], _: str = "", broken: bool = False
) -> Table:
    """Some values of entries; names and headings may be broken into their words."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
    end = "\n" if broken else " "
    table.add_column("name", no_wrap=True)
    for key in keys:
        heading = f"{units.words(key).replace(' ', end)}\n[dim]{units.label(key)}[/dim]"
        table.add_column(heading, no_wrap=True)
    for name, entry in entries.items():
        table.add_row(escape(name.replace(" ", end)), *(_value(entry.get(key)) for key in keys))
    return table


def _print_entry(kind: str, name: str, console: Console) -> None:
    how, entry = KINDS[kind], _entries(kind)[name]
    console.print(f"\n[bold]{escape(name)}[/bold]  {how.title}", highlight=False)
    console.print(_entry_table(kind, entry))
    say(console, f"Source: {_source(entry)}\n")
    used = usage(kind, name)
    if not used:
        say(console, "Supplies of this system cannot be described yet.")
        return
    say(console, f"In a {how.file}:\n\n{used}")
    say(console, how.remark.format(key=how.key, values=_in_a_line(_values_of(entry))))


def _values_of(entry: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in entry.items() if key != "source"}


def _in_a_line(table: dict[str, Any]) -> str:
    """What is between the braces of an inline table."""
    return ", ".join(
        f"{key} = {{ {_in_a_line(value)} }}"
        if isinstance(value, dict)
        else tomli_w.dumps({key: value}).strip()
        for key, value in table.items()
    )


def _entry_table(kind: str, entry: dict[str, Any]) -> Table:
    """All keys of an entry's part, those that it leaves at their default too."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
    for heading in ("key", "value", "unit", ""):
        is_text = heading in ("value", "")
        table.add_column(heading, no_wrap=not is_text, overflow="fold")
    for key, field in _part(kind).model_fields.items():
        if key != KINDS[kind].key:
            value = _value(entry[key]) if key in entry else f"[dim]{_value(field.default)}[/dim]"
            table.add_row(key, value, units.label(key), escape(field.description or ""))
    return table


def _value(value: Any) -> str:
    if isinstance(value, dict):
        return escape(_in_a_line(value))
    return "-" if value is None else escape(str(value))


def _source(entry: dict[str, Any]) -> str:
    """Source of an entry, its citations of the bibliography without their markup."""
    return str(entry["source"]).replace("]_", "]")
