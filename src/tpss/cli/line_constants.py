"""The command ``tpss line-constants``: impedances and capacitances of a line from its geometry."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from tpss.cli.columns import Column
from tpss.cli.tables import print_table
from tpss.cli.terminal import Console, say, tell
from tpss.files.refusals import explained, refuse_to_replace
from tpss.files.whole import write_file
from tpss.units import label

if TYPE_CHECKING:
    import pandas as pd

    from tpss.conductors.constants import LineConstants
    from tpss.conductors.equivalents import Equivalent

ALIKE = 0.01
"""Tracks that differ by less, as a share, are told by their mean without a word. [1]"""

METHODS = {
    "carson": "Carson's full series",
    "clem": "the first terms of Carson's series",
    "deri": "a complex depth of return",
}


def print_line_constants(
    file: Path, frequency_hz: float | None, out: Path | None, force: bool
) -> None:
    """Print the line constants of a geometry, and write the catenary that stands for them if asked.

    Raises
    ------
    ScenarioError
        The geometry has faults.
    ResultError
        The file cannot be written.
    """
    from tpss.conductors.catenary import catenary_text
    from tpss.conductors.constants import line_constants
    from tpss.conductors.load import load_geometry

    found = line_constants(load_geometry(file), frequency_hz)
    if out is not None:
        refuse_to_replace(out, force, "a file", Path.is_file)
        text = catenary_text(found)
    console = Console()
    _print_conductors(found, console)
    _print_matrices(found, console)
    _print_equivalents(found, console)
    if out is not None:
        with explained(out):
            out.parent.mkdir(parents=True, exist_ok=True)
            write_file(out, text.encode())
        tell(f'Wrote {out}.  In a scenario:  supply.catenary = "{out.name}"')


def _print_conductors(found: "LineConstants", console: Console) -> None:
    geometry = found.geometry
    conditions = [geometry.source.name, "direct current"]
    if found.frequency_hz > 0.0:
        earth = f"earth of {geometry.earth_resistivity_ohm_m:g} Ω m"
        conditions[1:] = [f"{found.frequency_hz:g} Hz", earth, METHODS[geometry.method]]
    several = len(geometry.tracks) > 1
    rows: list[tuple[str, dict[str, Any]]] = []
    for each, z in zip(geometry.conductors, found.internal_impedance, strict=True):
        track = f" {each.track}" if several and each.group != "earth" else ""
        values = {"group": f"{each.group}{track}", "x_m": each.x_m, "height_m": each.mean_height_m}
        rows.append((each.name, values | {"r": 1e3 * z.real, "x": 1e3 * z.imag}))
    say(console, ", ".join(conditions))
    print_table("Conductors", "conductor", _CONDUCTORS, rows, console)


_CONDUCTORS = (
    Column("group", "group", "", 0),
    Column("x_m", "across", "m", 2),
    Column("height_m", "mean height", "m", 2),
    Column("r", "R within", "Ω/km", 4),
    Column("x", "X within", "Ω/km", 4),
)


def _print_matrices(found: "LineConstants", console: Console) -> None:
    _print_matrix("R", found.r_ohm_per_km, "r_ohm_per_km", 4, console)
    if found.frequency_hz > 0.0:
        _print_matrix("X", found.x_ohm_per_km, "x_ohm_per_km", 4, console)
        _print_matrix("B", found.b_us_per_km, "b_us_per_km", 3, console)


def _print_matrix(
    title: str, matrix: "pd.DataFrame", key: str, digits: int, console: Console
) -> None:
    columns = [Column(name, name, label(key), digits) for name in matrix.columns]
    rows = [(name, dict(matrix.loc[name])) for name in matrix.index]
    print_table(f"{title} of the groups", "group", columns, rows, console)


def _print_equivalents(found: "LineConstants", console: Console) -> None:
    from tpss.conductors.catenary import capacitance, chosen, in_common

    rows = [(each.meaning, _in_ohm_per_km(each)) for each in found.equivalents]
    title = "What stands for all of it, its return included"
    columns = [each for each in _EQUIVALENTS if each.key in rows[0][1]]
    print_table(title, "one conductor a track", columns, rows, console)
    taken = chosen(found)
    say(console, f"Taken for a catenary: {taken.meaning}")
    if found.frequency_hz > 0.0:
        say(console, f"Capacitance of a track to earth: {1e12 * capacitance(found):.2f} nF/km")
    if taken.spread > ALIKE:
        say(console, f"Tracks differ by up to {100 * taken.spread:.1f} % from their mean")
    for axis, value in in_common(taken).items():
        if value < 0.0:
            say(console, f"{axis.upper()} in common is negative, and left out of a catenary")


_EQUIVALENTS = (
    Column("r", "R", "Ω/km", 4),
    Column("x", "X", "Ω/km", 4),
    Column("mutual_r", "R in common", "Ω/km", 4),
    Column("mutual_x", "X in common", "Ω/km", 4),
)


def _in_ohm_per_km(each: "Equivalent") -> dict[str, float]:
    values = {"r": 1e3 * each.own.real, "x": 1e3 * each.own.imag}
    if each.mutual is None:
        return values
    return values | {"mutual_r": 1e3 * each.mutual.real, "mutual_x": 1e3 * each.mutual.imag}
