"""A row of a table of outages: what a run with one of them came to, in figures."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any

import numpy as np
import pandas as pd

from tpss.results.judged_rails import EN_50122
from tpss.results.result import Result
from tpss.results.standards.unbalance import GRID
from tpss.results.standards.windows import WINDOWS_MIN, highest_means, step_values
from tpss.results.stops import LATE_MIN
from tpss.results.stranded import stranded_trains
from tpss.results.tables import step_s

OVERLOAD_MIN = 3.0
"""Window over which the mean loading of a station is to be no more than its rating. [min]"""


class Verdict(IntEnum):
    """What a run came to, the gravest first."""

    AUDIT_FAILED = 0
    NO_SOLUTION = 1
    STALLED = 2
    DEADLOCKED = 3
    NOT_FED = 4
    STRANDED = 5
    VOLTAGE = 6
    USEFUL_VOLTAGE = 7
    TRIPPED = 8
    OVERLOAD = 9
    RAILS = 10
    UNBALANCE = 11
    KEPT = 12

    @property
    def words(self) -> str:
        """As it is printed."""
        return {
            Verdict.AUDIT_FAILED: "audit failed",
            Verdict.NO_SOLUTION: "did not solve",
            Verdict.STALLED: "train stalled",
            Verdict.DEADLOCKED: "trains deadlocked",
            Verdict.NOT_FED: "not fed, not run",
            Verdict.STRANDED: "trains stranded",
            Verdict.VOLTAGE: "voltage limit violated",
            Verdict.USEFUL_VOLTAGE: "useful voltage too low",
            Verdict.TRIPPED: "tripped",
            Verdict.OVERLOAD: "station overloaded",
            Verdict.RAILS: "limit of rails exceeded",
            Verdict.UNBALANCE: "grid unbalanced",
            Verdict.KEPT: "limits kept",
        }[self]


ENDINGS = {
    "collapsed": Verdict.NO_SOLUTION,
    "stalled": Verdict.STALLED,
    "deadlocked": Verdict.DEADLOCKED,
}

LOSSES, TRIPS = "converter_losses_mwh", "trips"
"""Figures that there are where converters say what they lose, and where equipment may trip."""

FIGURES = (
    "lowest_voltage_kv", "useful_voltage_kv", "train_useful_voltage_kv", "peak_loading",
    *(f"loading_{window:g}_min" for window in WINDOWS_MIN), "energy_mwh", LOSSES,
)  # fmt: skip
"""Figures that are compared with those of the intact supply."""


@dataclass(frozen=True)
class Row:
    """What a run came to.  A figure that there is not is NaN, a name of nothing is empty."""

    outage: str
    out: str
    """What is out, in words."""
    verdict: Verdict
    ended_min: float
    """When the run ended."""
    figures: Mapping[str, Any] = field(default_factory=dict)
    arrivals_min: Mapping[str, float] = field(default_factory=dict)
    """When the trains came to stand at their destinations that did, by name."""
    lost: Mapping[str, Any] = field(default_factory=dict)
    """How much later than with the intact supply trains arrived."""

    @property
    def verdict_in_words(self) -> str:
        """The verdict, and of a run that ended early the time at which it did."""
        ends = self.verdict in ENDINGS.values()
        return f"{self.verdict.words} at {self.ended_min:.2f} min" if ends else self.verdict.words

    @property
    def rank(self) -> tuple[int, float, str]:
        """What comes first: the graver verdict, then the lower mean useful voltage."""
        useful_kv = self.figures.get("useful_voltage_kv", math.nan)
        return self.verdict, math.inf if math.isnan(useful_kv) else useful_kv, self.outage


def row_of(outage: str, out: str, result: Result) -> Row:
    """Row of a run that has ended."""
    figures = {**_voltages(result), **_loadings(result)}
    figures["energy_mwh"] = result.summary["total_energy_mwh"]
    if (losses := result.figures.get("converter_losses")) is not None:
        figures[LOSSES] = losses["losses_mwh"]
    if result.scenario.protection.trip:
        figures[TRIPS] = trips_in_words(result.figures.get(TRIPS, []))
    figures["stranded"] = len({each.train for each in stranded_trains(result.dataset)})
    arrived = result.trips.dropna(subset=["arrival_min"])
    return Row(
        outage=outage,
        out=out,
        verdict=_verdict(result, figures),
        ended_min=float(result.summary["duration_min"]),
        figures=figures,
        arrivals_min=dict(zip(arrived.train, arrived.arrival_min, strict=True)),
    )


def _verdict(result: Result, figures: Mapping[str, Any]) -> Verdict:
    if not result.audit["passed"]:
        return Verdict.AUDIT_FAILED
    if figures["stranded"] and result.status != "collapsed":
        return Verdict.STRANDED
    if result.status in ENDINGS:
        return ENDINGS[result.status]
    violated = set(result.standards.violations.standard)
    if "EN 50163" in violated:
        return Verdict.VOLTAGE
    if "EN 50388" in violated:
        return Verdict.USEFUL_VOLTAGE
    if figures.get(TRIPS):
        return Verdict.TRIPPED
    loading = figures[f"loading_{OVERLOAD_MIN:g}_min"]
    if math.isnan(loading):  # a run that is shorter
        loading = figures["peak_loading"]
    if loading > 1.0:
        return Verdict.OVERLOAD
    if EN_50122 in violated:
        return Verdict.RAILS
    return Verdict.UNBALANCE if GRID in violated else Verdict.KEPT


def trips_in_words(trips: Sequence[Mapping[str, Any]]) -> str:
    """What tripped and when, in the order of time; empty if nothing did."""
    return ", ".join(f"{trip['element']} {trip['time_min']:.1f} min" for trip in trips)


def _voltages(result: Result) -> dict[str, Any]:
    """Lowest voltage of a train, lowest mean useful voltage of a zone and of a train."""
    lowest = result.summary["lowest_voltage"] or {}
    zones, trains = result.standards.useful_voltage_zones, result.standards.useful_voltage_trains
    zone, zone_kv = _least(zones.zone, zones.mean_useful_kv)
    train, train_kv = _least(trains.train, trains.mean_useful_kv.where(trains.counts))
    return {
        "lowest_voltage_kv": lowest.get("voltage_kv", math.nan),
        "lowest_voltage_train": lowest.get("train", ""),
        "lowest_voltage_line": lowest.get("line", ""),
        "lowest_voltage_km": lowest.get("position_km", math.nan),
        "lowest_voltage_min": lowest.get("time_min", math.nan),
        "useful_voltage_kv": zone_kv,
        "useful_voltage_zone": zone,
        "train_useful_voltage_kv": train_kv,
        "useful_voltage_train": train,
    }


def _least(names: "pd.Series[Any]", values: "pd.Series[Any]") -> tuple[str, float]:
    """The smallest value and its name; nothing and NaN if there is none."""
    numbers = values.to_numpy(dtype=float)
    if not np.isfinite(numbers).any():
        return "", math.nan
    least = int(np.nanargmin(numbers))
    return str(names.to_numpy()[least]), float(numbers[least])


def _loadings(result: Result) -> dict[str, Any]:
    """Highest loading of a station in a step, and its highest means over windows: which, and when."""
    data, step_min = result.dataset, step_s(result.dataset) / 60.0
    loading, names = step_values(data, "converter_loading"), data.station.to_numpy()
    widths = {"peak_loading": step_min} | {
        f"loading_{window_min:g}_min": window_min for window_min in WINDOWS_MIN
    }
    found: dict[str, Any] = {}
    for key, width_min in widths.items():
        highest, begin = highest_means(loading, width_min / step_min)
        known = bool(np.isfinite(highest).any())
        s = int(np.nanargmax(highest)) if known else 0
        found |= {
            key: float(highest[s]),
            f"{key}_station": str(names[s]) if known else "",
            f"{key}_from_min": float(begin[s]) * step_min,
        }
    return found


def lost_against(row: Row, intact: Row) -> dict[str, Any]:
    """What trains that arrived with the intact supply lost, and how many did not arrive."""
    lost_min = {
        train: row.arrivals_min[train] - arrival_min
        for train, arrival_min in intact.arrivals_min.items()
        if train in row.arrivals_min
    }
    worst = max(lost_min, key=lambda train: lost_min[train], default="")
    late = [train for train, minutes in lost_min.items() if minutes > LATE_MIN]
    return {
        "arrived": len(row.arrivals_min),
        "late": len(late),
        "missing": len(intact.arrivals_min) - len(lost_min),
        "lost_min": math.fsum(lost_min.values()),
        "most_lost_min": lost_min.get(worst, math.nan),
        "most_lost_train": worst,
    }
