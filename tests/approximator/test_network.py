"""Ensembles beside a calculation by hand and beside scikit-learn."""

import numpy as np
import pytest
from sklearn.neural_network import MLPClassifier

from tpss.approximator.fit import ensemble_of, member_of
from tpss.approximator.network import BLOCK, Ensemble, logistic


def test_a_network_of_one_neuron_gives_what_the_hand_calculates():
    """0.5 + 0.6 · 1 + 0.2 · 0.5 + 2 tanh(0.1 + 0.3 · 1 - 0.4 · 0.5) = 1.2 + 2 · 0.197375 = 1.594751."""
    network = Ensemble(
        w0=np.array([[[0.6], [0.2]]]),
        w1=np.array([[[0.3], [-0.4]]]),
        b1=np.array([[0.1]]),
        w2=np.array([[[2.0]]]),
        b2=np.array([[0.5]]),
    )
    assert network.evaluate(np.array([[1.0, 0.5]])) == pytest.approx(1.594751, abs=1e-6)


def test_rows_do_not_depend_on_the_blocks_that_they_are_evaluated_in():
    draw = np.random.default_rng(0)
    shapes = ((3, 4, 2), (3, 4, 5), (3, 5), (3, 5, 2), (3, 2))
    network = Ensemble(*(draw.standard_normal(shape) for shape in shapes))
    x = draw.uniform(-1.0, 1.0, (2 * BLOCK + 7, 4))
    single = np.concatenate([network.evaluate(row[None]) for row in x], axis=1)
    # Products of matrices may be summed in another order, in single precision.
    assert network.evaluate(x) == pytest.approx(single, rel=0, abs=1e-5)


def test_probabilities_are_those_of_scikit_learn():
    """Both compute the logistic function of the same weights; rounding to single precision apart."""
    draw = np.random.default_rng(0)
    x = draw.uniform(-1.0, 1.0, (200, 2))
    network = MLPClassifier((4,), activation="tanh", solver="lbfgs", alpha=0.1, random_state=0)
    network.fit(x, x.sum(axis=1) > 0.2)
    found = logistic(ensemble_of([member_of(network)]).evaluate(x)[0, :, 0])
    assert found == pytest.approx(network.predict_proba(x)[:, 1], abs=1e-5)
