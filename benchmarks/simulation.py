"""Time whole simulations after compilation: medians of several runs.

Usage: python benchmarks/simulation.py [--runs N]
"""

import argparse
import platform
import statistics
import time
from pathlib import Path

import numba

import tpss

EXAMPLES = Path(__file__).parents[1] / "examples"
CASES = {
    "thesis_3_3 at 0.05 min": ("thesis_3_3.toml", {"simulation.time_step_min": 0.05}),
    "thesis_3_3": ("thesis_3_3.toml", {}),
    "thesis_160km": ("thesis_160km.toml", {}),
    "thesis_3_7_2": ("thesis_3_7_2.toml", {}),
    "at_headway_3": ("at_headway_3.toml", {}),
    "at_hv_headway_3": ("at_hv_headway_3.toml", {}),
}


def measure(file: str, changes: dict, runs: int) -> tuple[int, float, float]:
    """Steps, and medians of the run itself and of the whole call. [ms]"""
    scenario = tpss.load_scenario(EXAMPLES / file, changes)
    tpss.simulate(scenario)
    inner, whole = [], []
    for _ in range(runs):
        started = time.perf_counter()
        result = tpss.simulate(scenario)
        whole.append(1e3 * (time.perf_counter() - started))
        inner.append(1e3 * result.summary["simulation_s"])
    return result.dataset.sizes["time"] - 1, statistics.median(inner), statistics.median(whole)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=11)
    runs = parser.parse_args().runs
    print(f"Python {platform.python_version()}, numba {numba.__version__}, median of {runs} runs\n")
    print("| case | steps | simulation [ms] | with audit and dataset [ms] |\n|---|---|---|---|")
    for name, (file, changes) in CASES.items():
        steps, inner, whole = measure(file, changes, runs)
        print(f"| {name} | {steps} | {inner:.1f} | {whole:.1f} |")


if __name__ == "__main__":
    main()
