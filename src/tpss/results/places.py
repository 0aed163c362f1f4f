"""Where trains, stations and nodes are: on which of a network's lines, and in words."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

LINE = "line"
"""Coordinate with the names of the lines; a dataset of one line has none."""

Indices = npt.NDArray[np.int64]


def line_names(dataset: xr.Dataset) -> list[str]:
    """Names of the lines; an empty one for a dataset of one line, which need not be named."""
    return [str(name) for name in dataset[LINE].to_numpy()] if LINE in dataset.coords else [""]


def train_lines(dataset: xr.Dataset) -> Indices:
    """Index of the line of each train at each instant, shape (time, train)."""
    if LINE not in dataset.coords:
        return np.zeros((dataset.sizes["time"], dataset.sizes["train"]), dtype=np.int64)
    return np.asarray(dataset.train_line.to_numpy(), dtype=np.int64)


TRACK = "train_track"
"""Variable with the tracks of the trains; a dataset of single-track lines has none."""


WAITS_FOR = "waits_for"
"""Variable with the indices of the trains that others wait for, where trains are kept apart."""

WITHOUT_POWER = "time_without_power"
"""Variable with the times of each step in which trains have their power off, with neutral sections."""


def train_tracks(dataset: xr.Dataset) -> Indices:
    """Track of each train at each instant, counted from 1, shape (time, train)."""
    if TRACK not in dataset:
        return np.ones((dataset.sizes["time"], dataset.sizes["train"]), dtype=np.int64)
    return np.asarray(dataset[TRACK].to_numpy(), dtype=np.int64)


def lines_of(dataset: xr.Dataset, what: str) -> Indices:
    """Index of the line of each ``station`` or ``node``."""
    if LINE not in dataset.coords:
        return np.zeros(dataset.sizes[what], dtype=np.int64)
    return np.asarray(dataset[f"{what}_line"].to_numpy(), dtype=np.int64)


def where_told(columns: dict[str, Any], names: Sequence[str]) -> dict[str, Any]:
    """Columns of a table with those that tell lines only where there are several."""
    several = names != [""]
    return {key: value for key, value in columns.items() if several or not key.endswith(LINE)}
