"""Trains of a run that can be drawn."""

import numpy as np

from tpss.errors import ResultError
from tpss.results.result import Result


class NothingToDrawError(ResultError):
    """A valid result holds nothing that a figure could show."""


def seen_trains(result: Result) -> list[str]:
    """Names of the trains that were on the line for a step at least."""
    data = result.dataset
    seen = np.isfinite(data.pantograph_voltage.to_numpy()).any(axis=0)
    return [str(name) for name in data.train.to_numpy()[seen]]


def chosen_train(result: Result, train: str | None = None) -> str:
    """Name of the train to draw; the studied one, or the first on the line, by default.

    Raises a `ResultError` if it was not on the line, a `NothingToDrawError` if none was.
    """
    names = seen_trains(result)
    if not names:
        raise NothingToDrawError("no train was on the line")
    if train is None:
        studied = result.summary["studied_train"]
        return str(studied) if studied in names else names[0]
    if train not in names:
        raise ResultError(f"there is no train {train!r} on the line; trains: {', '.join(names)}")
    return train
