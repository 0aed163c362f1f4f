"""lightsim2grid: Newton's method in C++ with KLU, https://github.com/Grid2op/lightsim2grid.

It has one reference angle, so both ideal sources, which are alike, are one bus.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from lightsim2grid.algorithm import AlgorithmType, RefactorPolicyType
from lightsim2grid.lightsim2grid_cpp import LSGrid, TimeSeriesCPP

from load_flow.case import (
    MOST_ITERATIONS,
    TOLERANCE,
    Branches,
    Case,
    Complexes,
    Indices,
    Run,
    build_branches,
)

BASE_MVA, BASE_KV = 10.0, 16.5
ALGORITHM = AlgorithmType.NRSing_KLU  # a single slack bus: a little faster than NR_KLU


@dataclass(frozen=True)
class Grid:
    """A grid, and which of its buses each bus of the case is."""

    grid: Any
    bus: Indices
    start: Complexes

    def solve(self, voltage: Complexes) -> Complexes:
        found: Complexes = self.grid.ac_pf(voltage, MOST_ITERATIONS, TOLERANCE)
        assert found.size, "lightsim2grid does not converge"
        return found


def build_grid(case: Case, branches: Branches, policy: RefactorPolicyType) -> Grid:
    """The grid of a case's first step."""
    merged = np.arange(case.buses)
    merged[case.source_nodes] = case.source_nodes[0]
    names, bus = np.unique(merged, return_inverse=True)
    bus = bus.astype(np.int32)
    grid, ohm, power_mva = LSGrid(), branches.impedance[0], case.power_va[0] / 1e6
    grid.set_sn_mva(BASE_MVA)
    grid.set_init_vm_pu(1.0)
    grid.init_bus(names.size, 1, np.full(names.size, BASE_KV), 0, 0)
    grid.init_powerlines(
        ohm.real, ohm.imag, np.zeros_like(ohm), bus[branches.start], bus[branches.end]
    )
    grid.init_loads(power_mva.real, power_mva.imag, bus[case.load_buses])
    slack = bus[case.source_nodes[:1]]
    grid.init_generators(np.zeros(1), np.ones(1), np.full(1, -1e9), np.full(1, 1e9), slack)
    grid.add_gen_slackbus(0, 1.0)
    grid.change_algorithm(ALGORITHM)
    grid.set_ac_algo_config(with_policy(grid.get_ac_algo_config(), policy))
    grid.deactivate_result_computation()
    flat = Grid(grid, bus, np.ones(names.size, dtype=complex))
    return Grid(grid, bus, flat.solve(flat.start))


def with_policy(configuration: Any, policy: RefactorPolicyType) -> Any:
    """Settings of the algorithm with another rule for when the Jacobian is factorised anew."""
    scaling, _, *others = configuration.int_params
    configuration.int_params = [scaling, int(policy), *others]
    return configuration


def prepare_moving(case: Case, policy: RefactorPolicyType, *, predicted: bool = False) -> Run:
    """Line parameters replaced before each solve, which starts from the solution before.

    Or from the straight line through the last two, as that of TPSS.
    """
    branches = build_branches(case)
    grid = build_grid(case, branches, policy)
    resistance, reactance = branches.impedance.real.copy(), branches.impedance.imag.copy()
    shunt = np.zeros(branches.start.size, dtype=complex)
    found = np.zeros((case.steps, grid.start.size), dtype=complex)

    def run() -> Complexes:
        before = voltage = grid.start
        for step in range(case.steps):
            grid.grid.update_powerlines_parameters(resistance[step], reactance[step], shunt, shunt)
            start = 2.0 * voltage - before if predicted else voltage
            before, voltage = voltage, grid.solve(start)
            found[step] = voltage
        return found[:, grid.bus]

    return run


def prepare_batch(case: Case, policy: RefactorPolicyType) -> Run:
    """Its time series in C++, in which only P and Q change."""
    grid = build_grid(case, build_branches(case), policy)
    series = TimeSeriesCPP(grid.grid)
    series.change_algorithm(ALGORITHM)
    series.set_algo_config(with_policy(series.get_algo_config(), policy))
    active_mw, reactive_mvar = case.power_va.real / 1e6, case.power_va.imag / 1e6

    def run() -> Complexes:
        series.modify_load_p(active_mw)
        series.modify_load_q(reactive_mvar)
        series.compute(grid.start, MOST_ITERATIONS, TOLERANCE)
        assert series.nb_converged() == series.nb_solved()
        found: Complexes = series.get_voltages()[:, grid.bus]
        return found

    return run
