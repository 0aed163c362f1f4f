"""TPSA, the Train Power System Approximator: what a study's simulations tell, learnt from its table."""
