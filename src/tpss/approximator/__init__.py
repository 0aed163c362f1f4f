"""TPSA, the Train Power System Approximator: predictions learnt from the table of a study."""
