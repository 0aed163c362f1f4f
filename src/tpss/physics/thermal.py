r"""Temperatures of equipment that carries a load, of which one step gives the next exactly.

A load K is a current over the rated one, a thermal state θ a rise of the temperature over that of the
rated load, held for ever.  A body with one time constant τ follows

.. math:: \tau \dot\theta = K^2 - \theta .

A load that holds over a step moves the state there by an exponential, so no figure depends on the step
as long as the load does not.  These are plain functions of arrays: they judge a run that has ended.
"""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

S_PER_MIN = 60.0

NORMAL_HOT_SPOT_C = 98.0
"""Hot spot at which paper that is not thermally upgraded ages at its normal rate. [°C]"""

DOUBLES_PER_K = 6.0
"""Rise of the hot spot that doubles the rate of ageing. [K]"""

LARGEST_EXPONENT = 7.0
"""Time constants that are summed up at once: beyond, roundings would grow. [1]"""


class Cooling(NamedTuple):
    """Constants of a transformer in oil, by how it is cooled."""

    oil_rise_k: float
    """Rated rise of the top oil over the ambient. [K]"""
    hot_spot_rise_k: float
    """Rated rise of the hot spot over the top oil. [K]"""
    oil_s: float
    """Time constant of the oil, τ_o. [s]"""
    winding_s: float
    """Time constant of the winding, τ_w. [s]"""
    loss_ratio: float
    """Load losses at rated current over losses without load, R. [1]"""
    oil_exponent: float
    """x. [1]"""
    winding_exponent: float
    """y. [1]"""
    k11: float
    k21: float
    k22: float

    @property
    def rise_k(self) -> float:
        """Rated rise of the hot spot over the ambient, [IEC600767]_. [K]"""
        return self.oil_rise_k + self.hot_spot_rise_k

    @property
    def memory_s(self) -> float:
        """Time constant with which the top oil follows the load, k₁₁ τ_o, [IEC600767]_. [s]"""
        return self.k11 * self.oil_s


COOLING = {
    "ONAF": Cooling(52.0, 26.0, 150.0 * S_PER_MIN, 7.0 * S_PER_MIN, 6.0, 0.8, 1.3, 0.5, 2.0, 2.0),
    "ONAN": Cooling(55.0, 23.0, 180.0 * S_PER_MIN, 4.0 * S_PER_MIN, 5.0, 0.8, 1.6, 1.0, 1.0, 2.0),
}
"""A large power transformer with fans, and a distribution transformer without: constants of [IEC600767]_
as open implementations of it print them; check your edition."""


def follow(towards: Floats, lasts_s: Floats, time_constant_s: float, start: Floats) -> Floats:
    r"""States of first-order bodies at all instants, shape (steps + 1, bodies).

    .. math:: \theta_{k+1} = u_k + (\theta_k - u_k) e^{-h_k / \tau}

    Over a stretch of steps that begins at :math:`t_0` this is a sum, of which whole arrays are made at
    once,

    .. math::
        \theta_{k+1} = e^{-(t_{k+1} - t_0) / \tau} \left[ \theta_0
            + \sum_{i \le k} e^{(t_{i+1} - t_0) / \tau} (1 - e^{-h_i / \tau}) u_i \right] ,

    and stretches are so short that the growing exponential costs no more than three digits.

    Parameters
    ----------
    towards : Floats, shape (steps, bodies)
        Where each state tends to in a step, u: of a body with one time constant K². Any unit.
    lasts_s : Floats, shape (steps,)
        Length of each step, positive. [s]
    time_constant_s : float
        τ of all bodies, positive. [s]
    start : Floats, shape (bodies,)
        States at the first instant.

    References
    ----------
    [IEC60255149]_, the thermal replica of one time constant.
    """
    states = np.empty((len(lasts_s) + 1, len(start)))
    states[0] = start
    exponent = lasts_s / time_constant_s
    longest = float(exponent.max(initial=1e-9))
    stretch = max(1, int(LARGEST_EXPONENT / longest))
    for begin in range(0, len(lasts_s), stretch):
        part = slice(begin, begin + stretch)
        own = exponent[part]
        if len(own) == 1:  # of any length, such as of many time constants
            left = np.exp(-own)
            states[begin + 1] = towards[begin] + (states[begin] - towards[begin]) * left
            continue
        passed = np.cumsum(own)
        gains = np.exp(passed) * -np.expm1(-own)
        sums = np.cumsum(gains[:, None] * towards[part], axis=0)
        states[1:][part] = (states[begin] + sums) * np.exp(-passed)[:, None]
    return states


