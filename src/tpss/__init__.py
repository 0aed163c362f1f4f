"""TPSS, the Train Power System Simulator."""
