"""Where the voltage is low: stretches of line in which trains were below a lower limit.

References
----------
[EN50163]_
"""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from tpss.results.standards.voltage_limits import Excursion, bounds
from tpss.scenario.standards import VoltageLimits

JOINED_KM = 1.0
"""Stretches that are no further apart are one. [km]"""

MOST_NAMES = 10
"""Highest number of trains that are named."""


class LowVoltagePlace(NamedTuple):
    """A stretch of line in which trains were below a limit."""

    limit: str
    limit_kv: float
    line: str
    from_km: float
    to_km: float
    lowest_kv: float
    lowest_km: float
    lowest_min: float
    from_min: float
    to_min: float
    duration_min: float
    train_count: int
    trains: str


def find_low_voltage_places(
    excursions: Iterable[Excursion], limits: VoltageLimits
) -> list[LowVoltagePlace]:
    """Stretches of line below each lower limit, the graver limit first, then along the line.

    Parameters
    ----------
    excursions : iterable of Excursion
        As of `find_excursions`.
    limits : VoltageLimits
    """
    listed = list(excursions)
    return [
        _place(group)
        for bound in bounds(limits)
        if bound.side == "below"
        for line in sorted({each.line for each in listed})
        for group in _stretches([e for e in listed if (e.limit, e.line) == (bound.name, line)])
    ]


def _ends_km(excursion: Excursion) -> tuple[float, float]:
    """Where an excursion lies on the line, whichever way its train ran. [km]"""
    ends = excursion.from_km, excursion.to_km
    return min(ends), max(ends)


def _stretches(excursions: Sequence[Excursion]) -> Iterator[list[Excursion]]:
    """Excursions that touch or overlap each other along the line."""
    group: list[Excursion] = []
    upto_km = 0.0
    for each in sorted(excursions, key=_ends_km):
        begin_km, end_km = _ends_km(each)
        if group and begin_km > upto_km + JOINED_KM:
            yield group
            group = []
        upto_km = max(upto_km, end_km) if group else end_km
        group.append(each)
    if group:
        yield group


def _place(group: Sequence[Excursion]) -> LowVoltagePlace:
    worst = min(group, key=lambda each: each.extreme_kv)
    names = list(dict.fromkeys(each.train for each in sorted(group, key=lambda e: e.from_min)))
    more = len(names) - MOST_NAMES
    return LowVoltagePlace(
        limit=worst.limit,
        limit_kv=worst.limit_kv,
        line=worst.line,
        from_km=min(_ends_km(each)[0] for each in group),
        to_km=max(_ends_km(each)[1] for each in group),
        lowest_kv=worst.extreme_kv,
        lowest_km=worst.extreme_km,
        lowest_min=worst.extreme_min,
        from_min=min(each.from_min for each in group),
        to_min=max(each.to_min for each in group),
        duration_min=_covered_min(group),
        train_count=len(names),
        trains=", ".join(names[:MOST_NAMES]) + (f" and {more} more" if more > 0 else ""),
    )


def _covered_min(group: Sequence[Excursion]) -> float:
    """Time in which at least one train was below the limit. [min]"""
    total = upto = 0.0
    for begin, end in sorted((each.from_min, each.to_min) for each in group):
        total += max(0.0, end - max(begin, upto))
        upto = max(upto, end)
    return total
