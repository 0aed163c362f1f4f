"""Voltages at the pantograph against the limits of EN 50163.

A train may be below Umin1 for two minutes without interruption, above Umax1 for five; never below
Umin2 or above Umax2.  Time is counted in time steps, as the voltage is one number a step.

References
----------
[EN50163]_
"""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import pandas as pd
import xarray as xr

from tpss.results.places import line_names, train_lines
from tpss.results.standards.windows import TOLERANCE, Floats, step_values
from tpss.results.tables import short_s, step_s
from tpss.scenario.standards import VoltageLimits

WITHIN = "within the limits"


class Bound(NamedTuple):
    """A limit of the voltage, and for how long a train may be beyond it."""

    name: str
    limit_kv: float
    side: str
    """Side of a violation: "below" or "above"."""
    allowed_min: float

    def is_beyond(self, voltage_v: Floats) -> npt.NDArray[np.bool_]:
        """Whether voltages are beyond the limit; those that are not numbers are not."""
        limit_v = 1e3 * self.limit_kv
        return voltage_v < limit_v if self.side == "below" else voltage_v > limit_v

    @property
    def rule(self) -> str:
        """What a violation is, in words."""
        longest = f" for more than {self.allowed_min:g} min" if self.allowed_min else ""
        return f"{self.side} {self.name}{longest}"


def bounds(limits: VoltageLimits) -> tuple[Bound, ...]:
    """The four limits, the absolute ones first."""
    return (
        Bound("Umin2", limits.umin2_kv, "below", 0.0),
        Bound("Umax2", limits.umax2_kv, "above", 0.0),
        Bound("Umin1", limits.umin1_kv, "below", limits.longest_low_min),
        Bound("Umax1", limits.umax1_kv, "above", limits.longest_high_min),
    )


class Excursion(NamedTuple):
    """An uninterrupted time in which a train was beyond a limit."""

    train: str
    limit: str
    limit_kv: float
    from_min: float
    to_min: float
    duration_min: float
    cut: bool
    """Whether the run began or ended in it, so that it may have been longer."""
    line: str
    """Where it was worst; places are those on this line."""
    from_km: float
    to_km: float
    extreme_kv: float
    extreme_km: float
    extreme_min: float
    allowed_min: float
    violation: bool

    @property
    def is_low(self) -> bool:
        """Whether the voltage was too low, not too high."""
        return self.extreme_kv < self.limit_kv


def find_excursions(dataset: xr.Dataset, limits: VoltageLimits) -> list[Excursion]:
    """All times in which a train was beyond a limit: how long, where, and how far."""
    return [each for bound in bounds(limits) for each in _of_bound(dataset, bound)]


def _of_bound(dataset: xr.Dataset, bound: Bound) -> Iterator[Excursion]:
    voltage, h = step_values(dataset, "pantograph_voltage"), step_s(dataset) / 60.0
    position_m, names = dataset.position.to_numpy(), dataset.train.to_numpy()
    on_line, lines = train_lines(dataset), line_names(dataset)
    for train, begin, end in _spells(bound.is_beyond(voltage)):
        within = voltage[begin:end, train]
        to_min = end * h - (short_s(dataset) / 60.0 if end == len(voltage) else 0.0)
        worst = begin + int(within.argmin() if bound.side == "below" else within.argmax())
        line = on_line[worst, train]
        first, *_, last = (i for i in (begin, *range(begin, end + 1)) if on_line[i, train] == line)
        yield Excursion(
            train=str(names[train]),
            limit=bound.name,
            limit_kv=bound.limit_kv,
            from_min=begin * h,
            to_min=to_min,
            duration_min=(end - begin) * h - (end * h - to_min),
            cut=begin == 0 or end == len(voltage),
            line=lines[line],
            from_km=float(position_m[first, train]) / 1e3,
            to_km=float(position_m[last, train]) / 1e3,
            extreme_kv=float(voltage[worst, train]) / 1e3,
            extreme_km=float(position_m[worst, train]) / 1e3,
            extreme_min=worst * h,
            allowed_min=bound.allowed_min,
            violation=_is_too_long(end - begin, bound, h),
        )


def _spells(beyond: npt.NDArray[np.bool_]) -> list[tuple[int, int, int]]:
    """Column, first row and row after the last of every unbroken run of true values."""
    if not beyond.any():  # as on most lines
        return []
    change = np.diff(np.pad(beyond, ((1, 1), (0, 0))).astype(np.int8), axis=0).T
    begins, ends = np.argwhere(change == 1), np.argwhere(change == -1)
    return [
        (train, begin, int(end[1]))
        for (train, begin), end in zip(begins.tolist(), ends, strict=True)
    ]


def _is_too_long(steps: int, bound: Bound, step_min: float) -> bool:
    return steps > bound.allowed_min / step_min + TOLERANCE


def voltage_table(
    dataset: xr.Dataset, excursions: Iterable[Excursion], limits: VoltageLimits
) -> pd.DataFrame:
    """One row per train: lowest and highest voltage, time beyond each limit, longest time, verdict."""
    voltage = step_values(dataset, "pantograph_voltage")
    known = np.isfinite(voltage)
    names = dataset.train.to_numpy()
    reasons: list[dict[str, None]] = [{} for _ in names]
    place = {str(name): i for i, name in enumerate(names)}
    times: dict[str, Floats] = {}
    for bound in bounds(limits):
        key = f"{bound.side}_{bound.name.lower()}_min"
        total = times[key] = np.zeros(len(names))
        longest = times[f"longest_{key}"] = np.zeros(len(names))
        for each in (each for each in excursions if each.limit == bound.name):
            i = place[each.train]
            total[i] += each.duration_min
            longest[i] = max(longest[i], each.duration_min)
            if each.violation:
                reasons[i][bound.rule] = None
    lowest = np.where(known, voltage, np.inf).min(axis=0, initial=np.inf)
    highest = np.where(known, voltage, -np.inf).max(axis=0, initial=-np.inf)
    seen = np.isfinite(lowest)
    verdict = ["; ".join(why) or WITHIN for why in reasons]
    return pd.DataFrame(
        {
            "train": names,
            "lowest_kv": np.where(seen, lowest, np.nan) / 1e3,
            "highest_kv": np.where(seen, highest, np.nan) / 1e3,
            **times,
            "verdict": np.where(seen, np.array(verdict, dtype=object), ""),
        }
    )
