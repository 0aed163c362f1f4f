"""Formulas of the earth return, by name: each is a file of its own."""

from collections.abc import Callable

from numpy.typing import ArrayLike

from tpss.conductors.formulas.carson import carson
from tpss.conductors.formulas.clem import clem
from tpss.conductors.formulas.deri import deri
from tpss.conductors.formulas.vacuum import Complex

EarthReturn = Callable[[float, float, ArrayLike, ArrayLike], Complex]
"""Angular frequency, resistivity of the earth, sums of heights, distances across the line: the
correction of the impedance. [rad/s, Ω m, m, m; Ω/m]"""

METHODS: dict[str, EarthReturn] = {"carson": carson, "clem": clem, "deri": deri}
