"""The equations of line constants: numbers and arrays in SI in, arrays out; numpy only.

Sign: a voltage falls in the direction of the current, ``-dV/ds = Z I``.  Heights are above ground.
"""
