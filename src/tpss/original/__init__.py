"""The load flow of the original program: least squares of the power mismatches, for comparison."""
