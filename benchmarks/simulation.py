"""Time whole simulations after compilation: medians of several runs.

Each in stepped motion, as the thesis has it, and in continuous motion, the default.

Usage: python benchmarks/simulation.py [--runs N] [--publish]
"""

import statistics
import time
from pathlib import Path

import tpss

from report import arguments, caption, deliver, machine, stay_on_one_core, table

EXAMPLES = Path(__file__).parents[1] / "examples"
STEPPED = {"simulation.motion": "stepped", "simulation.braking": "whole-steps"}
LINES = {
    "thesis_3_3 at 0.05 min": ("thesis_3_3.toml", {"simulation.time_step_min": 0.05}),
    "thesis_3_3": ("thesis_3_3.toml", {}),
    "thesis_160km": ("thesis_160km.toml", {}),
    "thesis_3_7_2": ("thesis_3_7_2.toml", {}),
    "at_headway_3": ("at_headway_3.toml", {}),
    "at_hv_headway_3": ("at_hv_headway_3.toml", {}),
}
CASES = {name: (file, changes | STEPPED) for name, (file, changes) in LINES.items()} | {
    f"{name}, continuous": case for name, case in LINES.items()
}


def measure(file: str, changes: dict, runs: int) -> tuple[int, float, float]:
    """Steps, and medians of the steps themselves and of the whole call. [ms]"""
    scenario = tpss.load_scenario(EXAMPLES / file, changes)
    tpss.simulate(scenario)
    inner, whole = [], []
    for _ in range(runs):
        started = time.perf_counter()
        result = tpss.simulate(scenario)
        whole.append(1e3 * (time.perf_counter() - started))
        inner.append(1e3 * result.figures["simulation_s"])
    return result.dataset.sizes["time"] - 1, statistics.median(inner), statistics.median(whole)


def main() -> None:
    options = arguments(__doc__, runs=11)
    stay_on_one_core()
    found = {name: measure(file, changes, options.runs) for name, (file, changes) in CASES.items()}
    where = machine()
    result = {
        "machine": where,
        "runs": options.runs,
        "cases": {
            name: {
                "steps": steps,
                "simulation_ms": inner,
                "whole_ms": whole,
                "whole_over_simulation": whole / inner,
            }
            for name, (steps, inner, whole) in found.items()
        },
    }
    rows = [
        (name, f"{n:,}", f"{inner:.1f}", f"{whole:.1f}", f"{whole / inner:.2f}")
        for name, (n, inner, whole) in found.items()
    ]
    head = ("case", "steps", "simulation [ms]", "with audit and dataset [ms]", "ratio")
    text = f"{table(head, rows)}\n\nMedian of {options.runs} runs. {caption(where)}"
    deliver("simulation", result, text, options.publish)


if __name__ == "__main__":
    main()
