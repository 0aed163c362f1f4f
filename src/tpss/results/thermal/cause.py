"""Which trains made equipment hot: those that drew the most near it, in the time that counts."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from tpss.results.places import train_lines, train_tracks
from tpss.results.standards.windows import Floats, step_values
from tpss.results.thermal.elements import Element, Reach

MOST_NAMES = 3
"""Highest number of trains that are named."""

LEAST_SHARE = 0.05
"""Share of the power of the first one below which others are not."""


@dataclass(frozen=True)
class Traffic:
    """Trains of a run: where they are in each step, and what they draw. [m], [W], [var]"""

    names: Sequence[str]
    position_m: Floats
    active_w: Floats
    reactive_var: Floats
    line: np.ndarray
    track: np.ndarray
    instants_s: Floats

    @classmethod
    def of(cls, dataset: xr.Dataset) -> "Traffic":
        """Trains of a dataset."""
        return cls(
            [str(name) for name in dataset.train.to_numpy()],
            dataset.position.to_numpy()[:-1],
            step_values(dataset, "active_power"),
            step_values(dataset, "reactive_power"),
            train_lines(dataset)[:-1],
            train_tracks(dataset)[:-1],
            dataset.time.to_numpy(),
        )

    def cause(self, element: Element, from_s: float, to_s: float) -> str:
        """Trains that drew the most near a piece of equipment between two times, the first one first.

        Near it is as far as the next feeding points; where no train drew anything there, all others
        count.
        """
        if element.train >= 0:
            return self.names[element.train]
        lasts_s = np.diff(np.clip(self.instants_s, from_s, to_s))
        first, last = np.flatnonzero(lasts_s > 0.0)[[0, -1]]
        steps = slice(first, last + 1)
        power_va = np.nan_to_num(np.hypot(self.active_w[steps], self.reactive_var[steps]))
        lasts_s = lasts_s[steps]
        near = np.zeros(power_va.shape, dtype=bool)
        for reach in element.reach:
            near |= self._within(reach, steps)
        energy = lasts_s @ (power_va * near)
        if not energy.any():
            energy = lasts_s @ power_va
        order = np.argsort(-energy, kind="stable")[:MOST_NAMES]
        least = max(LEAST_SHARE * energy.max(initial=0.0), np.finfo(float).tiny)
        return ", ".join(self.names[i] for i in order if energy[i] >= least)

    def _within(self, reach: Reach, steps: slice) -> np.ndarray:
        """Whether trains are in a part of a line at the beginnings of steps."""
        at_m = self.position_m[steps]
        here = (at_m >= reach.from_m) & (at_m <= reach.to_m) & (self.line[steps] == reach.line)
        if reach.track is not None:
            here &= self.track[steps] == reach.track
        return np.asarray(here)
