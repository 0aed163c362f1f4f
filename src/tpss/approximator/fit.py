"""Networks fitted to cases by scikit-learn, each member of an ensemble without a part of them.

scikit-learn because its networks are those of the thesis, trained by a quasi-Newton method (L-BFGS)
that suits their size; only their weights are kept.
"""

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.approximator.network import Array, Ensemble

FOLDS = 5
"""Parts of the cases, each left out by one member per round."""

ROUNDS = 2
"""How often the cases are divided: so many members have not seen a given case."""

MOST_STEPS = 800
"""Steps of L-BFGS; later ones change errors by less than the members differ."""

PENALTY = {"figures": 1e-1, "noise": 1.0, "collapse": 1e-1}
"""Weight of the squared weights in what is minimised (alpha of scikit-learn)."""

NEURONS = {"figures": (16, 32, 48), "noise": (4, 8), "collapse": (4, 8)}
"""Numbers of neurons that are tried."""

Tick = Callable[[], None]

Indices = npt.NDArray[np.int64]


VALUES_PER_WEIGHT = 5
"""Least number of output values for each weight of a network, unless it is the smallest one."""


def tried(kind: str, x: Array, y: Array) -> tuple[int, ...]:
    """Numbers of neurons that are tried: no more than the cases can determine."""
    weights = x.shape[1] + 1 + y.shape[1]  # of a neuron
    most = y.size // VALUES_PER_WEIGHT // weights
    smallest, *others = NEURONS[kind]
    return (smallest, *(neurons for neurons in others if neurons <= most))


def number_of_fits(kind: str, x: Array, y: Array) -> int:
    """How many networks are fitted for an ensemble."""
    return len(tried(kind, x, y)) * FOLDS + (ROUNDS - 1) * FOLDS


class Member(NamedTuple):
    """Weights of a network, by the names that `Ensemble` gives those of all."""

    w0: Array
    w1: Array
    b1: Array
    w2: Array
    b2: Array


@dataclass(frozen=True)
class Fitted:
    """An ensemble, and what its members predict for the cases that they have not seen."""

    ensemble: Ensemble
    unseen: Array
    """Mean over these members, shape (cases, outputs)."""
    spread: Array
    """Standard deviation over all members, shape (cases, outputs)."""
    errors: dict[int, float]
    """Root mean square error (or log loss) of unseen cases, by the number of neurons."""


def fit(kind: str, x: Array, y: Array, seed: int, tick: Tick) -> Fitted:
    """An ensemble of the number of neurons that predicts unseen cases best.

    Parameters
    ----------
    kind : str
        ``figures``: `y` are scaled outputs (cases, outputs); ``noise``: logarithms of the sizes of
        their errors; ``collapse``: 0 and 1, (cases, 1).
    """
    folds = _folds(kind, y, seed)
    first: dict[int, list[Member]] = {}
    errors: dict[int, float] = {}
    for neurons in tried(kind, x, y):
        first[neurons] = [_fit_one(kind, neurons, x, y, fold, seed, tick) for fold in folds]
        unseen = _unseen(ensemble_of(first[neurons]), x, folds)
        errors[neurons] = _error(kind, unseen, y)
    best = min(errors, key=errors.__getitem__)
    networks = list(first[best])
    for again in range(1, ROUNDS):
        left_out = _folds(kind, y, seed + again)
        networks += [_fit_one(kind, best, x, y, fold, seed + again, tick) for fold in left_out]
        folds += left_out
    ensemble = ensemble_of(networks)
    spread = ensemble.evaluate(x).std(axis=0)
    return Fitted(ensemble, _unseen(ensemble, x, folds), spread, errors)


def _folds(kind: str, y: Array, seed: int) -> list[Indices]:
    """Cases that each member leaves out; of both classes, if there are classes."""
    from sklearn.model_selection import KFold, StratifiedKFold

    division = StratifiedKFold if kind == "collapse" else KFold
    folds = division(FOLDS, shuffle=True, random_state=seed).split(y, y[:, 0])
    return [left_out for _, left_out in folds]


def _fit_one(
    kind: str, neurons: int, x: Array, y: Array, left_out: Indices, seed: int, tick: Tick
) -> Member:
    used = np.setdiff1d(np.arange(len(x)), left_out)
    random_state = seed * 1000 + int(left_out[0])
    if kind == "collapse":
        member = member_of(_trained(kind, neurons, x[used], y[used], random_state))
    else:
        member = _beside_line(kind, neurons, x[used], y[used], random_state)
    tick()
    return member


def _beside_line(kind: str, neurons: int, x: Array, y: Array, random_state: int) -> Member:
    """A network for the residual of linear regression, which gives its direct connections."""
    with_one = np.column_stack([x, np.ones(len(x))])
    line: Array = np.asarray(np.linalg.lstsq(with_one, y)[0], dtype=np.float64)
    left = y - with_one @ line
    middle, half = (left.max(axis=0) + left.min(axis=0)) / 2.0, np.ptp(left, axis=0) / 2.0
    half[half == 0.0] = 1.0
    rest = member_of(_trained(kind, neurons, x, (left - middle) / half, random_state))
    return rest._replace(w0=line[:-1], w2=rest.w2 * half, b2=rest.b2 * half + middle + line[-1])


def _trained(kind: str, neurons: int, x: Array, y: Array, random_state: int) -> Any:
    """A network of scikit-learn, fitted."""
    from sklearn.exceptions import ConvergenceWarning
    from sklearn.neural_network import MLPClassifier, MLPRegressor
    from threadpoolctl import threadpool_limits

    network = (MLPClassifier if kind == "collapse" else MLPRegressor)(
        hidden_layer_sizes=(neurons,),
        activation="tanh",
        solver="lbfgs",
        alpha=PENALTY[kind],
        max_iter=MOST_STEPS,
        max_fun=10 * MOST_STEPS,
        tol=1e-7,
        random_state=random_state,
    )
    # Threads cost more than they save on matrices of this size.
    with threadpool_limits(1), warnings.catch_warnings():
        warnings.simplefilter("ignore", ConvergenceWarning)  # stopping early is intended
        return network.fit(x, y if y.shape[1] > 1 else y[:, 0])


def member_of(network: Any) -> Member:
    """Weights of a network of scikit-learn, which has no direct connections."""
    (w1, w2), (b1, b2) = network.coefs_, network.intercepts_
    return Member(np.zeros((len(w1), len(b2))), w1, b1, w2, b2)


def ensemble_of(members: Sequence[Member]) -> Ensemble:
    """Ensemble of networks."""
    return Ensemble(*(np.array(parts) for parts in zip(*members, strict=True)))


def _unseen(ensemble: Ensemble, x: Array, folds: Sequence[Indices]) -> Array:
    """Mean of the predictions for the cases that the members have left out."""
    members = ensemble.evaluate(x)
    total, count = np.zeros(members.shape[1:]), np.zeros((len(x), 1))
    for member, left_out in zip(members, folds, strict=True):
        total[left_out] += member[left_out]
        count[left_out] += 1.0
    return total / count


def _error(kind: str, unseen: Array, y: Array) -> float:
    if kind != "collapse":
        return float(np.sqrt(np.mean((unseen - y) ** 2)))
    # Logarithm of the logistic function, without overflow.
    return float(np.mean(np.logaddexp(0.0, unseen) - y * unseen))