def time_to_rated_s(load: float, lasts_s: float) -> float:
    r"""Time constant of a body that a load brings from cold to its rated temperature in a time. [s]

    .. math:: 1 = K^2 (1 - e^{-t / \tau}) \quad\Rightarrow\quad \tau = -t / \ln(1 - K^{-2})

    Parameters
    ----------
    load : float
        K, above 1. [1]
    lasts_s : float
        t, positive. [s]

    References
    ----------
    [IEC60255149]_, the time to operate from the cold state, solved for its time constant.
    """
    return -lasts_s / math.log1p(-1.0 / (load * load))


def state_after(load: float, lasts_s: float, time_constant_s: float) -> float:
    r"""State of a body to which a load brings it in a time, from the rated one. [1]

    .. math:: \theta = K^2 - (K^2 - 1) e^{-t / \tau}

    Parameters
    ----------
    load : float
        K. [1]
    lasts_s, time_constant_s : float
        t and τ. [s]

    References
    ----------
    [IEC60255149]_, the thermal replica of one time constant.
    """
    square = load * load
    return square - (square - 1.0) * math.exp(-lasts_s / time_constant_s)


def hot_spot_rise(load: Floats, lasts_s: Floats, start: Floats, cooling: Cooling) -> Floats:
    r"""Rises of the hot spot of transformers over the ambient, shape (steps + 1, transformers). [K]

    The top oil follows the losses with k₁₁ τ_o. The hot spot is above it by the difference of two terms,
    of which the second, slower one makes it overshoot while the oil does not yet flow:

    .. math::
        \Delta\theta_o &\to \left(\frac{1 + R K^2}{1 + R}\right)^x \Delta\theta_{or}
            &\quad&\text{with } k_{11} \tau_o \\
        \Delta\theta_{h1} &\to k_{21} K^y \Delta\theta_{hr} &&\text{with } k_{22} \tau_w \\
        \Delta\theta_{h2} &\to (k_{21} - 1) K^y \Delta\theta_{hr} &&\text{with } \tau_o / k_{22} \\
        \Delta\theta &= \Delta\theta_o + \Delta\theta_{h1} - \Delta\theta_{h2}

    Parameters
    ----------
    load : Floats, shape (steps, transformers)
        K, not negative. [1]
    lasts_s : Floats, shape (steps,)
        Length of each step. [s]
    start : Floats, shape (transformers,)
        Load in whose steady state they begin. [1]
    cooling : Cooling

    References
    ----------
    [IEC600767]_, the differential equations of clause 8, here solved exactly over a step.
    """
    share = (1.0 + cooling.loss_ratio * np.vstack([start, load]) ** 2) / (1.0 + cooling.loss_ratio)
    oil_k = share**cooling.oil_exponent * cooling.oil_rise_k
    winding_k = np.vstack([start, load]) ** cooling.winding_exponent * cooling.hot_spot_rise_k
    slow_s = cooling.oil_s / cooling.k22
    terms = (
        (oil_k, cooling.memory_s),
        (cooling.k21 * winding_k, cooling.k22 * cooling.winding_s),
        ((cooling.k21 - 1.0) * winding_k, slow_s),
    )
    oil, fast, slow = (follow(to[1:], lasts_s, tau_s, to[0]) for to, tau_s in terms)
    return np.asarray(oil + fast - slow)


def ageing_rate(hot_spot_c: Floats) -> Floats:
    r"""Rate at which the paper of a winding ages, over the normal one, V. [1]

    .. math:: V = 2^{(\theta_h - 98) / 6}

    Parameters
    ----------
    hot_spot_c : Floats
        Temperature of the hot spot; above some 6200 °C the rate is infinite. [°C]

    References
    ----------
    [IEC600767]_, paper that is not thermally upgraded.
    """
    with np.errstate(over="ignore"):
        return np.asarray(2.0 ** ((hot_spot_c - NORMAL_HOT_SPOT_C) / DOUBLES_PER_K))
