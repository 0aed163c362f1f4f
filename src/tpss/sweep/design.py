"""Which values the parameters have in which case."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from tpss.errors import Finding, ScenarioError
from tpss.sweep.study import Study
from tpss.sweep.variation import Variation

MEAN, DEVIATION, PROFILE = (
    "gradients.mean_permille",
    "gradients.standard_deviation_permille",
    "gradients.profile",
)
DRAWN = (MEAN, DEVIATION, PROFILE)
"""Names of the parameters of a drawn gradient profile."""


def key_of(name: str, study: Study) -> str:
    """Key of a parameter in the study file."""
    if name in DRAWN:
        return name
    return f"choices.{name}" if name in study.file.choices else f"vary.{name}"


def parameters_of(study: Study) -> dict[str, Variation]:
    """What varies in a study, by the names of the table's columns."""
    parameters = dict(study.file.vary)
    for name, options in study.file.choices.items():
        parameters[name] = Variation(values=tuple(options))
    drawn = study.file.gradients
    if drawn is not None:
        parameters |= {MEAN: drawn.mean_permille, DEVIATION: drawn.standard_deviation_permille}
        if drawn.profile is not None:
            parameters[PROFILE] = drawn.profile
    return parameters


@dataclass(frozen=True)
class Design:
    """The cases of a study, identified by their numbers."""

    study: Study
    parameters: dict[str, Variation]

    @cached_property
    def cases(self) -> int:
        """Number of cases."""
        if self.study.file.cases is not None:
            return self.study.file.cases
        return int(np.prod([len(levels) for levels in self._levels], dtype=object))

    def values(self, case: int) -> dict[str, Any]:
        """Values of the parameters in a case."""
        if self.study.file.design == "grid":
            return self._combination(case)
        shares = self._points[case]
        return {
            name: parameter.at(float(share))
            for (name, parameter), share in zip(self.parameters.items(), shares, strict=True)
        }

    def ends(self) -> Iterator[tuple[str, dict[str, Any]]]:
        """Each end of each parameter, with its name, while all others stay at their first one."""
        first = {name: parameter.ends[0] for name, parameter in self.parameters.items()}
        for name, parameter in self.parameters.items():
            for value in parameter.ends:
                yield name, {**first, name: value}

    def _combination(self, case: int) -> dict[str, Any]:
        """Combination of levels; those of the last parameter vary fastest."""
        combination = {}
        for name, levels in reversed(list(zip(self.parameters, self._levels, strict=True))):
            case, place = divmod(case, len(levels))
            combination[name] = levels[place]
        return {name: combination[name] for name in self.parameters}

    @cached_property
    def _levels(self) -> list[list[Any]]:
        return [parameter.levels for parameter in self.parameters.values()]

    @cached_property
    def _points(self) -> npt.NDArray[np.float64]:
        """Points of the unit cube, shape (cases, parameters)."""
        from scipy.stats import qmc

        seed, dimensions = self.study.file.seed, len(self.parameters)
        if self.study.file.design == "latin-hypercube":
            return np.asarray(qmc.LatinHypercube(dimensions, rng=seed).random(self.cases))
        # A whole power of two, of which the first points are the same however many are taken.
        power = max(0, (self.cases - 1).bit_length())
        return np.asarray(qmc.Sobol(dimensions, rng=seed).random_base2(power))[: self.cases]


def design_of(study: Study) -> Design:
    """Design of a study.

    Raises
    ------
    ScenarioError
        A range of a grid has no number of values.
    """
    with study.named_as_given():
        return _design_of(study)


def _design_of(study: Study) -> Design:
    parameters = parameters_of(study)
    findings = [
        Finding(
            str(study.source),
            key_of(name, study),
            f"{{ low = {parameter.low:g}, high = {parameter.high:g} }}",
            "a range in a grid without a number of values",
            "add steps = 5, or list the values",
        )
        for name, parameter in parameters.items()
        if study.file.design == "grid"
        and parameter.low is not None
        and parameter.high is not None
        and parameter.steps is None
        and not parameter.whole
    ]
    if findings:
        raise ScenarioError(findings)
    return Design(study, parameters)
