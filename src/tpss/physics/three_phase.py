r"""Single-phase windings at a three-phase grid, and what their currents do to its symmetry.

The phases R, S and T of the grid follow each other in this order, R with angle 0:

.. math:: u_R = 1, \quad u_S = e^{-j 2\pi/3}, \quad u_T = e^{j 2\pi/3}

A winding between two of them, or the teaser of a Scott connection between one and the middle of the
other two, has without load a voltage in proportion to :math:`\sum_p w_p u_p`, where the weights w sum
up to zero, and takes the currents :math:`w_p` J from the phases.  The weights here are those of windings
whose voltage is that between two phases if nothing is loaded, so that
:math:`|\sum_p w_p u_p| = \sqrt 3` for all of them.

Limits of validity: the negative-sequence impedance of the grid is its positive-sequence impedance, and
there is no current in a neutral.
"""

import cmath
import math

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]

PHASES = "RST"
"""Names of the phases, in the order in which they follow each other."""

TURN = cmath.exp(2j * math.pi / 3.0)
"""A third of a turn."""

UNLOADED = np.array([1.0, TURN.conjugate(), TURN])
"""Voltages of the phases without load, of size 1. [1]"""


def winding_of(phases: str) -> Floats:
    """Weights of the phases in a winding. [1], shape (3,)

    Parameters
    ----------
    phases : str
        Two letters, the winding lies from the first phase to the second, as "RS"; or one letter, it is
        the teaser of a Scott connection, from this phase to the middle of the other two.

    References
    ----------
    [Steimel2014]_, the feeding of single-phase lines from the three-phase grid.
    """
    first = PHASES.index(phases[0])
    if len(phases) == 1:
        weights = np.full(len(PHASES), -1.0 / math.sqrt(3.0))
        weights[first] = 2.0 / math.sqrt(3.0)
        return weights
    weights = np.zeros(len(PHASES))
    weights[first], weights[PHASES.index(phases[1])] = 1.0, -1.0
    return weights


def angle_of(phases: str) -> float:
    """Angle of a winding's voltage without load, against that of phase R; RS has 30°. [rad]

    References
    ----------
    [Steimel2014]_, as `winding_of`.
    """
    return cmath.phase(complex(winding_of(phases) @ UNLOADED))


def impedance_between(first: str, second: str) -> complex:
    r"""What a winding feels of another's current, over the grid's impedance of one phase. [1]

    .. math:: \frac{z_{12}}{Z_1} = \sum_p w_{1p} w_{2p} \, e^{j (\theta_2 - \theta_1)}

    for windings with the voltage of the grid between two phases.  The phasors of each winding count from
    its own voltage without load, of the angle θ.  Of a winding and itself it is 2, of the two of a
    Scott connection 0.

    Parameters
    ----------
    first, second : str
        Phases of the winding that loses voltage, and of the one that carries the current.

    References
    ----------
    [Steimel2014]_, as `winding_of`.
    """
    common = float(winding_of(first) @ winding_of(second))
    if abs(common) < 1e-12:  # windings at right angles have nothing in common, but for rounding
        return 0j
    return common * cmath.exp(1j * (angle_of(second) - angle_of(first)))


def sequences(phase_values: Complexes) -> tuple[Complexes, Complexes]:
    r"""Positive and negative sequence of the values of three phases, along the last axis.

    .. math:: X_1 = \frac{X_R + a X_S + a^2 X_T}{3}, \quad X_2 = \frac{X_R + a^2 X_S + a X_T}{3},
        \quad a = e^{j 2\pi/3}

    References
    ----------
    [Fortescue1918]_
    """
    positive = phase_values @ (UNLOADED.conjugate() / 3.0)
    return positive, phase_values @ (UNLOADED / 3.0)
