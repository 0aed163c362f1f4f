"""Profiles of a scenario that stand in files of their own: gradients, speed limits, stations, losses."""

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from tpss.errors import Finding, ScenarioError, alike_together
from tpss.tables.altitudes import gradients_of, smoothed
from tpss.tables.read import Table
from tpss.tables.stretches import Stretch, lowest_of
from tpss.units import kilometres

Row = dict[str, Any]


@dataclass(frozen=True)
class Profile:
    """Rows of a file, as in a scenario, and where they came from.

    Attributes
    ----------
    table : Table
    rows : list of dict
    source : list of int
        Row of the table that each came from.
    quantities : dict of str to str
        Quantities of the table by the keys of the rows.
    notes : list of str
        What is told of how the file was read.
    """

    table: Table
    rows: list[Row]
    source: list[int]
    quantities: dict[str, str]
    notes: list[str]

    @property
    def path(self) -> Path:
        """The file."""
        return self.table.path

    def place(self, row: int, key: str) -> str:
        """Place in the file of a row's value."""
        return self.table.place(self.source[row], self.quantities.get(key, ""))


def gradients_from(table: Table, smoothed_over_km: float | None = None) -> Profile:
    """Gradients of a table, derived from altitudes if it has those.

    Parameters
    ----------
    table : Table
    smoothed_over_km : float, optional
        Length over which altitudes are averaged first; None: they are taken as they are. [km]

    Raises
    ------
    ScenarioError
        The table has faults; all are listed, those of one kind once.
    """
    if "altitude" in table.values:
        return _derived(table, smoothed_over_km)
    demand_ascending(table, "position")
    if smoothed_over_km is not None:
        problem = "the file has gradients; altitudes are what is smoothed"
        remedy = "leave out gradients_smoothed_over_km, or give altitudes"
        raise ScenarioError([Finding(str(table.path), "", "", problem, remedy)])
    pairs = zip(table.numbers("position"), table.numbers("gradient"), strict=True)
    rows = [{"from_km": km, "permille": permille} for km, permille in pairs]
    quantities = {"from_km": "position", "permille": "gradient"}
    return Profile(table, rows, list(range(len(rows))), quantities, table.notes)


def _derived(table: Table, smoothed_over_km: float | None) -> Profile:
    """Gradients of a table of altitudes; its rows may be in falling kilometres."""
    _demand_several(table)
    positions_km, altitudes_m = table.numbers("position"), table.numbers("altitude")
    order, told = list(range(len(table))), "gradients derived from altitudes"
    if all(after < before for before, after in pairwise(positions_km)):
        order.reverse()
        positions_km.reverse()
        altitudes_m.reverse()
        told += " in falling kilometres, which were turned round"
    else:
        demand_ascending(table, "position")
    begins_km = positions_km
    if smoothed_over_km is not None:
        begins_km, altitudes_m = smoothed(positions_km, altitudes_m, smoothed_over_km)
        told += f", which are averaged over {kilometres(smoothed_over_km)} km"
    permille = gradients_of(begins_km, altitudes_m)
    rows = [{"from_km": km, "permille": each} for km, each in zip(begins_km, permille, strict=True)]
    source = [order[bisect_right(positions_km, km) - 1] for km in begins_km]
    notes = [*table.notes, f"{table.path.name}: {told}"]
    return Profile(table, rows, source, {"from_km": "position", "permille": "altitude"}, notes)


def _demand_several(table: Table) -> None:
    if len(table) < 2:
        problem, remedy = "a single altitude, which gives no gradient", "add rows"
        raise ScenarioError([table.fault(0, "altitude", "", problem, remedy)])


