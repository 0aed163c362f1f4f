"""The thesis's equations, one chapter a file: pure functions, compiled, SI units, no input or output."""
