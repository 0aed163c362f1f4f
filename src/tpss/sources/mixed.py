r"""Converter station with converters of different types at one busbar.

Each type has its own law :math:`f_i` over the power :math:`s_i` of its converters.  They share one
voltage, so a station's law over its whole power :math:`s` is the :math:`w` of

.. math:: f_i(s_i) = w, \qquad \sum_i s_i = s .

With :math:`D_i` the derivatives of the laws, its own is :math:`(\sum_i D_i^{-1})^{-1}`: converters in
parallel.
"""

import numpy as np
import numpy.typing as npt

from tpss.kernel import kernel
from tpss.numerics.pairs import Pair, apply, inverse, magnitude
from tpss.record import Record
from tpss.sources.converter import (
    ConverterLaw,
    converter_is_plausible,
    converter_reserve,
    converter_residual,
    set_unloaded_converter,
    unloaded_converter,
)

TYPES = ("first", "second", "third")
"""Beginnings of the fields of a type."""

MOST_ITERATIONS = 30
CLOSE = 1e-11
"""Spread of the types' voltages, over their size, from which the next step is the last."""

Complexes = npt.NDArray[np.complex128]

Split = tuple[complex, complex, complex]
"""Powers of the types. [VA]"""


class MixedLaw(Record):
    """Converters of up to three types; the first is always there, of others there may be none."""

    first: ConverterLaw = ConverterLaw.row()
    second: ConverterLaw = ConverterLaw.row()
    third: ConverterLaw = ConverterLaw.row()
    first_share: float = 1.0
    """Rated power of all converters of the first type, over that of the station. [1]"""
    second_share: float = 0.0
    """That of the second type. [1]"""
    third_share: float = 0.0
    """That of the third type. [1]"""
    first_units: int = 0
    """Number of converters of the first type."""
    second_units: int = 0
    """Of the second type; 0: there is none."""
    third_units: int = 0
    """Of the third type; 0: there is none."""


@kernel
def _of_type(power: complex, units: int, law: ConverterLaw) -> tuple[complex, complex, complex]:
    """Voltage of a type, and the inverse of its derivative over the power, as a pair; 0 of none."""
    if units == 0:
        return 0j, 0j, 0j
    # At 1 V the current is the conjugate of the power.
    off, _, by_current = converter_residual(1.0 + 0j, power.conjugate(), units, law, True)
    p, q = inverse(-by_current[1], -by_current[0])
    return 1.0 - off, p, q


@kernel
def split(power: complex, law: MixedLaw) -> tuple[complex, Pair, Split]:
    """Voltage of a station over its power, its derivative, and how the types share the power.

    By Newton's method on the powers of the types, from shares by their rated powers.

    Parameters
    ----------
    power : complex
        P + jQ fed into the railway. [VA]
    law : MixedLaw

    Returns
    -------
    voltage : complex
        What the law asks for. [V]
    by_power : Pair
        Its derivative over the power. [V/VA]
    powers : tuple of complex
        Of the types. [VA]

    References
    ----------
    [Boullanger2009]_, eq. (2.1)-(2.4), of each type.
    """
    a, b, c = law.first_share * power, law.second_share * power, law.third_share * power
    voltage, by_power = 0j, (0j, 0j)
    for _ in range(MOST_ITERATIONS):
        of_a, p_a, q_a = _of_type(a, law.first_units, law.first)
        of_b, p_b, q_b = _of_type(b, law.second_units, law.second)
        of_c, p_c, q_c = _of_type(c, law.third_units, law.third)
        by_power = inverse(p_a + p_b + p_c, q_a + q_b + q_c)
        # Voltages against that of the first type, which loses no digits.
        less_b = of_b - of_a if law.second_units > 0 else 0j
        less_c = of_c - of_a if law.third_units > 0 else 0j
        missing = power - (a + b + c) + apply(p_b, q_b, less_b) + apply(p_c, q_c, less_c)
        raised = apply(by_power[0], by_power[1], missing)
        voltage = of_a + raised
        a += apply(p_a, q_a, raised)
        b += apply(p_b, q_b, raised - less_b)
        c += apply(p_c, q_c, raised - less_c)
        spread = max(magnitude(raised), magnitude(raised - less_b), magnitude(raised - less_c))
        if spread <= CLOSE * magnitude(voltage):
            break
    return voltage, by_power, (a, b, c)


@kernel
def split_all(powers: Complexes, law: MixedLaw, shared: Complexes) -> None:
    """How the types share the powers of all steps. [VA]

    Parameters
    ----------
    powers : array of complex, shape (steps,)
        P + jQ fed into the railway. [VA]
    law : MixedLaw
    shared : array of complex, shape (steps, 3)
        Filled with the powers of the types. [VA]
    """
    for k in range(powers.size):
        _, _, (shared[k, 0], shared[k, 1], shared[k, 2]) = split(powers[k], law)


@kernel
def mixed_residual(voltage: complex, current: complex, law: MixedLaw) -> tuple[complex, Pair, Pair]:
    """Voltage less what the law asks for, and its derivatives over voltage and current, as pairs.

    Parameters are those of `sources.kinds.residual`; the derivatives follow from that over the power as
    those of `converter_residual`.

    References
    ----------
    [Boullanger2009]_, eq. (2.1)-(2.4), of each type.
    """
    asked, (s1, s2), _ = split(voltage * current.conjugate(), law)
    by_voltage = (1.0 - s1 * current.conjugate(), -(s2 * current))
    by_current = (-(s2 * voltage.conjugate()), -(s1 * voltage))
    return voltage - asked, by_voltage, by_current


@kernel
def mixed_is_plausible(voltage: complex, current: complex, law: MixedLaw) -> bool:
    """Whether the converters of each type are in a state that their law admits."""
    _, _, (a, b, c) = split(voltage * current.conjugate(), law)
    found = _is_plausible(a, law.first_units, law.first)
    found = found and _is_plausible(b, law.second_units, law.second)
    return found and _is_plausible(c, law.third_units, law.third)


@kernel
def _is_plausible(power: complex, units: int, law: ConverterLaw) -> bool:
    return units == 0 or converter_is_plausible(1.0 + 0j, power.conjugate(), units, law)


@kernel
def mixed_reserve(voltage: complex, current: complex, law: MixedLaw) -> float:
    """How far the machines that are nearest to it are from falling out of step. [1]"""
    _, _, (a, b, c) = split(voltage * current.conjugate(), law)
    found = _reserve(a, law.first_units, law.first)
    found = min(found, _reserve(b, law.second_units, law.second))
    return min(found, _reserve(c, law.third_units, law.third))


@kernel
def _reserve(power: complex, units: int, law: ConverterLaw) -> float:
    if units == 0:
        return 1.0
    return converter_reserve(1.0 + 0j, power.conjugate(), units, law)


@kernel
def unloaded_mixed(law: MixedLaw) -> tuple[float, float]:
    """Magnitude and angle of a station's voltage without load, which all types have. [V], [rad]"""
    return unloaded_converter(law.first)


@kernel
def set_unloaded_mixed(magnitude_v: float, angle_rad: float, law: MixedLaw) -> None:
    """Give a station another voltage without load."""
    set_unloaded_converter(magnitude_v, angle_rad, law.first)
    set_unloaded_converter(magnitude_v, angle_rad, law.second)
    set_unloaded_converter(magnitude_v, angle_rad, law.third)
