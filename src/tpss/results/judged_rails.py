"""Rails held against their limits: in lines of words, and as violations."""

import math
from collections.abc import Iterator
from functools import cached_property
from typing import Any

import pandas as pd
import xarray as xr

from tpss.results.rails import PERMANENT_S, rails, stray_current
from tpss.results.standards.violations import Violation
from tpss.scenario.rail_limits import RailLimits
from tpss.scenario.scenario import Scenario
from tpss.units import on_line

EN_50122 = "EN 50122"
"""Names the limits among those of the standards."""

MEANS = {"permanent_v": f"over {PERMANENT_S:g} s", "short_v": "in a second or a step"}
"""Words for the highest means of a place, the one that is held against the lower limit first."""


class JudgedRails:
    """Voltage of the rails and stray current of a run, and what is beyond its limit."""

    def __init__(self, dataset: xr.Dataset, scenario: Scenario) -> None:
        self._dataset, self._scenario = dataset, scenario

    @cached_property
    def voltages(self) -> pd.DataFrame:
        """As `rails.rails`."""
        return rails(self._dataset, self._scenario)

    @cached_property
    def stray_current(self) -> pd.DataFrame:
        """As `rails.stray_current`."""
        return stray_current(self._dataset, self._scenario)

    @property
    def limits(self) -> RailLimits:
        """Limits of the scenario, completed by those of its system."""
        return self._scenario.standards.rails.completed(self._scenario.supply.is_direct)

    @property
    def in_words(self) -> list[str]:
        """Lines about the rails of a run; none unless they are conductors of their own."""
        if not len(self.voltages):
            return []
        highest = [self._highest(column) for column in reversed(MEANS)]
        stray = [_stray_in_words(row, self.limits) for row in _rows(self.stray_current)]
        return [*(line for line in highest if line), *stray]

    def _highest(self, column: str) -> str:
        """The place with the highest mean, in a line; empty if the run is too short for one."""
        found = self.voltages.dropna(subset=[column])
        if not len(found):
            return ""
        row, limit_v = (
            _rows(found)[int(found[column].to_numpy().argmax())],
            _of(self.limits, column),
        )
        return (
            f"Rails to earth: at most {row[column]:.1f} V {MEANS[column]}, at {_place(row)} "
            f"(limit {limit_v:g} V){', beyond it' if row[column] > limit_v else ''}"
        )

    @property
    def violations(self) -> Iterator[Violation]:
        """Places and lines beyond a limit: voltages first, and of each kind the worst."""
        for column, words in MEANS.items():
            limit_v = _of(self.limits, column)
            beyond = self.voltages[self.voltages[column] > limit_v]
            for row in _rows(beyond.sort_values(column, ascending=False)):
                yield Violation(
                    EN_50122, "rail voltage", f"rails at {_place(row)}", limit_v / 1e3,
                    row[column] / 1e3, math.nan, math.nan, str(row.get("line", "")),
                    row["position_km"],
                    f"rails at {_place(row)}: {row[column]:.1f} V to earth {words}, "
                    f"above {limit_v:g} V",
                )  # fmt: skip
        limit = _of(self.limits, "stray_ma_per_m")
        beyond = self.stray_current[self.stray_current.leaving_ma_per_m > limit]
        for row in _rows(beyond.sort_values("leaving_ma_per_m", ascending=False)):
            where = f" of {row['line']}" if "line" in row else ""
            yield Violation(
                EN_50122, "stray current", f"rails{where}", math.nan, math.nan, math.nan, math.nan,
                str(row.get("line", "")), math.nan,
                f"rails{where}: {row['leaving_ma_per_m']:.2f} mA/m of track stray, above {limit:g} mA/m",
            )  # fmt: skip


def _stray_in_words(row: dict[str, Any], limits: RailLimits) -> str:
    where = f" of {row['line']}" if "line" in row else ""
    limit = _of(limits, "stray_ma_per_m")
    return (
        f"Stray current{where}: {row['leaving_a']:.2f} A as a mean, "
        f"{row['leaving_ma_per_m']:.2f} mA/m of track (limit {limit:g} mA/m)"
        f"{', beyond it' if row['leaving_ma_per_m'] > limit else ''}"
    )


def _of(limits: RailLimits, name: str) -> float:
    """A limit; infinite if there is none."""
    value = getattr(limits, name)
    return math.inf if value is None else float(value)


def _place(row: dict[str, Any]) -> str:
    return on_line(str(row.get("line", "")), f"{row['position_km']:.2f} km")


def _rows(table: pd.DataFrame) -> list[dict[str, Any]]:
    return [{str(key): value for key, value in row.items()} for row in table.to_dict("records")]
