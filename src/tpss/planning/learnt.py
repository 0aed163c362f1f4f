"""What was learnt for the bounds of a plan: kept in memory, and in the folder of its cases."""

from collections.abc import Callable
from pathlib import Path

from tpss.approximator.approximator import Approximator, load_approximator
from tpss.planning.money import Array

APPROXIMATORS = "approximators"
"""Folder, within that of a plan, of its approximators."""


class Learnt:
    """Approximators by what they were trained on, so that none is trained twice, and their bounds."""

    def __init__(self, folder: Path | None = None) -> None:
        self._folder = folder
        self._bounds: dict[str, Array] = {}

    def approximator(self, digest: str, train: Callable[[], Approximator]) -> Approximator:
        """Approximator of a digest: from its file, or trained now, and kept there.

        Raises
        ------
        ApproximatorError, ScenarioError
            Its file is damaged, or cannot be written.
        """
        if self._folder is None:
            return train()
        place = self._folder / APPROXIMATORS / f"{digest}.json"
        if place.exists():
            return load_approximator(place)
        found = train()
        found.save(place)
        return found

    def bounds(self, digest: str, predict: Callable[[], Array]) -> Array:
        """Bounds of a digest, predicted once."""
        if digest not in self._bounds:
            self._bounds[digest] = predict()
        return self._bounds[digest]
