"""Samples of a long run to draw: fewer values, but always the lowest and the highest."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

MOST_OF_CURVES = 20_000
"""Values of all curves of a figure together."""

MOST_OF_A_CURVE = 2_000
"""Values of one curve: more than a screen has columns."""

MOST_OF_TRAINS = 50_000
"""Instants of all trains together, each with position, speed and voltage."""

FEWEST = 16
"""Values of a curve or train, however many there are."""


def kept(columns: Sequence[Floats], most: int) -> Indices:
    """Indices of the values to draw, about `most` of them.

    The values are cut into intervals of equal length; of each interval, the lowest and the highest of
    every column stay, and so do the first and the last value of all.

    Parameters
    ----------
    columns : sequence of Floats, each of shape (n,)
        What is drawn over the same axis; NaN where there is nothing.
    most : int
        Number of values above which some are left out.
    """
    count = len(columns[0])
    if count <= most:
        return np.arange(count)
    edges = np.linspace(0, count, max(1, (most - 2) // (2 * len(columns))) + 1).astype(int)
    stay = [0, count - 1]
    for column in columns:
        low = np.where(np.isnan(column), np.inf, column)
        high = np.where(np.isnan(column), -np.inf, column)
        for begin, end in zip(edges, edges[1:], strict=False):
            stay += [begin + int(low[begin:end].argmin()), begin + int(high[begin:end].argmax())]
    return np.unique(np.array(stay, dtype=np.int64))


def share(most: int, count: int) -> int:
    """Values that each of some curves may have."""
    return max(FEWEST, min(MOST_OF_A_CURVE, most // max(count, 1)))


@dataclass(frozen=True)
class TrainSamples:
    """Motion and voltage of every train at the instants that are drawn.

    Attributes
    ----------
    trains : list of dict
        For each train its ``name`` and, over the same instants, ``step`` (number of the time step),
        ``km``, ``kmh`` and ``kv``; the voltage is None where none is recorded, and all where a train
        is off the line for a while.
    thinned : bool
        Whether instants were left out.
    """

    trains: list[dict[str, Any]]
    thinned: bool


def sample_trains(
    dataset: xr.Dataset, most_of_all: int = MOST_OF_TRAINS, *, with_gaps: bool = False
) -> TrainSamples:
    """Samples of all trains of a run that were on the line, about `most_of_all` in total.

    Along a corridor, which a train may leave and come back to, these gaps may be kept.
    """
    km, kmh = dataset.position.to_numpy() / 1e3, dataset.speed.to_numpy() * 3.6
    kv = dataset.pantograph_voltage.to_numpy() / 1e3
    on_line = np.isfinite(km)
    seen = np.flatnonzero(on_line.any(axis=0))
    most = max(FEWEST, most_of_all // max(len(seen), 1))
    trains, thinned = [], False
    for i in seen:
        steps = np.flatnonzero(on_line[:, i])
        few = steps[kept((kmh[steps, i], kv[steps, i]), most)]
        thinned = thinned or len(few) < len(steps)
        if with_gaps:
            few = _with_gaps(few, steps)
        trains.append(
            {
                "name": str(dataset.train.to_numpy()[i]),
                "step": few.tolist(),
                "km": rounded(km[few, i], 3),
                "kmh": rounded(kmh[few, i], 1),
                "kv": rounded(kv[few, i], 3),
            }
        )
    return TrainSamples(trains, thinned)


def _with_gaps(few: Indices, steps: Indices) -> Indices:
    """Few of a train's steps, with the ends of each way, and one where it is away before the next."""
    ends = np.flatnonzero(np.diff(steps) > 1)
    return np.unique(np.concatenate([few, steps[ends], steps[ends] + 1, steps[ends + 1]]))


def rounded(values: Floats, digits: int) -> list[float | None]:
    """Values with so many decimals; None for NaN."""
    return [None if np.isnan(value) else round(value, digits) for value in values.tolist()]
