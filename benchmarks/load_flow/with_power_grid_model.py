"""power-grid-model: load flow in C++, https://github.com/PowerGridModel/power-grid-model.

Its tolerance is the change of a voltage in the last iteration, and every solve has a start of its own.
Each line and load has its place in all records; updates change loads and sources, never a line.
"""

from typing import Any

import numpy as np
from power_grid_model import CalculationMethod, LoadGenType, PowerGridModel, initialize_array

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

RATED_V = 16_500.0
STIFF_VA = 1e20
"""Short-circuit power of the sources."""

METHODS = {
    "Newton": CalculationMethod.newton_raphson,
    "iterative current": CalculationMethod.iterative_current,
}


def build_input(case: Case, branches: Branches, step: int) -> dict[str, Any]:
    """Input data of one step."""
    n_lines, n_sources = branches.start.size, case.source_nodes.size
    numbers = np.split(
        np.arange(case.buses + n_lines + n_sources + case.trains, dtype=np.int32),
        np.cumsum([case.buses, n_lines, n_sources]),
    )
    ohm = branches.impedance[step] * BASE_IMPEDANCE_OHM
    columns: dict[str, dict[str, Any]] = {
        "node": {"u_rated": RATED_V},
        "line": {
            "from_node": branches.start, "to_node": branches.end, "from_status": 1, "to_status": 1,
            "r1": ohm.real, "x1": ohm.imag, "c1": 0.0, "tan1": 0.0, "i_n": 1e3,
        },
        "source": {"node": case.source_nodes, "status": 1, "u_ref": 1.0, "sk": STIFF_VA},
        "sym_load": {
            "node": case.load_buses, "status": 1, "type": LoadGenType.const_power,
            "p_specified": case.power_va[step].real, "q_specified": case.power_va[step].imag,
        },
    }  # fmt: skip
    tables = {}
    for (component, values), ids in zip(columns.items(), numbers, strict=True):
        tables[component] = initialize_array("input", component, ids.size)
        for name, column in {"id": ids, **values}.items():
            tables[component][name] = column
    return tables


def solve(model: PowerGridModel, method: str, **updates: Any) -> Complexes:
    """Voltages of all buses, in one thread."""
    found = model.calculate_power_flow(
        calculation_method=METHODS[method], error_tolerance=TOLERANCE,
        max_iterations=MOST_ITERATIONS, threading=-1,
        output_component_types={"node": ["u_pu", "u_angle"]}, **updates,
    )["node"]  # fmt: skip
    voltage: Complexes = found["u_pu"] * np.exp(1j * found["u_angle"])
    return voltage


def prepare_batch(case: Case, method: str) -> Run:
    """Its batch calculation in C++, in which only P and Q change."""
    tables = build_input(case, build_branches(case), 0)
    model = PowerGridModel(tables)
    loads = initialize_array("update", "sym_load", case.power_va.shape)
    loads["id"] = tables["sym_load"]["id"]
    loads["p_specified"], loads["q_specified"] = case.power_va.real, case.power_va.imag
    return lambda: solve(model, method, update_data={"sym_load": loads})


def prepare_moving(case: Case, method: str) -> Run:
    """A new model for each step."""
    branches = build_branches(case)
    tables = [build_input(case, branches, step) for step in range(case.steps)]
    return lambda: np.array([solve(PowerGridModel(table), method) for table in tables])
