"""Hand-worked network used below: one neuron, one input from 0 to 10 km/h, output from 0 to 100.

    w¹ = 1, b¹ = 0, w² = 0.5, b² = 0.25; at 10 km/h the scaled input is 1
    y = 0.5 · tanh(1) + 0.25 = 0.630797; output 0 + (0.630797 + 1)/2 · 100 = 81.5399

With the scaling folded in, per m/s: w'¹ = 2/10 · 3.6 = 0.72, b'¹ = -1, w'² = 50 · 0.5 = 25 and
b'² = 50 · (0.25 + 1) = 62.5.
"""

import math

import numpy as np
import pytest

from tpss.kernel import blank_records
from tpss.physics.neural_network import fold_scaling, logsig, network_record, outside, tansig

PRINTED = {
    "W1": [[1.0]],
    "b1": [0.0],
    "w2": [0.5],
    "b2": 0.25,
    "input_min": [0.0],
    "input_max": [10.0],
    "output_min": 0.0,
    "output_max": 100.0,
}


def test_scaling_folds_into_weights_and_biases():
    hidden, output_bias, trained = fold_scaling(PRINTED, [1 / 3.6])
    assert hidden[0] == pytest.approx([0.72, -1.0, 25.0])
    assert output_bias == pytest.approx(62.5)
    assert trained[0] == pytest.approx([0.0, 10 / 3.6])


def test_folded_network_gives_81_54_at_10_km_h(as_run):
    hidden, output_bias, _ = fold_scaling(PRINTED, [1 / 3.6])
    weight, bias, output_weight = hidden[0]
    output = output_bias + output_weight * as_run(tansig)(bias + weight * 10 / 3.6)
    assert output == pytest.approx(81.5399, abs=1e-4)


def test_ranges_that_do_not_begin_at_zero_fold_too():
    """12 kV of 10.5 to 16.5 kV scales to -0.5: y = 0.5 · tanh(-0.5) + 0.25 = 0.018941.

    In an output from 2 to 6 that lies at 2 + 4 · 1.018941/2 = 4.03788.
    """
    printed = PRINTED | {"input_min": [10.5], "input_max": [16.5]}
    printed |= {"output_min": 2.0, "output_max": 6.0}
    hidden, output_bias, _ = fold_scaling(printed, [1000.0])
    weight, bias, output_weight = hidden[0]
    output = output_bias + output_weight * math.tanh(bias + weight * 12_000.0)
    assert output == pytest.approx(4.03788, abs=1e-5)


@pytest.mark.parametrize("y", [-20.0, -1.0, 0.0, 0.3, 20.0])
def test_tansig_is_the_hyperbolic_tangent(as_run, y):
    assert as_run(tansig)(y) == pytest.approx(math.tanh(y), abs=1e-15)


@pytest.mark.parametrize(("y", "expected"), [(0.0, 0.5), (math.log(3.0), 0.75), (40.0, 1.0)])
def test_logsig_is_the_logistic_function(as_run, y, expected):
    assert as_run(logsig)(y) == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize(
    ("value", "extrapolates"), [(-0.1, True), (0.0, False), (5.0, False), (10.1, True)]
)
def test_training_range_includes_its_ends(as_run, value, extrapolates):
    network = blank_records(1, network_record(1, 1))
    network[0].trained[:] = np.array([[0.0, 10.0]])
    assert as_run(outside)(value, network[0], 0) == extrapolates
