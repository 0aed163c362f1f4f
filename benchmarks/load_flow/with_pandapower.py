"""pandapower: Newton's method in Python with numba, https://www.pandapower.org."""

from typing import Any

import numpy as np
import pandapower as pp

from load_flow.case import (
    BASE_IMPEDANCE_OHM,
    MOST_ITERATIONS,
    TOLERANCE,
    Branches,
    Case,
    Complexes,
    Run,
    build_branches,
)

BASE_MVA, BASE_KV = 10.0, 16.5
OPTIONS: dict[str, Any] = {
    "tolerance_mva": TOLERANCE * BASE_MVA,
    "max_iteration": MOST_ITERATIONS,
    "calculate_voltage_angles": True,
    "check_connectivity": False,
    "numba": True,
    "lightsim2grid": False,
}


def build_net(case: Case, branches: Branches) -> Any:
    """The net of a case's first step: each branch is a line, of length 1."""
    net = pp.create_empty_network(sn_mva=BASE_MVA)
    pp.create_buses(net, case.buses, vn_kv=BASE_KV)
    ohm = branches.impedance[0] * BASE_IMPEDANCE_OHM
    pp.create_lines_from_parameters(
        net, branches.start, branches.end, length_km=1.0, r_ohm_per_km=ohm.real,
        x_ohm_per_km=ohm.imag, c_nf_per_km=0.0, max_i_ka=1.0,
    )  # fmt: skip
    power_mva = case.power_va[0] / 1e6
    pp.create_loads(net, case.load_buses, p_mw=power_mva.real, q_mvar=power_mva.imag)
    for node in case.source_nodes:
        pp.create_ext_grid(net, int(node))
    pp.runpp(net, init="flat", **OPTIONS)
    return net


def prepare_moving(case: Case) -> Run:
    """Lengths of the lines replaced before each solve, which starts from the solution before."""
    branches = build_branches(case)
    net = build_net(case, branches)
    length = np.abs(branches.impedance) / np.abs(branches.impedance[0])
    voltage = np.zeros((case.steps, case.buses), dtype=complex)

    def run() -> Complexes:
        for step in range(case.steps):
            net.line["length_km"] = length[step]
            pp.runpp(net, init="results", **OPTIONS)
            found = net.res_bus
            voltage[step] = found.vm_pu * np.exp(1j * np.radians(found.va_degree))
        return voltage

    return run
