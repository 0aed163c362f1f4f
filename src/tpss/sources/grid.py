r"""Transformer station behind a grid of its own frequency: Thévenin's source.

.. math:: U = E - \Big(Z_{grid} + \frac{Z_t}{n}\Big) J

E is the no-load voltage on the railway's side, J the current into the railway, n the number of equal
transformers in parallel.  A transformer between two phases of a grid with the short-circuit power S_k
sees :math:`Z_{grid} = 2 E^2 / S_k`.  Without impedances the source is ideal.

Limits of validity: without load the grid's three phases are balanced.  What other sources draw from the
same grid is not in this law, see `powerflow.shared_grids`.
"""

import math

from tpss.kernel import inlined
from tpss.numerics.pairs import Pair, magnitude, scaled, squared
from tpss.record import Record


class GridLaw(Record):
    """Parameters of a transformer station; impedances on the railway's side."""

    no_load_voltage_v: complex = math.nan
    """No-load voltage, E. [V]"""
    grid_impedance_ohm: complex = math.nan
    """Impedance of the grid. [Ω]"""
    transformer_impedance_ohm: complex = math.nan
    """Short-circuit impedance of one transformer. [Ω]"""


@inlined
def grid_impedance(transformers: float, law: GridLaw) -> complex:
    """Impedance between no-load voltage and terminals. [Ω]

    References
    ----------
    [Steimel2014]_, the feeding of single-phase lines from the three-phase grid.
    """
    return law.grid_impedance_ohm + scaled(law.transformer_impedance_ohm, 1.0 / transformers)


@inlined
def grid_residual(
    voltage: complex, current: complex, transformers: float, law: GridLaw
) -> tuple[complex, Pair, Pair]:
    """Voltage less what the law asks for, and its derivatives over voltage and current, as pairs.

    Parameters are those of `sources.kinds.residual`.

    References
    ----------
    [Steimel2014]_, as `grid_impedance`.
    """
    impedance = grid_impedance(transformers, law)
    asked = law.no_load_voltage_v - impedance * current
    return voltage - asked, (complex(1.0, 0.0), 0j), (impedance, 0j)


@inlined
def grid_losses(current: complex, transformers: float, law: GridLaw) -> float:
    """Losses in transformers and grid, I²R. [W]

    References
    ----------
    [Steimel2014]_, as `grid_impedance`.
    """
    return grid_impedance(transformers, law).real * squared(current)


@inlined
def unloaded_grid(law: GridLaw) -> tuple[float, float]:
    """Magnitude and angle of a station's voltage without load. [V], [rad]"""
    voltage = law.no_load_voltage_v
    return magnitude(voltage), math.atan2(voltage.imag, voltage.real)


@inlined
def set_unloaded_grid(magnitude_v: float, angle_rad: float, law: GridLaw) -> None:
    """Give a station another voltage without load."""
    law.no_load_voltage_v = complex(
        magnitude_v * math.cos(angle_rad), magnitude_v * math.sin(angle_rad)
    )
