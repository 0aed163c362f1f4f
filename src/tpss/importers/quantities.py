"""Numbers with units in JSON files: read, checked and converted, all faults collected."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tpss.errors import Finding, ScenarioError, shortened
from tpss.importers.documents import read_json
from tpss.units import kilometres

Units = Mapping[str, float]
"""What one of each unit is in the unit that a scenario is written in."""

KM: Units = {"m": 1e-3, "km": 1.0}
KMH: Units = {"km/h": 1.0, "m/s": 3.6}
PERMILLE: Units = {"permil": 1.0, "‰": 1.0, "%": 10.0, "percent": 10.0}
TONNES: Units = {"kg": 1e-3, "t": 1.0}
KW: Units = {"W": 1e-3, "kW": 1.0, "MW": 1e3}
KN: Units = {"N": 1e-3, "kN": 1.0}
NEWTON: Units = {"N": 1.0, "kN": 1e3}
NEWTON_S_PER_M: Units = {
    "N/(m/s)": 1.0, "kN/(m/s)": 1e3, "N/(km/h)": 3.6, "kN/(km/h)": 3.6e3,
}  # fmt: skip
NEWTON_S2_PER_M2: Units = {
    "N/(m/s)^2": 1.0, "kN/(m/s)^2": 1e3, "N/(km/h)^2": 12.96, "kN/(km/h)^2": 12.96e3,
}  # fmt: skip
M_S2: Units = {"m/s^2": 1.0, "m/s²": 1.0}
SHARE: Units = {"-": 1.0, "%": 0.01}

DIGITS = 9
"""Decimals that are written: a micrometre of a line, without digits from rounding."""


class Quantities:
    """A JSON document of quantities by name, each with its unit, and what is wrong with them."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.findings: list[Finding] = []
        self.used: set[str] = set()
        """Names of the quantities that were read."""
        self.given: dict[str, str] = {}
        """Values by their keys as they stand in the file, each with its unit."""
        document = read_json(path)
        if not isinstance(document, dict):
            problem, remedy = "not a JSON object", "name a file of a track or of a train"
            raise ScenarioError([Finding(str(path), "", "", problem, remedy)])
        self.document: dict[str, Any] = document

    def __contains__(self, name: str) -> bool:
        return name in self.document

    def blame(self, key: str, value: object, problem: str, remedy: str) -> None:
        """Note a fault."""
        shown = "" if value is None else shortened(repr(value))
        self.findings.append(Finding(str(self.path), key, shown, problem, remedy))

    def unused(self) -> list[str]:
        """Names of the quantities in the document that were not read."""
        return [name for name in self.document if name not in self.used]

    def number(self, name: str, units: Units) -> float:
        """Value of ``{"unit": ..., "value": ...}``; NaN, with a finding, if it is at fault."""
        self.used.add(name)
        if name not in self:
            self.blame(name, None, "it is missing", "add it, with its unit and value")
            return math.nan
        entry = self._entry(name)
        scale = self._scale(f"{name}.unit", entry.get("unit"), units)
        return self._converted(f"{name}.value", entry.get("value"), scale)

    def column(self, name: str, units: Units) -> list[float]:
        """Values of ``{"unit": ..., "values": [...]}``."""
        self.used.add(name)
        entry = self._entry(name)
        scale = self._scale(f"{name}.unit", entry.get("unit"), units)
        rows = self._rows(name, entry)
        self.given[f"{name}.values"] = f"{rows!r} {scale[0]}"
        return [self._converted(f"{name}.values.{i}", value, scale) for i, value in enumerate(rows)]

    def pairs(self, name: str, columns: Mapping[str, Units]) -> list[tuple[float, ...]]:
        """Rows of ``{"units": {...}, "values": [[...], ...]}``, a value for each of the columns."""
        self.used.add(name)
        entry = self._entry(name)
        units = entry.get("units")
        units = units if isinstance(units, dict) else {}
        scales = [
            self._scale(f"{name}.units.{column}", units.get(column), known)
            for column, known in columns.items()
        ]
        rows: list[tuple[float, ...]] = []
        for i, row in enumerate(self._rows(name, entry)):
            key = f"{name}.values.{i}"
            if not isinstance(row, list) or len(row) != len(columns):
                self.blame(key, row, f"not a list of {', '.join(columns)}", "give these values")
                rows.append((math.nan,) * len(columns))
                continue
            rows.append(
                tuple(
                    self._converted(f"{key}.{k}", value, scale)
                    for k, (value, scale) in enumerate(zip(row, scales, strict=True))
                )
            )
        return rows

    def demand_ascending(self, name: str, values: Sequence[float]) -> None:
        """Note a fault if the values, positions of a quantity's rows, do not increase."""
        for i, (before, after) in enumerate(zip(values, values[1:], strict=False), 1):
            if after <= before:
                key = f"{name}.values.{i}"
                key = key if key in self.given else f"{key}.0"
                shown = f"{kilometres(after)} km follows {kilometres(before)} km"
                problem = f"the position does not increase: {shown}"
                remedy = "put the rows in ascending order"
                self.findings.append(Finding(str(self.path), key, self.given[key], problem, remedy))

    def _has_entry(self, key: str) -> bool:
        """Whether the quantity of a key is there; if not, that alone is its fault."""
        return isinstance(self.document.get(key.split(".")[0]), dict)

    def _entry(self, name: str) -> dict[str, Any]:
        entry = self.document.get(name)
        if isinstance(entry, dict):
            return entry
        problem = "it is missing" if entry is None else "not an object with unit and value"
        self.blame(name, entry, problem, "give it with its unit")
        return {}

    def _rows(self, name: str, entry: Mapping[str, Any]) -> list[Any]:
        rows = entry.get("values")
        if isinstance(rows, list) and rows:
            return rows
        if entry:
            self.blame(f"{name}.values", rows, "not a list with values", "give a list in brackets")
        return []

    def _scale(self, key: str, unit: object, units: Units) -> tuple[str, float]:
        """A unit, and what one of it is; NaN, with a finding, if it is at fault."""
        if isinstance(unit, str) and unit in units:
            return unit, units[unit]
        if self._has_entry(key):
            problem = "it is missing" if unit is None else "not a unit that is known here"
            self.blame(key, unit, problem, f"convert the values to one of {', '.join(units)}")
        return "", math.nan

    def _converted(self, key: str, value: object, scale: tuple[str, float]) -> float:
        unit, factor = scale
        self.given[key] = f"{value!r} {unit}".removesuffix(" -")
        if isinstance(value, bool) or not isinstance(value, int | float) or abs(value) > 1e300:
            if self._has_entry(key):
                self.blame(key, value, "not a number", "write a number, without quotes")
            return math.nan
        if not math.isfinite(value):
            self.blame(key, value, "not a finite number", "write a finite number")
        return round(float(value) * factor, DIGITS) if math.isfinite(factor) else math.nan
