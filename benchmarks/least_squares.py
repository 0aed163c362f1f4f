"""The thesis's Table 3-3: the original load flow, a least-squares problem, beside the equations.

Times are processor time of the run itself, in one thread, which other programs on the machine hardly
change; the thesis's are of GAMS with CONOPT (DNLP and CNS).

Usage: python benchmarks/least_squares.py [--runs N]
"""

import argparse
import os
import platform
import statistics
import time
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # more threads only wait for each other here

import numpy as np
import scipy

import tpss
from tpss.original.least_squares import advance_by_least_squares
from tpss.run.run import advance_to_end, run_of
from tpss.step.advance import advance

CLOCKS = {"equations": advance, "least-squares": advance_by_least_squares}
EXAMPLE = Path(__file__).parents[1] / "examples" / "thesis_3_3.toml"
IN_WHOLE_STEPS = {"simulation.motion": "stepped", "simulation.braking": "whole-steps"}
"""As the thesis's trains move."""
THESIS_S = {1.0: (56, 46), 0.5: (108, 92), 0.2: (274, 230), 0.1: (541, 459), 0.05: (1084, 925)}
"""Time step: running times with the optimisation and with the equations. [min]: [s], [s]"""


def measure(step_min: float, load_flow: str, runs: int) -> tuple[tpss.Result, float]:
    """The result, and the median time of the run itself. [ms]"""
    changes = {"simulation.time_step_min": step_min, "simulation.load_flow": load_flow}
    changes |= IN_WHOLE_STEPS
    scenario = tpss.load_scenario(EXAMPLE, changes)
    result = tpss.simulate(scenario)
    start = tpss.prepare(scenario).start
    times = []
    for _ in range(runs):
        started = time.process_time()
        advance_to_end(run_of(start, CLOCKS[load_flow]), start)
        times.append(1e3 * (time.process_time() - started))
    return result, statistics.median(times)


def difference(a: tpss.Result, b: tpss.Result) -> float:
    """Largest difference of a voltage or power at any step, in per unit of 16.5 kV and 10 MVA."""
    scales = {"pantograph_voltage": 16.5e3, "active_power": 10e6, "reactive_power": 10e6}
    scales |= {"station_active_power": 10e6, "station_reactive_power": 10e6}
    return max(
        float(np.nanmax(abs(a.dataset[name].to_numpy() - b.dataset[name].to_numpy()))) / scale
        for name, scale in scales.items()
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=3)
    runs = parser.parse_args().runs
    print(
        f"Python {platform.python_version()}, scipy {scipy.__version__}, median of {runs} runs\n\n"
        "| step [min] | trip [min] | West, East [MWh] | least squares [ms] | equations [ms] | ratio "
        "| largest difference [p.u.] | thesis [s] | its ratio |\n|---|---|---|---|---|---|---|---|---|"
    )
    for step_min, (thesis_old, thesis_new) in THESIS_S.items():
        by_squares, old_ms = measure(step_min, "least-squares", runs)
        by_equations, new_ms = measure(step_min, "equations", runs)
        energies = ", ".join(f"{e:.4f}" for e in by_squares.stations.energy_mwh)
        print(
            f"| {step_min:g} | {by_squares.summary['trip_time_min']:.2f} | {energies} "
            f"| {old_ms:.0f} | {new_ms:.1f} | {old_ms / new_ms:.0f} "
            f"| {difference(by_squares, by_equations):.0e} "
            f"| {thesis_old}, {thesis_new} | {thesis_old / thesis_new:.2f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
