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
"""Probability of a collapse from which no other figures are predicted: there are none."""

MOST_REPORTED = 10
"""Rows outside the domain that are reported one by one."""


class Approximator:
    """An approximator of simulation results.

    `tpss.train_approximator` trains one, `load_approximator` reads one.
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
        of_figures = f"{self._figures.neurons} neurons for the figures"
        return f"{of_figures}{of_collapse} for the collapse" if of_collapse else of_figures

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
            How rows outside the trained region are treated: with an error, or with the reasons in
            the column ``outside``.
        place : str
            Where the inputs come from, for error messages.

        Returns
        -------
        DataFrame
            For each output its value and the ends of its 90 % interval, ``NAME``, ``NAME.low`` and
            ``NAME.high``, in the output's unit; NaN where the line probably cannot
            carry its load.  ``collapse_probability`` is the probability of that, with the lowest and
            the highest one of the ensemble's members; it is missing if no trained line collapsed.
            ``outside`` is empty within the trained region.

        Raises
        ------
        ScenarioError
            An input is unknown, missing or not a number, or lies outside the trained region.
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
        figures = {}
        for k, output in enumerate(self.file.outputs):
            half = output.factor * deviation(log_noise[:, k], spread[:, k], output.usual)
            figures[output.name] = unscaled(mean[:, k], output)
            figures[f"{output.name}.low"] = unscaled(mean[:, k] - half, output)
            figures[f"{output.name}.high"] = unscaled(mean[:, k] + half, output)
        return figures

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
        It cannot be read, is not such a file, or is damaged.
    """
    return Approximator(read_model(Path(path)))


def _refuse(objections: list[str], place: str) -> None:
    refused = [(row, words) for row, words in enumerate(objections) if words]
    if not refused:
        return
    findings = []
    for row, words in refused[:MOST_REPORTED]:
        key = f"row {row + 1}" if len(objections) > 1 else ""
        problem = f"outside the trained region: {words}"
        remedy = (
            "simulate it, train on a study that includes it, or predict it with a flag (--flag)"
        )
        findings.append(Finding(place, key, "", problem, remedy))
    if len(refused) > MOST_REPORTED:
        rest = f"{len(refused) - MOST_REPORTED} more row(s) lie outside the trained region"
        findings.append(Finding(place, "", "", rest, "predict them with a flag (--flag)"))
    raise ScenarioError(findings)
