"""The approximator itself: predictions with intervals, inside its domain."""

from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd

from tpss.approximator.calibrate import deviation
from tpss.approximator.model_file import (
    ModelFile,
    check_target,
    read_model,
    text_of_model,
    write_bytes,
)
from tpss.approximator.network import Array, Ensemble, logistic
from tpss.approximator.scales import unscaled
from tpss.errors import Finding, ScenarioError

COLLAPSE = "collapse_probability"

LIKELY = 0.5
"""Probability of a collapse from which on no other figures are given: there are none."""

MOST_TOLD = 10
"""Rows outside the domain that are told in words."""


class Approximator:
    """An approximator of what simulations lead to.

    `tpss.train_approximator` makes one, `load_approximator` reads one.
    """

    def __init__(self, file: ModelFile) -> None:
        self.file = file

    @property
    def members(self) -> int:
        """Networks of the ensemble."""
        return self._figures.size

    @property
    def neurons(self) -> str:
        """Neurons of a network, in words."""
        of_collapse = "" if self._collapse is None else f" and {self._collapse.neurons}"
        told = f"{self._figures.neurons} neurons for the figures"
        return f"{told}{of_collapse} for the collapse" if of_collapse else told

    @cached_property
    def _figures(self) -> Ensemble:
        return self.file.figures.ensemble()

    @cached_property
    def _noise(self) -> Ensemble:
        return self.file.noise.ensemble()

    @cached_property
    def _collapse(self) -> Ensemble | None:
        return None if self.file.collapse is None else self.file.collapse.ensemble()

    def predict(
        self,
        inputs: Mapping[str, Sequence[Any] | Any] | pd.DataFrame,
        outside: Literal["refuse", "flag"] = "refuse",
        place: str = "inputs",
    ) -> pd.DataFrame:
        """Figures of lines that were not simulated.

        Parameters
        ----------
        inputs : mapping of str to sequence, or DataFrame
            A column for each input, all of the same length.
        outside : str
            What becomes of rows outside the trained region: the call is refused, or the column
            ``outside`` says why they are.
        place : str
            Where the inputs come from, for the words of an error.

        Returns
        -------
        DataFrame
            For each output its value and the ends of its 90 % interval, ``NAME``, ``NAME.low`` and
            ``NAME.high``, in the output's unit; NaN where the line more likely than not does not
            carry its load.  ``collapse_probability`` is the probability of that, with the lowest
            and the highest one of the ensemble's members; it is missing if no trained line
            collapsed.  ``outside`` is empty within the trained region.

        Raises
        ------
        ScenarioError
            An input is unknown, missing or no number, or lies outside the trained region.
        """
        columns = {str(name): values for name, values in inputs.items()}
        given = self.file.inputs.read(columns, place)
        objections = self.file.domain.objections(given, self.file.inputs)
        if outside == "refuse":
            _refuse(objections, place)
        x = self.file.inputs.encode(given.inputs)
        figures, collapse = self.figures(x), self.collapse(x)
        if collapse:
            carried = collapse[COLLAPSE] < LIKELY
            figures = {name: np.where(carried, each, np.nan) for name, each in figures.items()}
        return pd.DataFrame({**figures, **collapse, "outside": objections})

    def figures(self, x: Array) -> dict[str, Array]:
        """Outputs and the ends of their intervals, of scaled inputs, as if no line collapsed."""
        members = self._figures.evaluate(x)
        mean = members.mean(axis=0)
        log_noise = self._noise.evaluate(x).mean(axis=0)
        spread = members.std(axis=0)
        found = {}
        for k, output in enumerate(self.file.outputs):
            half = output.factor * deviation(log_noise[:, k], spread[:, k], output.usual)
            found[output.name] = unscaled(mean[:, k], output)
            found[f"{output.name}.low"] = unscaled(mean[:, k] - half, output)
            found[f"{output.name}.high"] = unscaled(mean[:, k] + half, output)
        return found

    def collapse(self, x: Array) -> dict[str, Array]:
        """Probability of a collapse, lowest and highest of the members, of scaled inputs."""
        if self._collapse is None:
            return {}
        members = logistic(self._collapse.evaluate(x)[:, :, 0])
        return {
            COLLAPSE: members.mean(axis=0),
            f"{COLLAPSE}.low": members.min(axis=0),
            f"{COLLAPSE}.high": members.max(axis=0),
        }

    def save(self, path: str | Path, *, force: bool = False) -> Path:
        """Write the approximator into a file (JSON).

        Raises
        ------
        ApproximatorError
            The file exists and may not be replaced, or cannot be written.
        """
        place = Path(path)
        check_target(place, force)
        write_bytes(place, text_of_model(self.file).encode())
        return place


def load_approximator(path: str | Path) -> Approximator:
    """Approximator of a file.  The file is data: nothing in it is ever run.

    Raises
    ------
    ApproximatorError, ScenarioError
        It cannot be read, is no such file, or is damaged.
    """
    return Approximator(read_model(Path(path)))


def _refuse(objections: list[str], place: str) -> None:
    told = [(row, words) for row, words in enumerate(objections) if words]
    if not told:
        return
    findings = []
    for row, words in told[:MOST_TOLD]:
        key = f"row {row + 1}" if len(objections) > 1 else ""
        problem = f"outside the trained region: {words}"
        remedy = "simulate it, train on a study that holds it, or predict it with a flag (--flag)"
        findings.append(Finding(place, key, "", problem, remedy))
    if len(told) > MOST_TOLD:
        rest = f"{len(told) - MOST_TOLD} more row(s) lie outside the trained region"
        findings.append(Finding(place, "", "", rest, "predict them with a flag (--flag)"))
    raise ScenarioError(findings)
