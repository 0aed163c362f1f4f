"""Where trains stood as others were in their way: how long, and for whom."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from tpss.results.places import WAITS_FOR, line_names, train_lines
from tpss.results.standards.windows import table_of
from tpss.step.state import TrainState
from tpss.units import on_line

SHORTEST_S = 1.0
"""Shorter waits are none. [s]"""


class Wait(NamedTuple):
    """A time that a train stood because of another one."""

    train: str
    line: str
    position_km: float
    from_min: float
    to_min: float
    waited_min: float
    """Without its dwell, if it stood at a stop."""
    waited_for: str
    """The train that it waited for longest: one ahead of it, or that has to pass a gate first."""


def waits(dataset: xr.Dataset) -> pd.DataFrame:
    """One row per train and time that it stood beside its dwells; for runs with separation."""
    names, lines = dataset.train.to_numpy(), line_names(dataset)
    on_which = train_lines(dataset)
    rows = []
    for i, name in enumerate(names):
        for first, last in _stands(dataset, i):
            begin_s, end_s = (float(dataset.time[k]) for k in (first, last))
            waited_s = end_s - begin_s - _dwelled_s(dataset, i, begin_s, end_s)
            whom = _whom(dataset, i, first, last)
            if waited_s >= SHORTEST_S and (whom or WAITS_FOR not in dataset):
                rows.append(
                    Wait(
                        str(name),
                        lines[on_which[first, i]],
                        float(dataset.position[first, i]) / 1e3,
                        begin_s / 60.0,
                        end_s / 60.0,
                        waited_s / 60.0,
                        whom,
                    )
                )
    return table_of(rows, Wait)


def waits_in_words(waited: pd.DataFrame) -> list[str]:
    """How long trains waited for others, in a line; none where nobody did."""
    if len(waited) == 0:
        return []
    worst = waited.iloc[int(waited.waited_min.to_numpy().argmax())]
    place = on_line(worst.get("line", ""), f"{worst.position_km:.2f} km")
    whom = f" for {worst.waited_for}" if worst.waited_for else ""
    return [
        f"Trains stood {waited.waited_min.sum():.2f} min for others, most {worst.train} at {place}, "
        f"{worst.waited_min:.2f} min{whom}"
    ]


def _stands(dataset: xr.Dataset, i: int) -> Iterator[tuple[int, int]]:
    """First and last instants of the times that a train stands on the line."""
    state = dataset.train_state.to_numpy()[:, i]
    present = (state >= 0) & (state != TrainState.ARRIVED)
    stands = present & (dataset.speed.to_numpy()[:, i] == 0.0)
    edges = np.diff(np.concatenate([[0], stands.astype(np.int8), [0]]))
    for begin, end in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True):
        if end - 1 > begin:
            yield int(begin), int(end) - 1


def _dwelled_s(dataset: xr.Dataset, i: int, begin_s: float, end_s: float) -> float:
    """Time of the dwells of a train within a time. [s]"""
    arrived_s, left_s = (
        dataset[name].to_numpy()[i] for name in ("call_arrival_time", "call_departure_time")
    )
    left_s = np.where(np.isnan(left_s), np.inf, left_s)
    with np.errstate(invalid="ignore"):  # stops that it has not come to
        shared_s = np.minimum(left_s, end_s) - np.maximum(arrived_s, begin_s)
    return float(np.nansum(np.maximum(shared_s, 0.0)))


def _whom(dataset: xr.Dataset, i: int, first: int, last: int) -> str:
    """The train for which another one waited longest between two instants."""
    if WAITS_FOR not in dataset:  # written by an earlier version
        return ""
    whom = dataset[WAITS_FOR].to_numpy()[first : last + 1, i]
    found, steps = np.unique(whom[whom >= 0], return_counts=True)
    return str(dataset.train.to_numpy()[found[steps.argmax()]]) if found.size else ""
