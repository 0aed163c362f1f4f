"""Trains that stand without power: where no station reaches the line, for how long."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import xarray as xr

from tpss.results.places import line_names, train_lines
from tpss.results.tables import step_s
from tpss.step.state import TrainState
from tpss.units import on_line


class Stranded(NamedTuple):
    """A train that stood without power."""

    train: str
    line: str
    """Line on which it stood; empty if there is one."""
    position_km: float
    from_min: float
    """When it came to stand, or lost its power standing."""
    duration_min: float
    """For how long, until it went on or the run ended."""
    to_the_end: bool

    @property
    def in_words(self) -> str:
        """Which, where, when."""
        end = "to the end" if self.to_the_end else f"for {self.duration_min:.1f} min"
        place = on_line(self.line, f"{self.position_km:.1f} km")
        return f"{self.train} near {place} from {self.from_min:.1f} min {end}"


def feed_themselves(dataset: xr.Dataset) -> npt.NDArray[np.bool_]:
    """Trains and steps in which a store on board has power for them, shape (steps, trains).

    At a stop that is one with any energy: a train without auxiliaries needs none.
    """
    if "train_storage_power" not in dataset:
        return np.zeros((dataset.sizes["time"] - 1, dataset.sizes["train"]), dtype=bool)
    gives = dataset.train_storage_power.to_numpy()[:-1] != 0.0
    has_some = dataset.train_stored_energy.to_numpy()[:-1] > 0.0
    dwells = dataset.train_state.to_numpy()[:-1] == TrainState.DWELLING
    return np.asarray(gives | (dwells & has_some))


def stranded_trains(dataset: xr.Dataset) -> list[Stranded]:
    """Each time that a train stood without power for a whole step or more."""
    volts, h = dataset.pantograph_voltage.to_numpy()[:-1], step_s(dataset) / 60.0
    if not (volts == 0.0).any():  # as in most runs
        return []
    position_km, names = dataset.position.to_numpy() / 1e3, dataset.train.to_numpy()
    lines, line_of = line_names(dataset), train_lines(dataset)
    stands = (volts == 0.0) & (position_km[1:] == position_km[:-1]) & ~feed_themselves(dataset)
    change = np.diff(np.pad(stands, ((1, 1), (0, 0))).astype(np.int8), axis=0).T
    begins, ends = np.argwhere(change == 1), np.argwhere(change == -1)
    return [
        Stranded(
            train=str(names[train]),
            line=lines[int(line_of[begin, train])],
            position_km=float(position_km[begin, train]),
            from_min=begin * h,
            duration_min=(end - begin) * h,
            to_the_end=end == len(stands),
        )
        for (train, begin), (_, end) in zip(begins.tolist(), ends.tolist(), strict=True)
    ]
