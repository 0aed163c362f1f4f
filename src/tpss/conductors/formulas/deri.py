"""The earth as an ideal conductor at a complex depth."""

import numpy as np
from numpy.typing import ArrayLike

from tpss.conductors.formulas.vacuum import PERMEABILITY_H_PER_M, Complex


def deri(
    omega_rad_s: float, resistivity_ohm_m: float, heights_m: ArrayLike, across_m: ArrayLike
) -> Complex:
    r"""Correction of the impedance above a conducting earth, by a complex depth of return. [Ω/m]

    .. math:: \Delta Z = \frac{j\omega\mu_0}{2\pi}
              \ln\frac{\sqrt{(h_i + h_j + 2p)^2 + x^2}}{\sqrt{(h_i + h_j)^2 + x^2}}, \qquad
              p = \sqrt{\frac{\rho}{j\omega\mu_0}}

    Within some percent of Carson's at any frequency, and in closed form.

    Parameters
    ----------
    omega_rad_s, resistivity_ohm_m, heights_m, across_m
        As of `carson.carson`.

    References
    ----------
    [Deri1981]_.
    """
    height, across = np.asarray(heights_m, float), np.asarray(across_m, float)
    depth_m = np.sqrt(resistivity_ohm_m / (1j * omega_rad_s * PERMEABILITY_H_PER_M))
    image_m = np.sqrt((height + 2.0 * depth_m) ** 2 + across**2)
    ratio = image_m / np.hypot(height, across)
    return np.asarray(0.5j * omega_rad_s * PERMEABILITY_H_PER_M / np.pi * np.log(ratio))
