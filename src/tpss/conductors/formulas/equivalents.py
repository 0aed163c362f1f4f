"""Impedances of one conductor a track that stand for all of a line, its return included."""

import numpy as np

from tpss.conductors.formulas.vacuum import Complex, Real


def return_in_rails(impedance: Complex) -> Complex:
    r"""Contact lines above rails of one voltage, which take all of the return. [Ω/m]

    .. math:: z_{ij} = Z_{ij} - Z_{ir} - Z_{rj} + Z_{rr}

    Parameters
    ----------
    impedance : array (c + 1, c + 1)
        Of contact lines, and at the end of all rails together. [Ω/m]

    References
    ----------
    Kirchhoff's laws around the loop of two conductors, as [Kersting2012]_, chapter 4, has them.
    """
    contact, mutual, rails = impedance[:-1, :-1], impedance[:-1, -1:], impedance[-1:, -1:]
    result: Complex = contact - mutual - mutual.T + rails
    return result


def autotransformer_line(impedance: Complex, far: Real, near: Real) -> tuple[Complex, Complex]:
    r"""Impedance of a line of ideal autotransformers: that along it, and that within a cell. [Ω/m]

    Between stations and the cell of a train the current i runs out in the contact line as i/2 and
    back in the feeder; these are the columns m.  Within the cell rails bring it to both ends: columns
    l, half in the contact line, half in the feeder, all in the rails.  At autotransformers
    :math:`l^T V = 0`; this makes, x' beyond the last one in a cell of length D,

    .. math:: Z(x) = z_L x + z_s x' \frac{D - x'}{D},

    .. math:: z_L = Z_{mm} - Z_{ml} Z_{ll}^{-1} Z_{lm}, \qquad
              z_s = Z_{ll} + Z_{ml} + Z_{lm} + Z_{ml} Z_{ll}^{-1} Z_{lm},

    with :math:`Z_{ml} = m^T Z l` and so on.  Rails are insulated, and of one voltage; contact line
    and feeder need not be alike.  Where they are, :math:`Z_{ml} = 0`.

    Parameters
    ----------
    impedance : array (n, n)
        Of all conductors. [Ω/m]
    far, near : array (n, tracks)
        m and l. [1]

    Returns
    -------
    array (tracks, tracks), array (tracks, tracks)
        Along the line, and within a cell.

    References
    ----------
    Derived in the theory of line constants, by Kirchhoff's laws with the impedances of [Carson1926]_.
    """
    between = far.T @ impedance @ near
    within = near.T @ impedance @ near
    unlike = between @ np.linalg.solve(within, between.T)
    along: Complex = far.T @ impedance @ far - unlike
    in_cell: Complex = within + between + between.T + unlike
    return along, in_cell
