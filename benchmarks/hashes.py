"""Digests of what runs record, to hold two revisions of the program against each other.

A change that is to move no result prints the same lines before and after, on one machine: digests
depend on how the processor rounds, so they are no test.

    python benchmarks/hashes.py FOLDER... > before.txt

FOLDER holds scenarios, the examples by default.  Each is run as it is and with every choice of the
models (drivers, braking, load flow, power and gradient sampling, rails, machines, current limitation).
The values themselves are kept with ``--keep FILE.npz``, and ``--compare FILE.npz`` prints how far a
run is from kept ones, relative to the largest value of each variable.
"""

import argparse
import hashlib
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import tpss

EXAMPLES = Path(__file__).parents[1] / "examples"

CURRENT_LIMITATION = {"max_current_a": 120.0, "un_kv": 15.0, "umin2_kv": 11.0, "knee_factor": 0.9}

IN_WHOLE_STEPS: dict[str, object] = {
    "simulation.motion": "stepped",
    "simulation.braking": "whole-steps",
}

STEPPED: dict[str, dict[str, object]] = {
    "as it is": {},
    "within-step": {"simulation.braking": "within-step"},
    "within-step, 1 min": {"simulation.braking": "within-step", "simulation.time_step_min": 1.0},
    "0.05 min": {"simulation.time_step_min": 0.05},
    "aggressive": {"simulation.driver": "aggressive", "simulation.time_step_min": 0.05},
    "start": {"simulation.power_sampling": "start", "simulation.gradient_sampling": "start"},
    "wet": {"simulation.rail": "wet", "simulation.adhesion_speed_unit": "km/h"},
    "least squares": {
        "simulation.load_flow": "least-squares",
        "simulation.until": None,
        "simulation.duration_min": 5.0,
        "simulation.time_step_min": 0.5,
    },
    "double-bridge": {"trains.*.reactive_power": "double-bridge"},
    "power-factor": {"trains.*.reactive_power": "power-factor"},
    "former": {"trains.*.motor_voltage": "former", "trains.*.motor_current": "former"},
    "filter": {"trains.*.filter_reactance_ohm": -0.45},
    "current limitation": {"trains.*.current_limitation": CURRENT_LIMITATION},
    "loading": {"supply.converter_stations.0.control": "loading"},
}

CONTINUOUS: dict[str, dict[str, object]] = {
    f"continuous, {variant}": changes
    for variant, changes in STEPPED.items()
    if variant not in ("as it is", "within-step", "within-step, 1 min", "aggressive", "start")
} | {
    "continuous": {},
    "continuous, 1 min": {"simulation.time_step_min": 1.0},
    "continuous, 10 min": {"simulation.time_step_min": 10.0},
}

VARIANTS = {
    **{variant: IN_WHOLE_STEPS | changes for variant, changes in STEPPED.items()},
    **CONTINUOUS,
}


def scenarios(folders: list[Path]) -> Iterator[tuple[str, tpss.Scenario]]:
    """Scenarios of the folders with every variant that they admit, by name."""
    for file in sorted(file for folder in folders for file in folder.glob("*.toml")):
        try:
            scenario = tpss.load_scenario(file)
        except tpss.TpssError:
            continue  # a study, or a part of a scenario
        for variant, changes in VARIANTS.items():
            given = {
                key.replace("*", train): value
                for key, value in changes.items()
                for train in (scenario.trains if "*" in key else [""])
            }
            try:
                yield f"{file.name}: {variant}", scenario.with_(given)
            except tpss.ScenarioError:
                continue  # a machine without what the variant asks for


def recorded(scenario: tpss.Scenario) -> dict[str, np.ndarray]:
    """Everything that a run has recorded, by name."""
    dataset = tpss.simulate(scenario).dataset
    names = [*dataset.data_vars, "arrival_time"]
    return {str(name): np.ascontiguousarray(dataset[name].to_numpy()) for name in names}


def largest_difference(now: np.ndarray, before: np.ndarray) -> float:
    """Largest difference over the largest magnitude; infinite where shapes or gaps differ."""
    now, before = now.astype(float), before.astype(float)
    if now.shape != before.shape or not np.array_equal(np.isnan(now), np.isnan(before)):
        return np.inf
    if not np.isfinite(before).any():
        return 0.0
    return float(np.nanmax(np.abs(now - before)) / max(np.nanmax(np.abs(before)), 1e-300))


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("folders", nargs="*", type=Path, default=[EXAMPLES])
    parser.add_argument("--keep", type=Path, metavar="FILE.npz")
    parser.add_argument("--compare", type=Path, metavar="FILE.npz")
    given = parser.parse_args()
    kept: dict[str, np.ndarray] = {}
    before = np.load(given.compare) if given.compare else {}
    for name, scenario in scenarios(given.folders):
        values = recorded(scenario)
        digest = hashlib.sha256()
        for variable in sorted(values):
            if not before or f"{name}/{variable}" in before:
                digest.update(variable.encode() + values[variable].tobytes())
        line = f"{digest.hexdigest()[:16]}  {name}"
        common = [v for v in values if f"{name}/{v}" in before]
        if common:
            off = {v: largest_difference(values[v], before[f"{name}/{v}"]) for v in common}
            worst = max(off, key=off.__getitem__)
            line += f"  {off[worst]:.1e} {worst if off[worst] else ''}"
        print(line, flush=True)
        kept |= {f"{name}/{variable}": value for variable, value in values.items()}
    if given.keep:
        np.savez(given.keep, **kept)
    print(f"{len(kept)} arrays", file=sys.stderr)


if __name__ == "__main__":
    main()
