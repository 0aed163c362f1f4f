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
"""Names of the parameters that a drawn gradient profile has."""


def parameters_of(study: Study) -> dict[str, Variation]:
    """What varies in a study, by the names of the table's columns."""
    found = dict(study.file.vary)
    for name, options in study.file.choices.items():
        found[name] = Variation(values=tuple(options))
    drawn = study.file.gradients
    if drawn is not None:
        found |= {MEAN: drawn.mean_permille, DEVIATION: drawn.standard_deviation_permille}
        if drawn.profile is not None:
            found[PROFILE] = drawn.profile
    return found


@dataclass(frozen=True)
class Design:
    """The cases of a study: each is known by its number alone."""

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
        """Combination of levels; those of the last parameter follow each other fastest."""
        found = {}
        for name, levels in reversed(list(zip(self.parameters, self._levels, strict=True))):
            case, place = divmod(case, len(levels))
            found[name] = levels[place]
        return {name: found[name] for name in self.parameters}

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
        A range of a grid does not say how many values it gives.
    """
    parameters = parameters_of(study)
    findings = [
        Finding(
            str(study.source),
            name if name in (MEAN, DEVIATION, PROFILE) else f"vary.{name}",
            f"{{ low = {parameter.low:g}, high = {parameter.high:g} }}",
            "a range in a grid that does not say how many values it gives",
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
