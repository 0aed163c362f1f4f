"""The density of a timetable: its trains at shorter or longer intervals, in the same hours.

A timetable that is denser by a factor ends as much earlier, and then begins again, until the departure
of its last train.  Each train takes as long as before, and its times count from its own departure.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from tpss.scenario.timetable import TimetabledTrain

DENSITY = "density"

SAME_MIN = 1e-9
"""Departures that differ by no more are at the same time. [min]"""


def density_of(table: Mapping[str, Any]) -> float:
    """Density of a timetable as it was written; what is wrong with it has a finding of its own."""
    density = table.get(DENSITY, 1.0)
    is_number = isinstance(density, int | float) and not isinstance(density, bool)
    return float(density) if is_number and density > 0.0 else 1.0


def at_density(trains: Sequence[TimetabledTrain], density: float) -> list[TimetabledTrain]:
    r"""Trains of a timetable that is denser by a factor; N trains become about as many times N.

    Train i of the n-th repetition, n = 0, 1, ..., departs at

    .. math:: t_{\mathrm{first}} + \frac{t_i - t_{\mathrm{first}} + n P}{\text{density}},
        \qquad P = \frac{N}{N - 1} (t_{\mathrm{last}} - t_{\mathrm{first}})

    unless that is later than the last departure.  Trains of repetitions are named after the first one:
    ``R101 again``, ``R101 again 2``.

    Parameters
    ----------
    trains : sequence of TimetabledTrain
    density : float
        Positive; 1 leaves them as they are.
    """
    departures_min = [train.entry["departure_min"] for train in trains]
    if density == 1.0 or not trains or max(departures_min) - min(departures_min) <= SAME_MIN:
        return list(trains)
    first_min, last_min = min(departures_min), max(departures_min)
    period_min = (last_min - first_min) * len(trains) / (len(trains) - 1)
    dense: list[TimetabledTrain] = []
    for again in range(math.ceil(density) + 1):
        for train, departure_min in zip(trains, departures_min, strict=True):
            since_min = (departure_min - first_min + again * period_min) / density
            if first_min + since_min <= last_min + SAME_MIN:
                dense.append(_moved(train, again, first_min + since_min))
    return dense


def _moved(train: TimetabledTrain, again: int, departure_min: float) -> TimetabledTrain:
    """A train that departs at another time, named after its repetition."""
    name = train.entry["name"]
    if again:
        name = f"{name} again" if again == 1 else f"{name} again {again}"
    return replace(train, entry={**train.entry, "name": name, "departure_min": departure_min})
