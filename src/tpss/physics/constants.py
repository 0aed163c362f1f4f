"""Constants of nature."""

GRAVITY_M_S2 = 9.81
"""Acceleration of gravity. [m/s²] [Boullanger2009]_, Table 4-1."""
