"""Constants of nature and of the thesis's base quantities."""

GRAVITY_M_S2 = 9.81
"""Acceleration of gravity. [m/s²] [Boullanger2009]_, Table 4-1."""

BASE_VOLTAGE_V = 16_500.0
"""Base voltage of the contact line, U_b. [V] [Boullanger2009]_, Table 4-2."""

BASE_POWER_VA = 10e6
"""Base power of tolerances. [VA] Pure scaling; the thesis's own digit is lost."""

NOMINAL_VOLTAGE_V = 15_000.0
"""Nominal voltage of the contact line and of the locomotive's transformer, U_b2. [V]
[Boullanger2009]_, Table 4-2."""

LOCOMOTIVE_SECONDARY_V = 487.0
"""Secondary voltage of the locomotive's transformer at nominal voltage, U_b3. [V]
[Boullanger2009]_, Table 4-2."""
