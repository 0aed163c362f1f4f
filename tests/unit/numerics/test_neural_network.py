"""Hand-worked network used below: one neuron, one input from 0 to 10 km/h, output from 0 to 100.

    w¹ = 1, b¹ = 0, w² = 0.5, b² = 0.25; at 10 km/h the scaled input is 1
    y = 0.5 · tanh(1) + 0.25 = 0.630797; output 0 + (0.630797 + 1)/2 · 100 = 81.5399

With the scaling folded in, per m/s: w'¹ = 2/10 · 3.6 = 0.72, b'¹ = -1, w'² = 50 · 0.5 = 25 and
b'² = 50 · (0.25 + 1) = 62.5; as a logsig network: 1.44, -2, 50 and 62.5 - 25 = 37.5.
"""

import math

import numpy as np
import pytest

from tpss.numerics.neural_network import (
    NEURONS,
    build_network,
    fold_scaling,
    logsig,
    outside,
    tansig_as_logsig,
    weigh,
)

PRINTED = {
    "transfer": "tansig",
    "W1": [[1.0]],
    "b1": [0.0],
    "w2": [0.5],
    "b2": 0.25,
    "input_min": [0.0],
    "input_max": [10.0],
    "output_min": 0.0,
    "output_max": 100.0,
}


def evaluate(as_run, network, value):
    """Output of a network of one input, by its kernels."""
    neurons = network.bias + network.weight[0] * value
    as_run(logsig)(neurons)
    return network.output_bias + as_run(weigh)(network.output, neurons)


def test_scaling_folds_into_weights_and_biases():
    weight, bias, output, output_bias, trained = fold_scaling(PRINTED, [1 / 3.6])
    assert (weight[0, 0], bias[0], output[0]) == pytest.approx((0.72, -1.0, 25.0))
    assert output_bias == pytest.approx(62.5)
    assert trained[0] == pytest.approx([0.0, 10 / 3.6])


def test_a_tansig_network_becomes_one_of_logsig():
    folded = fold_scaling(PRINTED, [1 / 3.6])[:4]
    weight, bias, output, output_bias = tansig_as_logsig(*folded)
    assert (weight[0, 0], bias[0], output[0]) == pytest.approx((1.44, -2.0, 50.0))
    assert output_bias == pytest.approx(37.5)


def test_network_gives_81_54_at_10_km_h(as_run):
    network = build_network(PRINTED, [1 / 3.6])
    assert evaluate(as_run, network, 10 / 3.6) == pytest.approx(81.5399, abs=1e-4)


def test_a_logsig_network_stays_as_it_is(as_run):
    """y = 0.5 · 0.731059 + 0.25 = 0.615529; output (0.615529 + 1)/2 · 100 = 80.7765."""
    network = build_network(PRINTED | {"transfer": "logsig"}, [1 / 3.6])
    assert evaluate(as_run, network, 10 / 3.6) == pytest.approx(80.7765, abs=1e-4)


def test_ranges_that_do_not_begin_at_zero_fold_too(as_run):
    """12 kV of 10.5 to 16.5 kV scales to -0.5: y = 0.5 · tanh(-0.5) + 0.25 = 0.018941.

    In an output from 2 to 6 that lies at 2 + 4 · 1.018941/2 = 4.03788.
    """
    printed = PRINTED | {"input_min": [10.5], "input_max": [16.5]}
    printed |= {"output_min": 2.0, "output_max": 6.0}
    network = build_network(printed, [1000.0])
    assert evaluate(as_run, network, 12_000.0) == pytest.approx(4.03788, abs=1e-5)


def test_logsig_is_the_logistic_function(as_run):
    """1 / (1 + e^-y): ½ at 0, ¾ at ln 3, 0 and 1 far out; NaN stays NaN."""
    neurons = np.zeros(NEURONS)
    neurons[:7] = [0.0, math.log(3.0), 40.0, -800.0, 800.0, math.inf, math.nan]
    as_run(logsig)(neurons)
    assert neurons[:6] == pytest.approx([0.5, 0.75, 1.0, 0.0, 1.0, 1.0], abs=1e-15)
    assert math.isnan(neurons[6])


def test_weigh_is_a_dot_product(as_run):
    weight, neurons = np.random.default_rng(1).normal(size=(2, NEURONS))
    assert as_run(weigh)(weight, neurons) == pytest.approx(weight @ neurons, rel=1e-12)


def test_surplus_neurons_weigh_nothing():
    network = build_network(PRINTED, [1 / 3.6])
    assert not network.output[1:].any()
    assert not network.taylor[:, 1:].any()


def test_bound_of_the_slope_is_met_where_the_neuron_is_at_its_middle():
    """d/dv 25 tanh(0.72 v - 1) is 25 · 0.72 = 18 where the argument is 0."""
    assert build_network(PRINTED, [1 / 3.6]).steepest[0] == pytest.approx(18.0)


@pytest.mark.parametrize(
    ("value", "extrapolates"), [(-0.1, True), (0.0, False), (2.7, False), (2.8, True)]
)
def test_training_range_includes_its_ends(as_run, value, extrapolates):
    assert as_run(outside)(value, build_network(PRINTED, [1 / 3.6]), 0) == extrapolates
