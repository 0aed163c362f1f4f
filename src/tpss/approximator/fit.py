"""Networks fitted to cases by scikit-learn, each member of an ensemble without a part of them.

scikit-learn because its networks are those of the thesis, trained by a quasi-Newton method (L-BFGS)
that suits their size; only their weights are kept.
"""

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from tpss.approximator.network import Array, Ensemble

FOLDS = 5
"""Parts of the cases, each left out by one member a round."""

ROUNDS = 2
"""How often the cases are divided anew: so many members have not seen a given case."""

MOST_STEPS = 800
"""Steps of L-BFGS; what comes later moves errors by less than the members differ."""

PENALTY = {"figures": 1e-2, "noise": 1.0, "collapse": 1e-1}
"""Weight of the squared weights in what is minimised (alpha of scikit-learn)."""

NEURONS = {"figures": (16, 32, 48), "noise": (4, 8), "collapse": (4, 8)}
"""Numbers of neurons that are tried."""

Tick = Callable[[], None]

Indices = npt.NDArray[np.int64]


KNOWN_PER_WEIGHT = 5
"""Numbers that the cases tell for each weight of a network, at least, unless it is the smallest one."""


def tried(kind: str, x: Array, y: Array) -> tuple[int, ...]:
    """Numbers of neurons that are tried on cases: no more than these can teach."""
    weights = x.shape[1] + 1 + y.shape[1]  # of a neuron
    most = y.size // KNOWN_PER_WEIGHT // weights
    smallest, *others = NEURONS[kind]
    return (smallest, *(neurons for neurons in others if neurons <= most))


def fits_of(kind: str, x: Array, y: Array) -> int:
    """How many networks are fitted for an ensemble."""
    return len(tried(kind, x, y)) * FOLDS + (ROUNDS - 1) * FOLDS


@dataclass(frozen=True)
class Fitted:
    """An ensemble, and what its members say of the cases that they have not seen."""

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
    first: dict[int, list[Any]] = {}
    errors: dict[int, float] = {}
    for neurons in tried(kind, x, y):
        first[neurons] = [_fit_one(kind, neurons, x, y, fold, seed, tick) for fold in folds]
        unseen = _unseen(_ensemble(first[neurons]), x, folds)
        errors[neurons] = _error(kind, unseen, y)
    best = min(errors, key=errors.__getitem__)
    networks = list(first[best])
    for again in range(1, ROUNDS):
        left_out = _folds(kind, y, seed + again)
        networks += [_fit_one(kind, best, x, y, fold, seed + again, tick) for fold in left_out]
        folds += left_out
    ensemble = _ensemble(networks)
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
) -> Any:
    from sklearn.exceptions import ConvergenceWarning
    from sklearn.neural_network import MLPClassifier, MLPRegressor
    from threadpoolctl import threadpool_limits

    taken = np.setdiff1d(np.arange(len(x)), left_out)
    network = (MLPClassifier if kind == "collapse" else MLPRegressor)(
        hidden_layer_sizes=(neurons,),
        activation="tanh",
        solver="lbfgs",
        alpha=PENALTY[kind],
        max_iter=MOST_STEPS,
        max_fun=10 * MOST_STEPS,
        tol=1e-7,
        random_state=seed * 1000 + int(left_out[0]),
    )
    targets = y[taken] if y.shape[1] > 1 else y[taken, 0]
    # Threads cost more than they save on matrices of this size.
    with threadpool_limits(1), warnings.catch_warnings():
        warnings.simplefilter("ignore", ConvergenceWarning)  # to stop early is meant
        network.fit(x[taken], targets)
    tick()
    return network


def _ensemble(networks: Sequence[Any]) -> Ensemble:
    """Ensemble of the weights of scikit-learn's networks."""
    return Ensemble(
        w1=np.array([network.coefs_[0] for network in networks]),
        b1=np.array([network.intercepts_[0] for network in networks]),
        w2=np.array([network.coefs_[1] for network in networks]),
        b2=np.array([network.intercepts_[1] for network in networks]),
    )


def _unseen(ensemble: Ensemble, x: Array, folds: Sequence[Indices]) -> Array:
    """Mean of what the members say of the cases that they have left out."""
    members = ensemble.evaluate(x)
    total, count = np.zeros(members.shape[1:]), np.zeros((len(x), 1))
    for member, left_out in zip(members, folds, strict=True):
        total[left_out] += member[left_out]
        count[left_out] += 1.0
    return total / count


def _error(kind: str, unseen: Array, y: Array) -> float:
    if kind != "collapse":
        return float(np.sqrt(np.mean((unseen - y) ** 2)))
    # The logarithm of what the logistic function gives, without its overflow.
    return float(np.mean(np.logaddexp(0.0, unseen) - y * unseen))
