"""CasADi: its root finder ``fast_newton`` with exact sparse derivatives, https://web.casadi.org.

The unknowns are the real and imaginary parts of the voltages, the equations the currents at the buses,
which took half the time of the equations in power.
"""

from typing import Any

import casadi
import numpy as np

from load_flow.case import (
    BASE_POWER_VA,
    MOST_ITERATIONS,
    TOLERANCE,
    Branches,
    Case,
    Complexes,
    Floats,
    Run,
    build_branches,
)


def build_root_finder(case: Case, branches: Branches) -> Any:
    """Root finder of the free buses' voltages, with the impedances and loads as parameters."""
    n_lines, n_loads = branches.start.size, case.trains
    free = free_buses(case)
    unknown = casadi.SX.sym("x", 2 * free.size)
    r, x = casadi.SX.sym("r", n_lines), casadi.SX.sym("x", n_lines)
    p, q = casadi.SX.sym("p", n_loads), casadi.SX.sym("q", n_loads)
    e, f = [casadi.SX(1.0)] * case.buses, [casadi.SX(0.0)] * case.buses
    for k, bus in enumerate(free):
        e[bus], f[bus] = unknown[2 * k], unknown[2 * k + 1]
    balance = [[casadi.SX(0.0), casadi.SX(0.0)] for _ in range(case.buses)]
    for k, (a, b) in enumerate(zip(branches.start, branches.end, strict=True)):
        square, de, df = r[k] ** 2 + x[k] ** 2, e[a] - e[b], f[a] - f[b]
        current = (r[k] * de + x[k] * df) / square, (r[k] * df - x[k] * de) / square
        for part in range(2):
            balance[a][part] += current[part]
            balance[b][part] -= current[part]
    for k, bus in enumerate(case.load_buses):
        square = e[bus] ** 2 + f[bus] ** 2
        balance[bus][0] += (p[k] * e[bus] + q[k] * f[bus]) / square
        balance[bus][1] += (p[k] * f[bus] - q[k] * e[bus]) / square
    problem = {
        "x": unknown,
        "p": casadi.vertcat(r, x, p, q),
        "g": casadi.vertcat(*(part for bus in free for part in balance[bus])),
    }
    # A step may be as small as it likes: only the mismatch ends the iteration.
    options = {"abstol": TOLERANCE, "abstolStep": 0.0, "max_iter": MOST_ITERATIONS}
    return casadi.rootfinder("load_flow", "fast_newton", problem, options)


def free_buses(case: Case) -> Any:
    """All buses but the sources."""
    return np.setdiff1d(np.arange(case.buses), case.source_nodes)


def parameters(case: Case, branches: Branches) -> Floats:
    """Impedances and loads, shape (steps, parameters). [p.u.]"""
    load = case.power_va / BASE_POWER_VA
    z = branches.impedance
    return np.hstack([z.real, z.imag, load.real, load.imag])


def prepare_called(case: Case) -> Run:
    """The function as its user calls it."""
    branches = build_branches(case)
    solve, given = build_root_finder(case, branches), parameters(case, branches)
    collect = Collector(case)
    start = solve(collect.flat, given[0])

    def run() -> Complexes:
        unknown = start
        for step in range(case.steps):
            unknown = solve(unknown, given[step])
            collect.found[step] = np.asarray(unknown)[:, 0]
        return collect.voltages()

    return run


def prepare_buffered(case: Case) -> Run:
    """The function through its buffers: no object is made for a call."""
    branches = build_branches(case)
    function, given = build_root_finder(case, branches), parameters(case, branches)
    collect = Collector(case)
    start, parameter, found = collect.flat, given[0].copy(), np.zeros_like(collect.flat)
    buffer, solve = function.buffer()
    for place, array in enumerate((start, parameter)):
        buffer.set_arg(place, memoryview(array))
    buffer.set_res(0, memoryview(found))

    def run() -> Complexes:
        for step in range(case.steps):
            parameter[:] = given[step]
            solve()
            start[:] = found
            collect.found[step] = found
        assert buffer.ret() == 0, "CasADi does not converge"
        return collect.voltages()

    return run


class Collector:
    """Solutions of all steps."""

    def __init__(self, case: Case) -> None:
        self.free = free_buses(case)
        self.flat = np.tile([1.0, 0.0], self.free.size)
        self.found = np.zeros((case.steps, self.flat.size))
        self.complete = np.ones((case.steps, case.buses), dtype=complex)

    def voltages(self) -> Complexes:
        """Voltages of all buses."""
        self.complete[:, self.free] = self.found.view(complex)
        return self.complete
