"""Carson's correction by the first term of each of his series, as textbooks have it."""

import numpy as np
from numpy.typing import ArrayLike

from tpss.conductors.formulas.carson import Q_CONSTANT
from tpss.conductors.formulas.vacuum import PERMEABILITY_H_PER_M, Complex


def clem(
    omega_rad_s: float, resistivity_ohm_m: float, heights_m: ArrayLike, across_m: ArrayLike
) -> Complex:
    r"""Correction of the impedance above a conducting earth, by the first terms of Carson's. [Ω/m]

    .. math:: \Delta Z = \frac{\omega\mu_0}{\pi} \left[\frac{\pi}{8}
              + \frac{j}{2} (0.6159315 - \ln k)\right]

    With the rest of the impedance the heights cancel: the return lies
    :math:`D_e = 658.87 \sqrt{\rho/f}` metres below each wire, and has the resistance
    :math:`\omega\mu_0/8`.  Good while D' is a small part of that.

    Parameters
    ----------
    omega_rad_s, resistivity_ohm_m, heights_m, across_m
        As of `carson.carson`.

    References
    ----------
    [Carson1926]_, the first terms; [Kersting2012]_, chapter 4.
    """
    image_m = np.hypot(np.asarray(heights_m, float), np.asarray(across_m, float))
    k = image_m * np.sqrt(omega_rad_s * PERMEABILITY_H_PER_M / resistivity_ohm_m)
    terms = np.pi / 8.0 + 0.5j * (Q_CONSTANT - np.log(k))
    return np.asarray(omega_rad_s * PERMEABILITY_H_PER_M / np.pi * terms)
