"""Hand-worked network used below: one neuron, one input from 0 to 10 km/h, output from 0 to 100.

    w¹ = 1, b¹ = 0, w² = 1, b² = 0; at 10 km/h the scaled input is 1
    y = tanh(1) = 0.761594; output 0 + (0.761594 + 1)/2 · 100 = 88.0797

With the scaling folded in, per m/s: w'¹ = 2/10 · 3.6 = 0.72, b'¹ = -1, w'² = 50, b'² = 50.
"""

import math

import numpy as np
import pytest

from tpss.kernel import blank_records
from tpss.physics.neural_network import fold_scaling, logsig, network_record, outside, tansig

PRINTED = {
    "W1": [[1.0]],
    "b1": [0.0],
    "w2": [1.0],
    "b2": 0.0,
    "input_min": [0.0],
    "input_max": [10.0],
    "output_min": 0.0,
    "output_max": 100.0,
}


def test_scaling_folds_into_weights_and_biases():
    hidden, output_bias, trained = fold_scaling(PRINTED, [1 / 3.6])
    assert hidden[0] == pytest.approx([0.72, -1.0, 50.0])
    assert output_bias == pytest.approx(50.0)
    assert trained[0] == pytest.approx([0.0, 10 / 3.6])


def test_folded_network_gives_88_08_at_10_km_h(as_run):
    hidden, output_bias, _ = fold_scaling(PRINTED, [1 / 3.6])
    weight, bias, output_weight = hidden[0]
    output = output_bias + output_weight * as_run(tansig)(bias + weight * 10 / 3.6)
    assert output == pytest.approx(88.0797, abs=1e-4)


def test_ranges_that_do_not_begin_at_zero_fold_too():
    """Input 10.5 to 16.5 kV: 12 kV scales to -0.5; output 2 to 6: y = tanh(-0.5) lies at 3.0758."""
    printed = PRINTED | {"input_min": [10.5], "input_max": [16.5]}
    printed |= {"output_min": 2.0, "output_max": 6.0}
    hidden, output_bias, _ = fold_scaling(printed, [1000.0])
    weight, bias, output_weight = hidden[0]
    output = output_bias + output_weight * math.tanh(bias + weight * 12_000.0)
    assert output == pytest.approx(2.0 + 4.0 * (math.tanh(-0.5) + 1.0) / 2.0)


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
