"""Violations of limits, the worst first."""

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import pandas as pd

from tpss.results.standards.useful_voltage import MISSED
from tpss.results.standards.voltage_limits import Excursion, bounds
from tpss.scenario.standards import VoltageLimits
from tpss.units import on_line


class Violation(NamedTuple):
    """A violated limit: by which train or zone, how far, and in words."""

    standard: str
    rule: str
    subject: str
    limit_kv: float
    value_kv: float
    duration_min: float
    from_min: float
    line: str
    position_km: float
    words: str


def find_violations(
    excursions: Iterable[Excursion],
    zones: pd.DataFrame,
    trains: pd.DataFrame,
    limits: VoltageLimits,
) -> list[Violation]:
    """All violations, those of the gravest rule first, and within a rule the worst.

    Parameters
    ----------
    excursions : iterable of Excursion
        As of `find_excursions`.
    zones, trains : DataFrame
        As of `zone_table` and `train_table`.
    limits : VoltageLimits
    """
    listed = []
    grave = [each for each in excursions if each.violation]
    for bound in bounds(limits):
        sign = 1.0 if bound.side == "below" else -1.0
        own = sorted(
            (each for each in grave if each.limit == bound.name),
            key=lambda each: sign * each.extreme_kv,
        )
        listed += [
            Violation(
                "EN 50163", bound.rule, f"train {each.train}", each.limit_kv, each.extreme_kv,
                each.duration_min, each.from_min, each.line, each.extreme_km, excursion_in_words(each),
            )
            for each in own
        ]  # fmt: skip
    counts = trains.counts.to_numpy()
    return [
        *listed,
        *_too_low("zone", zones, np.ones(len(zones), dtype=bool)),
        *_too_low("train", trains, counts),
    ]


def _too_low(what: str, table: pd.DataFrame, counts: npt.NDArray[np.bool_]) -> Iterator[Violation]:
    """Zones or trains that count and whose mean useful voltage is below the minimum."""
    means, names = table.mean_useful_kv.to_numpy(), table[what].to_numpy()
    missed = np.flatnonzero((table.verdict.to_numpy() == MISSED) & counts)
    for i in missed[np.argsort(means[missed])]:
        subject, least_kv = f"{what} {names[i]}", float(table.minimum_kv.to_numpy()[i])
        words = f"{subject}: mean useful voltage {means[i]:.2f} kV, below {kilovolts(least_kv)}"
        yield Violation(
            "EN 50388", "mean useful voltage", subject, least_kv, float(means[i]),
            duration_min=math.nan, from_min=math.nan, line="", position_km=math.nan, words=words,
        )  # fmt: skip


def voltage_in_words(excursions: Sequence[Excursion], limits: VoltageLimits) -> str:
    """Sentence on excursions without a violation: the longest, or that there are none."""
    if not excursions:
        low, high = kilovolts(limits.umin1_kv), kilovolts(limits.umax1_kv)
        return f"no train below {low} or above {high}"
    longest = max(excursions, key=lambda each: each.duration_min)
    return f"{excursion_in_words(longest)}; {longest.allowed_min:g} min are allowed"


def excursion_in_words(excursion: Excursion) -> str:
    """An excursion, such as "train a: 4.5 min below 12.0 kV near km 82.0 (lowest ...)"."""
    side, extreme = ("below", "lowest") if excursion.is_low else ("above", "highest")
    least = "at least " if excursion.cut else ""
    place = on_line(excursion.line, f"km {excursion.extreme_km:.1f}")
    return (
        f"train {excursion.train}: {least}{minutes(excursion.duration_min)} {side} "
        f"{kilovolts(excursion.limit_kv)} near {place} "
        f"({extreme} {excursion.extreme_kv:.2f} kV at {excursion.extreme_min:.1f} min)"
    )


def kilovolts(value_kv: float) -> str:
    """A limit with as many decimals as it needs, one at least."""
    return f"{max(f'{value_kv:.1f}', f'{value_kv:g}', key=len)} kV"


def minutes(value_min: float) -> str:
    """A duration; a short one with two digits."""
    return f"{value_min:.1f} min" if value_min >= 1.0 else f"{value_min:.2g} min"
