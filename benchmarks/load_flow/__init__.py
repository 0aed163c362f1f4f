"""One line's load flow, solved by TPSS and by other programs, a file each.

Each ``prepare`` takes a `Case` and gives a function that solves all of its steps, every step from
the solution of the one before where a program can do that, and returns the voltages of all buses.
Nothing but that function is timed: what a program can prepare once, or for all steps at once, is
prepared.
"""
