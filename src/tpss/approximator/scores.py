"""How well an approximator predicts cases that it has not seen, next to simpler methods."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from tpss.approximator.approximator import COLLAPSE, LIKELY, Approximator
from tpss.approximator.model_file import CollapseScore, Score
from tpss.approximator.network import Array
from tpss.approximator.scales import scaled, unscaled

Flags = npt.NDArray[np.bool_]
Indices = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Cases:
    """Cases with their outputs."""

    x: Array
    """Scaled inputs, shape (cases, numbers)."""
    y: dict[str, Array]
    """Outputs in their units, shape (cases,); NaN where the line did not carry its load."""
    carried: Flags
    """Whether it did."""

    def of(self, rows: Indices) -> "Cases":
        """Some of the cases."""
        return Cases(self.x[rows], {k: v[rows] for k, v in self.y.items()}, self.carried[rows])


def unit_of_error(scale: str) -> Literal["%", ""]:
    """Errors of outputs with a logarithmic scale are relative."""
    return "%" if scale == "log" else ""


def errors_of(true: Array, predicted: Array, scale: str) -> Array:
    """Size of the errors, in % or in the output's unit."""
    size: Array = np.abs(predicted - true)
    return 100.0 * size / true if scale == "log" else size


def score_figures(
    approximator: Approximator, tested: Cases, simple: "Simple | None" = None
) -> tuple[Score, ...]:
    """Scores of all outputs, in cases in which the line carried its load."""
    cases = tested.of(np.flatnonzero(tested.carried))
    predicted = approximator.figures(cases.x)
    linear, nearest = (simple.linear(cases.x), simple.nearest(cases.x)) if simple else (None, None)
    scores = []
    for k, output in enumerate(approximator.file.outputs):
        name, scale, true = output.name, output.scale, cases.y[output.name]
        low, value, high = (predicted[key] for key in (f"{name}.low", name, f"{name}.high"))
        errors = errors_of(true, value, scale)
        half = errors_of(value, value + (high - low) / 2.0, scale)
        scores.append(
            Score(
                name=name,
                unit=unit_of_error(scale),
                median=_percentile(errors, 50),
                ninetieth=_percentile(errors, 90),
                coverage=float(np.mean((true >= low) & (true <= high))),
                half_width=_percentile(half, 50),
                linear_ninetieth=_ninetieth(true, linear, k, scale),
                nearest_ninetieth=_ninetieth(true, nearest, k, scale),
            )
        )
    return tuple(scores)


def _ninetieth(true: Array, simple: Array | None, k: int, scale: str) -> float | None:
    return None if simple is None else _percentile(errors_of(true, simple[:, k], scale), 90)


def score_collapse(
    approximator: Approximator, tested: Cases, simple: "Simple | None" = None
) -> CollapseScore | None:
    """Scores of the probability of a collapse."""
    prediction = approximator.collapse(tested.x)
    if not prediction:
        return None
    collapsed = ~tested.carried
    probability = prediction[COLLAPSE]

    def accuracy(predicted: Flags) -> float:
        return float(np.mean(predicted == collapsed))

    return CollapseScore(
        share=float(np.mean(collapsed)),
        accuracy=accuracy(probability >= LIKELY),
        brier=float(np.mean((probability - collapsed) ** 2)),
        linear_accuracy=accuracy(simple.linear_collapse(tested.x)) if simple else None,
        nearest_accuracy=accuracy(simple.nearest_collapse(tested.x)) if simple else None,
    )


def _percentile(values: Array, percent: float) -> float:
    return float(np.percentile(values, percent))


class Simple:
    """Simpler methods for the same cases: linear regression, and the nearest case."""

    def __init__(self, approximator: Approximator, trained: Cases) -> None:
        from sklearn.linear_model import LinearRegression, LogisticRegression
        from sklearn.neighbors import KNeighborsClassifier, KNeighborsRegressor

        carried = trained.of(np.flatnonzero(trained.carried))
        self._outputs = approximator.file.outputs
        y = np.column_stack([scaled(carried.y[each.name], each) for each in self._outputs])
        self._linear = LinearRegression().fit(carried.x, y)
        self._nearest = KNeighborsRegressor(1).fit(carried.x, y)
        if not trained.carried.all():
            self._line = LogisticRegression(C=1e3, max_iter=1000).fit(trained.x, ~trained.carried)
            self._neighbour = KNeighborsClassifier(1).fit(trained.x, ~trained.carried)

    def linear(self, x: Array) -> Array:
        """Outputs by linear regression, shape (cases, outputs)."""
        return self._plain(self._linear.predict(x))

    def nearest(self, x: Array) -> Array:
        """Outputs of the nearest trained case, shape (cases, outputs)."""
        return self._plain(self._nearest.predict(x))

    def linear_collapse(self, x: Array) -> Flags:
        """Whether the line collapses, by logistic regression."""
        return np.asarray(self._line.predict(x))

    def nearest_collapse(self, x: Array) -> Flags:
        """Whether the nearest trained case collapsed."""
        return np.asarray(self._neighbour.predict(x))

    def _plain(self, y: Array) -> Array:
        return np.column_stack([unscaled(y[:, k], each) for k, each in enumerate(self._outputs)])