def limits_from(table: Table) -> Profile:
    """Speed limits of a table: each holds to the next one, or, if it has ends, to its end.

    Where several with ends overlap the lowest holds.

    Raises
    ------
    ScenarioError
        The table has faults; all are listed, those of one kind once.
    """
    quantities = {"from_km": "position", "speed_kmh": "speed_limit"}
    if "end" not in table.values:
        demand_ascending(table, "position")
        pairs = zip(table.numbers("position"), table.numbers("speed_limit"), strict=True)
        rows = [{"from_km": km, "speed_kmh": speed} for km, speed in pairs]
        return Profile(table, rows, list(range(len(rows))), quantities, table.notes)
    if findings := alike_together(_faults_of_ends(table)):
        raise ScenarioError(findings)
    begins, ends, speeds = (table.numbers(name) for name in ("position", "end", "speed_limit"))
    stretches = list(map(Stretch, begins, ends, speeds, range(len(begins))))
    found, gaps = lowest_of(stretches)
    if gaps:
        (begin, end), *more = gaps
        problem = f"no limit from {kilometres(begin)} to {kilometres(end)} km"
        problem += f", nor in {len(more)} more gaps" if more else ""
        remedy = "add a row for it, or one over the whole line: of several, the lowest holds"
        raise ScenarioError([Finding(str(table.path), "", "", problem, remedy)])
    notes = list(table.notes)
    if _overlap(stretches):
        notes.append(f"{table.path.name}: where limits overlap the lowest holds")
    rows = [{"from_km": each.begin_km, "speed_kmh": each.value} for each in found]
    return Profile(table, rows, [each.row for each in found], quantities, notes)


def _overlap(stretches: Sequence[Stretch]) -> bool:
    ordered = sorted(stretches)
    return any(after.begin_km < before.end_km for before, after in pairwise(ordered))


def _faults_of_ends(table: Table) -> Iterator[Finding]:
    for k, (begin, end) in enumerate(
        zip(table.values["position"], table.values["end"], strict=True)
    ):
        if end is None:
            yield table.fault(k, "end", "", "the cell is empty", "write where the limit ends")
        elif end <= begin:  # type: ignore[operator]  # numbers, as the table has no faults
            problem = f"the limit ends at {end:g} km, and begins at {begin:g} km"
            remedy = (
                "give the lower position as its beginning; both directions have rising kilometres"
            )
            yield table.fault(k, "end", f"{end:g}", problem, remedy)


def stations_from(table: Table) -> Profile:
    """Stations of a table."""
    quantities = {
        "name": "station",
        "position_km": "position",
        "tracks": "tracks",
        "track_length_m": "track_length",
    }
    rows = []
    for k in range(len(table)):
        given = {
            key: table.values[quantity][k]
            for key, quantity in quantities.items()
            if quantity in table.values and table.values[quantity][k] is not None
        }
        tracks = given.get("tracks")
        if isinstance(tracks, float) and tracks.is_integer():
            given["tracks"] = int(tracks)
        rows.append(given)
    return Profile(table, rows, list(range(len(rows))), quantities, table.notes)


def losses_from(table: Table) -> Profile:
    """Losses over the load, of a table.

    Raises
    ------
    ScenarioError
        The table has faults; all are listed, those of one kind once.
    """
    demand_ascending(table, "load")
    pairs = zip(table.numbers("load"), table.numbers("losses"), strict=True)
    rows = [{"load_percent": load, "loss_kw": loss} for load, loss in pairs]
    quantities = {"load_percent": "load", "loss_kw": "losses"}
    return Profile(table, rows, list(range(len(rows))), quantities, table.notes)


def demand_ascending(table: Table, quantity: str) -> None:
    """Refuse rows whose values of a quantity do not increase."""
    findings, what = [], quantity.replace("_", " ")
    for k, (before, after) in enumerate(pairwise(table.numbers(quantity)), 1):
        if after <= before:
            problem = f"the {what} does not increase: {after:g} follows {before:g}"
            remedy = f"put the rows in ascending order, each {what} once"
            findings.append(table.fault(k, quantity, f"{after:g}", problem, remedy))
    if findings:
        raise ScenarioError(alike_together(findings))
