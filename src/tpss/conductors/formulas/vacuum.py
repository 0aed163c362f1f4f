"""Constants of the field around conductors, and types of arrays of it."""

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

PERMEABILITY_H_PER_M = 4e-7 * np.pi
"""Permeability of vacuum, μ₀, and of air and soil. [H/m]"""

PERMITTIVITY_F_PER_M = 8.8541878128e-12
"""Permittivity of vacuum, ε₀, and of air. [F/m]"""
