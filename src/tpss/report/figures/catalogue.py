"""All figures by their names, with what stands above them."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from matplotlib.figure import Figure

from tpss.errors import ResultError, suggest
from tpss.report.figures.effort import effort
from tpss.report.figures.energy import energy_flow
from tpss.report.figures.journey import journey
from tpss.report.figures.stations import station_loading, station_powers
from tpss.report.figures.time_distance import time_distance
from tpss.report.figures.voltage import voltage_along_line, voltage_envelope
from tpss.report.palette import COLOURS
from tpss.report.style import as_text
from tpss.results.result import Result

Against = Literal["time", "distance"]


@dataclass(frozen=True)
class Wanted:
    """What is to be drawn, and of whom."""

    result: Result
    train: str | None
    against: Against

    @property
    def runs(self) -> dict[str, Result]:
        """The result as the only one of those to overlay."""
        return {"": self.result}


FIGURES: dict[str, Callable[[Wanted], Figure]] = {
    "time-distance": lambda wanted: time_distance(wanted.result),
    "journey": lambda wanted: journey(wanted.runs, wanted.train, _axis(wanted.against)),
    "voltage": lambda wanted: voltage_envelope(wanted.result),
    "train-voltage": lambda wanted: voltage_along_line(wanted.runs, wanted.train),
    "stations": lambda wanted: station_powers(wanted.runs),
    "converters": lambda wanted: station_loading(wanted.result),
    "energy": lambda wanted: energy_flow(wanted.result),
    "effort": lambda wanted: effort(wanted.result, wanted.train),
}
"""Figures by their names."""

OF_A_TRAIN = ("journey", "train-voltage", "effort")
OF_TRAINS = ("time-distance", *OF_A_TRAIN)
"""Figures that need trains on the line."""

ENDED = {
    "collapsed": "collapsed",
    "stalled": "ended by a stalled train",
    "interrupted": "interrupted",
}


class NothingToDrawError(ResultError):
    """A sound result holds nothing of what a figure shows."""


def draw(
    name: str, result: Result, train: str | None = None, against: Against = "distance"
) -> Figure:
    """Draw a figure with its title, which says too if the run ended early.

    Parameters
    ----------
    name : str
        One of `FIGURES`.
    result : Result
    train : str, optional
        The train of those of one train; the studied one, or the first on the line, by default.
    against : {"time", "distance"}
        What the horizontal axis of a journey carries.

    Raises
    ------
    ResultError
        The audit failed, or there is no such figure or train.
    NothingToDrawError
        No step was simulated, or no train was on the line.
    """
    demand_figure(name)
    if not result.audit["passed"]:
        raise ResultError(
            "the audit of the result failed, so its figures cannot be trusted and are not drawn: "
            + "; ".join(result.audit["failures"])
        )
    if result.dataset.sizes["time"] < 2:
        raise NothingToDrawError("no time step was simulated")
    chosen = None
    if train is not None or name in OF_TRAINS:
        chosen = chosen_train(result, train)
    figure = FIGURES[name](Wanted(result, chosen, against))
    title = result.scenario.name + (f": {as_text(chosen)}" if name in OF_A_TRAIN else "")
    figure.suptitle(title, fontsize="large")
    if result.status in ENDED:
        minutes = float(result.dataset.time[-1]) / 60.0
        figure.suptitle(
            f"{title}\n{ENDED[result.status]} at {minutes:.1f} min",
            fontsize="large",
            color=COLOURS[1],
            fontweight="bold",
        )
    return figure


def demand_figure(name: str) -> None:
    """Raise a `ResultError` if there is no figure of that name."""
    if name not in FIGURES:
        raise ResultError(f"there is no figure {name!r}; {suggest(name, [*FIGURES, 'all'])}")


def chosen_train(result: Result, train: str | None) -> str:
    """Name of the train to draw, which was on the line for a step at least.

    Raises
    ------
    ResultError
        There is no such train, or none at all.
    """
    data = result.dataset
    seen = np.isfinite(data.pantograph_voltage.to_numpy()).any(axis=0)
    names = [str(name) for name in data.train.to_numpy()[seen]]
    if not names:
        raise NothingToDrawError("no train was on the line")
    if train is None:
        studied = result.summary["studied_train"]
        return str(studied) if studied in names else names[0]
    if train not in names:
        raise ResultError(f"there is no train {train!r} on the line; trains: {', '.join(names)}")
    return train


def _axis(against: Against) -> Literal["position", "time"]:
    return "time" if against == "time" else "position"
