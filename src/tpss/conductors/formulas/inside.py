"""Impedance of the field within a conductor: by its geometric mean radius, or by the skin effect."""

import numpy as np

from tpss.conductors.formulas.bessel import scaled_i, scaled_k
from tpss.conductors.formulas.vacuum import PERMEABILITY_H_PER_M

SMALL = 1e-3
"""Radius over skin depth below which the current fills a conductor evenly, to the last digits. [1]"""


def by_mean_radius(
    omega_rad_s: float, r_ohm_per_m: float, radius_m: float, gmr_m: float
) -> complex:
    r"""Internal impedance of a wire whose geometric mean radius is known. [Ω/m]

    .. math:: z = R + \frac{j\omega\mu_0}{2\pi} \ln\frac{r}{r_{GMR}}

    Parameters
    ----------
    omega_rad_s : float
        Angular frequency. [rad/s]
    r_ohm_per_m : float
        Resistance at that frequency. [Ω/m]
    radius_m, gmr_m : float
        Outer radius, and geometric mean radius, at most as large: r exp(-μ/4) of a solid wire of
        relative permeability μ, without skin effect. [m]

    References
    ----------
    [Kersting2012]_, chapter 4.
    """
    within = omega_rad_s * PERMEABILITY_H_PER_M / (2.0 * np.pi) * np.log(radius_m / gmr_m)
    return complex(r_ohm_per_m, within)


def by_skin_effect(
    omega_rad_s: float,
    r_ohm_per_m: float,
    radius_m: float,
    inner_radius_m: float = 0.0,
    relative_permeability: float = 1.0,
) -> complex:
    r"""Internal impedance of a round wire or tube, whose current is pressed outwards. [Ω/m]

    .. math:: z = \frac{\rho m}{2\pi a} \,
              \frac{I_0(ma) K_1(mb) + K_0(ma) I_1(mb)}{I_1(ma) K_1(mb) - I_1(mb) K_1(ma)}, \qquad
              m = \sqrt{\frac{j\omega\mu}{\rho}}

    of a tube of the radii a and b; :math:`\rho m I_0(ma) / 2\pi a I_1(ma)` of a solid wire.

    Parameters
    ----------
    omega_rad_s : float
        Angular frequency, 0 for direct current. [rad/s]
    r_ohm_per_m : float
        Resistance to direct current, from which the resistivity ρ follows. [Ω/m]
    radius_m, inner_radius_m : float
        a, and b < a, 0 of a solid wire. [m]
    relative_permeability : float
        μ over μ₀, constant: magnetic saturation is not found. [1]

    References
    ----------
    [Schelkunoff1934]_, of a return outside; [Dommel1986]_, section 4.1.
    """
    resistivity = r_ohm_per_m * np.pi * (radius_m**2 - inner_radius_m**2)
    permeability = relative_permeability * PERMEABILITY_H_PER_M
    wave = np.sqrt(1j * omega_rad_s * permeability / resistivity)
    if abs(wave * radius_m) < SMALL:
        return complex(r_ohm_per_m, omega_rad_s * permeability * _evenly(radius_m, inner_radius_m))
    outer, inner = wave * radius_m, wave * inner_radius_m
    i0, i1 = scaled_i(0, outer), scaled_i(1, outer)
    if inner_radius_m > 0.0:
        # e^(-2 m (a - b)) is what the scaling leaves of growth and decay between both radii.
        fall = np.exp(-2.0 * (outer - inner))
        k1, from_inside = scaled_k(1, inner), fall * scaled_i(1, inner)
        i0, i1 = (
            i0 * k1 + scaled_k(0, outer) * from_inside,
            i1 * k1 - scaled_k(1, outer) * from_inside,
        )
    return complex(resistivity * outer / (2.0 * np.pi * radius_m**2) * i0 / i1)


def _evenly(radius_m: float, inner_radius_m: float) -> float:
    r"""Internal inductance over the permeability, of a current that fills a wire or tube evenly. [1]

    .. math:: \frac{1}{2\pi} \left[\frac{b^4}{(a^2 - b^2)^2} \ln\frac{a}{b}
              + \frac{a^2 - 3b^2}{4 (a^2 - b^2)}\right]

    References
    ----------
    [Dommel1986]_, section 4.1.
    """
    a2, b2 = radius_m**2, inner_radius_m**2
    within = (a2 - 3.0 * b2) / (4.0 * (a2 - b2))
    if b2 > 0.0:
        within += b2**2 / (a2 - b2) ** 2 * np.log(a2 / b2) / 2.0
    return within / (2.0 * np.pi)
