"""Curves of trains that stand in files of their own: tractive effort and braking over speed."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tpss.errors import Finding, ScenarioError, alike_together
from tpss.scenario.profiles import demand_ascending
from tpss.tables.read import Table


@dataclass(frozen=True)
class CurveOfFile:
    """Lists of a curve, as in a scenario, and where their values came from.

    Attributes
    ----------
    table : Table
    lists : dict of str to list
    quantities : dict of str to str
        Quantities of the table by the keys of the lists.
    source : callable
        Row of the table of a value, by its key and its indices.
    """

    table: Table
    lists: dict[str, Any]
    quantities: dict[str, str]
    source: Callable[[str, Sequence[int]], int]

    @property
    def path(self) -> Path:
        """The file."""
        return self.table.path

    @property
    def notes(self) -> list[str]:
        """What is told of how the file was read."""
        return self.table.notes

    def place(self, key: str, indices: Sequence[int]) -> str:
        """Place in the file of a value, or of a list."""
        quantity = self.quantities.get(key, "")
        if not indices:
            column = self.table.header.columns.get(quantity)
            return f"column {column.heading!r}" if column else "header"
        return self.table.place(self.source(key, indices), quantity)


def effort_from(table: Table) -> CurveOfFile:
    """Tractive effort over speed, and over voltage if the table has a column of it.

    Raises
    ------
    ScenarioError
        The table has faults, or lacks a force at one of its speeds and voltages.
    """
    quantities = {"speed_kmh": "speed", "force_kn": "force", "voltage_kv": "voltage"}
    speeds, forces = table.numbers("speed"), table.numbers("force")
    if "voltage" not in table.values:
        demand_ascending(table, "speed")
        lists: dict[str, Any] = {"speed_kmh": speeds, "force_kn": forces}
        return CurveOfFile(table, lists, quantities, lambda _, indices: indices[0])
    if None in table.values["voltage"]:
        k = table.values["voltage"].index(None)
        remedy = "write the voltage of each row, or leave out the column"
        raise ScenarioError([table.fault(k, "voltage", "", "the cell is empty", remedy)])
    voltages = table.numbers("voltage")
    row_at = {point: k for k, point in enumerate(zip(voltages, speeds, strict=True))}
    of_voltage, of_speed = sorted(set(voltages)), sorted(set(speeds))
    if findings := alike_together(_faults_of_grid(table, row_at, of_voltage, of_speed)):
        raise ScenarioError(findings)
    if len(of_voltage) == 1:
        (u,) = of_voltage
        table.notes.append(f"{table.path.name}: of one voltage, {u:g} kV, and taken to hold at any")
        lists = {"speed_kmh": of_speed, "force_kn": [forces[row_at[u, v]] for v in of_speed]}
        return CurveOfFile(table, lists, quantities, lambda _, i: row_at[u, of_speed[i[0]]])
    lists = {
        "speed_kmh": of_speed,
        "voltage_kv": of_voltage,
        "force_kn": [[forces[row_at[u, v]] for v in of_speed] for u in of_voltage],
    }

    def source(key: str, indices: Sequence[int]) -> int:
        first = indices[0]
        if key == "speed_kmh":
            return row_at[of_voltage[0], of_speed[first]]
        second = indices[1] if len(indices) > 1 else 0
        return row_at[of_voltage[first], of_speed[second]]

    return CurveOfFile(table, lists, quantities, source)


def _faults_of_grid(
    table: Table,
    row_at: dict[tuple[float, float], int],
    of_voltage: Sequence[float],
    of_speed: Sequence[float],
) -> Iterator[Finding]:
    """Speeds and voltages that have no force, or several."""
    if len(row_at) < len(table):
        seen = set(row_at.values())
        k = next(k for k in range(len(table)) if k not in seen)
        problem = "another row has this speed and voltage"
        yield table.fault(k, "speed", f"{table.values['speed'][k]:g}", problem, "leave one out")
    for u in of_voltage:
        for v in of_speed:
            if (u, v) not in row_at:
                k = next(row for (voltage, _), row in row_at.items() if voltage == u)
                problem = f"no force at {v:g} km/h and {u:g} kV"
                remedy = "give each voltage the same speeds"
                yield table.fault(k, "voltage", f"{u:g}", problem, remedy)


def braking_from(table: Table) -> CurveOfFile:
    """Retardations by bands of speed, each from its row's speed on.

    Raises
    ------
    ScenarioError
        The table has faults; all are listed, those of one kind once.
    """
    demand_ascending(table, "speed")
    quantities = {"from_speed_kmh": "speed", "retardation_m_s2": "retardation"}
    lists = {key: table.numbers(quantity) for key, quantity in quantities.items()}
    return CurveOfFile(table, lists, quantities, lambda _, indices: indices[0])
