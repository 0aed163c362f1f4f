"""A network along its voltage as a series, against the network itself, evaluated in long doubles."""

import math

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from tpss.numerics.neural_network import (
    EIGHTH_OVER_FIRST,
    LONGEST_MOVE,
    SERIES_INPUT,
    TAYLOR_TERMS,
)
from tpss.numerics.series import SCRATCH_SHAPE, Series, make_series, reaches, series_at
from vehicles import NETWORKS

EPS = np.finfo(float).eps

# Network, its two or three inputs, and the scale of a voltage.
POINTS = [
    *(("tractive_effort", (v / 3.6, u, i)) for v in (0, 40, 78, 130) for u in (11e3, 13.9e3, 16e3)
      for i in (500, 1250)),
    *(("bridge_sine", (e, u)) for e in (0.0, 200.0, 592.0, 770.0)
      for u in (360.0, 430.0, 445.0, 487.0, 530.0)),
]  # fmt: skip


def neuron_inputs(network, inputs):
    return network.bias + sum(network.weight[k] * value for k, value in enumerate(inputs))


def series_of(as_run, name, inputs):
    network, scratch, series = NETWORKS[name], np.zeros(SCRATCH_SHAPE), Series.blank(1)[0]
    scratch[0] = neuron_inputs(network, inputs)
    as_run(make_series)(inputs[SERIES_INPUT], network, scratch, series)
    return network, series


def exact(network, inputs):
    """The network's sum of logistic functions, without the rounding of doubles."""
    long = np.longdouble
    a = network.bias.astype(long)
    for k, value in enumerate(inputs):
        a = a + network.weight[k].astype(long) * long(value)
    return long(network.output_bias) + (network.output.astype(long) / (1 + np.exp(-a))).sum()


def rounding(network):
    """That of the network's own sum."""
    return EPS * np.abs(network.output).sum()


def derivatives_of_logsig(most):
    """Polynomials in s: f' = s(1 - s), and (d/dy) g(s) = g'(s) s(1 - s)."""
    first = Polynomial([0.0, 1.0, -1.0])
    each = [Polynomial([0.0, 1.0])]
    for _ in range(most):
        each.append(each[-1].deriv() * first)
    return each


@pytest.mark.parametrize(("name", "inputs"), POINTS)
def test_series_is_the_network_wherever_it_reaches(as_run, name, inputs):
    """The terms left out are below the network's rounding; evaluating either adds a few of these."""
    network, series = series_of(as_run, name, inputs)
    reach = series.reach_8**0.125
    for share in np.linspace(-0.999, 0.999, 21):
        at = inputs[SERIES_INPUT] + share * reach
        assert as_run(reaches)(at, series)
        given, _ = as_run(series_at)(at, series)
        there = exact(network, (inputs[0], at, *inputs[2:]))
        assert abs(given - there) <= 6.0 * rounding(network)


@pytest.mark.parametrize(("name", "inputs"), POINTS)
def test_slope_is_that_of_the_network(as_run, name, inputs):
    """Against f' = s(1 - s) of every neuron, at the centre and halfway to the end."""
    network, series = series_of(as_run, name, inputs)
    for share in (0.0, 0.5):
        at = inputs[SERIES_INPUT] + share * series.reach_8**0.125
        s = 1.0 / (1.0 + np.exp(-neuron_inputs(network, (inputs[0], at, *inputs[2:]))))
        expected = (network.output * network.weight[SERIES_INPUT] * s * (1.0 - s)).sum()
        scale = np.abs(network.output * network.weight[SERIES_INPUT]).sum()
        assert as_run(series_at)(at, series)[1] == pytest.approx(expected, abs=1e-12 * scale)


@pytest.mark.parametrize(("name", "inputs"), POINTS)
def test_coefficients_are_the_derivatives(as_run, name, inputs):
    network, series = series_of(as_run, name, inputs)
    s = 1.0 / (1.0 + np.exp(-neuron_inputs(network, inputs)))
    weight = network.weight[SERIES_INPUT]
    for k, derivative in enumerate(derivatives_of_logsig(TAYLOR_TERMS - 1)):
        factors = network.output * weight**k / math.factorial(k)
        expected = (factors * derivative(s)).sum() + (network.output_bias if k == 0 else 0.0)
        # The polynomials in s have coefficients up to 2e4, which cancel: 2e4 roundings are left.
        assert series.coefficient[k] == pytest.approx(expected, abs=1e-11 * np.abs(factors).sum())


def test_bound_of_the_eighth_derivative_holds():
    """|f⁽⁸⁾| ≤ 10.21 f' for any input, and comes as near as 0.1 %."""
    each = derivatives_of_logsig(TAYLOR_TERMS)
    s = np.linspace(1e-3, 1.0 - 1e-3, 100_001)
    worst = np.abs(each[8](s) / each[1](s)).max()
    assert 0.999 * EIGHTH_OVER_FIRST < worst <= EIGHTH_OVER_FIRST


@pytest.mark.parametrize(("name", "inputs"), POINTS)
def test_no_neuron_moves_further_than_the_proof_allows(as_run, name, inputs):
    network, series = series_of(as_run, name, inputs)
    reach = series.reach_8**0.125
    assert reach * np.abs(network.weight[SERIES_INPUT]).max() <= LONGEST_MOVE * (1.0 + 1e-12)


def test_a_series_that_has_not_been_made_reaches_nowhere(as_run):
    series = Series.blank(1)[0]
    assert not as_run(reaches)(0.0, series)
    assert not as_run(reaches)(math.nan, series)
