"""Matrices of all conductors of a line, and of groups of them."""

import numpy as np
from numpy.typing import ArrayLike

from tpss.conductors.formulas.earth_return import EarthReturn
from tpss.conductors.formulas.vacuum import (
    PERMEABILITY_H_PER_M,
    PERMITTIVITY_F_PER_M,
    Complex,
    Real,
)


def distances(x_m: ArrayLike, height_m: ArrayLike, radius_m: ArrayLike) -> tuple[Real, Real]:
    r"""Distances to conductors, a radius to a conductor itself, and to their images. [m]

    .. math:: d = \sqrt{(h_i - h_j)^2 + (x_i - x_j)^2}, \qquad
              D' = \sqrt{(h_i + h_j)^2 + (x_i - x_j)^2}

    Parameters
    ----------
    x_m, height_m, radius_m : array (n)
        Place across the line, mean height, and outer radius. [m]

    Returns
    -------
    array (n, n), array (n, n)

    References
    ----------
    [Kersting2012]_, chapter 4.
    """
    x, h = np.asarray(x_m, float), np.asarray(height_m, float)
    across = np.subtract.outer(x, x)
    direct = np.hypot(across, np.subtract.outer(h, h))
    np.fill_diagonal(direct, radius_m)
    return direct, np.hypot(across, np.add.outer(h, h))


def series_impedance(
    omega_rad_s: float,
    inside_ohm_per_m: ArrayLike,
    x_m: ArrayLike,
    height_m: ArrayLike,
    radius_m: ArrayLike,
    resistivity_ohm_m: float,
    earth_return: EarthReturn,
) -> Complex:
    r"""Series impedances of all conductors, each with its return through the earth. [Ω/m]

    .. math:: Z_{ii} = z_i + \frac{j\omega\mu_0}{2\pi} \ln\frac{2 h_i}{r_i} + \Delta Z_{ii}, \qquad
              Z_{ij} = \frac{j\omega\mu_0}{2\pi} \ln\frac{D'_{ij}}{d_{ij}} + \Delta Z_{ij}

    Of direct current nothing but resistances is left, and the earth has none.

    Parameters
    ----------
    omega_rad_s : float
        Angular frequency, 0 for direct current. [rad/s]
    inside_ohm_per_m : array (n)
        Internal impedances, z. [Ω/m]
    x_m, height_m, radius_m : array (n)
        As of `distances`.
    resistivity_ohm_m : float
        Of the earth. [Ω m]
    earth_return : callable
        Formula of the correction by the earth.

    References
    ----------
    [Carson1926]_; [Dommel1986]_, section 4.1.
    """
    inside = np.diag(np.asarray(inside_ohm_per_m, complex))
    if omega_rad_s == 0.0:
        return inside
    direct, image = distances(x_m, height_m, radius_m)
    h, x = np.asarray(height_m, float), np.asarray(x_m, float)
    correction = earth_return(
        omega_rad_s, resistivity_ohm_m, np.add.outer(h, h), np.subtract.outer(x, x)
    )
    outside = 0.5j * omega_rad_s * PERMEABILITY_H_PER_M / np.pi * np.log(image / direct)
    return inside + outside + correction


def potential_coefficients(x_m: ArrayLike, height_m: ArrayLike, radius_m: ArrayLike) -> Real:
    r"""Voltages that charges on conductors above an equipotential earth give them. [m/F]

    .. math:: P_{ii} = \frac{1}{2\pi\varepsilon_0} \ln\frac{2 h_i}{r_i}, \qquad
              P_{ij} = \frac{1}{2\pi\varepsilon_0} \ln\frac{D'_{ij}}{d_{ij}}

    Parameters
    ----------
    x_m, height_m, radius_m : array (n)
        As of `distances`.

    References
    ----------
    [Kersting2012]_, chapter 5.
    """
    direct, image = distances(x_m, height_m, radius_m)
    result: Real = np.log(image / direct) / (2.0 * np.pi * PERMITTIVITY_F_PER_M)
    return result


def membership(groups: ArrayLike) -> Real:
    """Matrix S that says which conductor is in which group. [1]

    Conductors of a group are held at one voltage.  One that is in none is held at that of the earth, all
    along.

    Parameters
    ----------
    groups : array (n)
        Number of each conductor's group; -1: none.

    Returns
    -------
    array (groups, n)

    References
    ----------
    [Dommel1986]_, section 4.1.
    """
    number = np.asarray(groups, int)
    belongs = np.arange(number.max() + 1)[:, None] == number
    return np.asarray(belongs, np.float64)


def of_groups(matrix: Complex | Real, member: Real) -> Complex | Real:
    r"""Sums of currents, or of charges, per voltage of groups: inverse of a matrix, by groups.

    .. math:: S Z^{-1} S^T, \qquad S P^{-1} S^T

    The first is the inverse of the groups' impedance, the second their capacitance.  For a conductor in
    no group this is Kron's reduction, with all of its current and no voltage; conductors of one group it
    bundles.

    Parameters
    ----------
    matrix : array (n, n)
        Impedances or potential coefficients of all conductors.
    member : array (groups, n)
        Of `membership`.

    References
    ----------
    [Dommel1986]_, section 4.1.
    """
    return member @ np.linalg.solve(matrix, member.T.astype(matrix.dtype))
