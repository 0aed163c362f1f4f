"""Time of a step over the number of trains and of fixed nodes; it has to be linear in both.

Usage: python benchmarks/scaling.py [--runs N]
"""

import argparse
import platform
import statistics
import time
from typing import Any

import numba
import numpy as np

import tpss
from tpss.model import build_model
from tpss.model.traffic import build_services
from tpss.simulation.run import compile_kernels, run_services

SPACING_KM = 80.0  # between converter stations; half-way between two stands a transformer
SPEED_KMH = 90.0
STEP_MIN, STEPS = 0.1, 300

STATIONS = (2, 3, 5, 9, 17, 33, 51)
SERIES = [
    # what grows, and converter stations and trains of each case
    ("trains", [(11, n) for n in (10, 20, 50, 100, 200, 500, 1000)]),
    ("fixed nodes", [(n, 20) for n in STATIONS]),
    ("trains, with as many fixed nodes a train", [(n, 10 * (n - 1)) for n in STATIONS]),
]
UPPER = 4
"""The slope is that of the last cases, where what a step costs anyhow weighs little."""


def scenario(stations: int, trains: int) -> tpss.Scenario:
    """A hilly line with railcars at equal distances; where one arrives, another one departs."""
    length_km = SPACING_KM * (stations - 1)
    distance_km = length_km / trains
    return tpss.Scenario.from_document(
        {
            "format": 1,
            "name": "scaling",
            "simulation": {"time_step_min": STEP_MIN, "duration_min": STEPS * STEP_MIN},
            "line": line(length_km),
            "supply": supply(stations),
            "trains": {"railcar": RAILCAR},
            "traffic": [
                {
                    "name": "eastbound",
                    "train": "railcar",
                    "from": "West",
                    "to": "East",
                    "headway_min": 60.0 * distance_km / SPEED_KMH,
                    # Whoever departed first is furthest.
                    "initial_trains": [
                        {"position_km": distance_km * (k + 0.5), "speed_kmh": SPEED_KMH}
                        for k in reversed(range(trains))
                    ],
                }
            ],
        }
    )


RAILCAR = {
    "model": "Rc4-freight-1470t",
    "mass_t": 160.0,
    "resistance_a_n": 1500.0,
    "resistance_b_n_s_per_m": 30.0,
    "resistance_c_n_s2_per_m2": 5.0,
    "auxiliary_power_kw": 40.0,
}
"""So light that a thousand of them do not overload the line."""


def line(length_km: float) -> dict[str, Any]:
    """5 km up and 5 km down, at one speed limit."""
    return {
        "length_km": length_km,
        "gradients": [
            {"from_km": 5.0 * k, "permille": 8.0 * (-1) ** k} for k in range(int(length_km / 5.0))
        ],
        "speed_limits": [{"from_km": 0.0, "speed_kmh": SPEED_KMH}],
        "stations": [
            {"name": "West", "position_km": 0.0},
            {"name": "East", "position_km": length_km},
        ],
    }


def supply(stations: int) -> dict[str, Any]:
    """A ladder of two nodes at each converter station and at each transformer."""
    return {
        "frequency_hz": 16.7,
        "catenary": "BT",
        "high_voltage_line": {"type": "132kV", "transformers": 1},
        "converter_stations": [
            {
                "name": f"Converter {k}",
                "position_km": SPACING_KM * k,
                "type": "Q48/Q49",
                "converters": 6,
            }
            for k in range(stations)
        ],
    }


def measure(stations: int, trains: int, runs: int) -> tuple[int, float, float]:
    """Fixed nodes, load-flow passes a step, and median time of a step. [µs]

    Processor time of what the summary of a result gives as ``simulation_s``; other programs on the
    machine hardly change it.
    """
    case = scenario(stations, trains)
    model, _ = build_model(case)
    services = build_services(case, model)
    compile_kernels(model)
    times = []
    for _ in range(runs):
        started = time.process_time()
        outcome = run_services(model, services, STEPS)
        times.append(1e6 * (time.process_time() - started) / STEPS)
        assert outcome.status == "finished"
    nodes, passes = outcome.recording.nodes.shape[1], outcome.recording.passes[:STEPS]
    return nodes, float(passes.mean()), statistics.median(times)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=11)
    runs = parser.parse_args().runs
    print(f"Python {platform.python_version()}, numba {numba.__version__}, median of {runs} runs\n")
    print("| trains | fixed nodes | passes a step | time of a step [µs] |\n|---|---|---|---|")
    slopes = {}
    for growing, cases in SERIES:
        sizes, times = [], []
        for stations, trains in cases:
            nodes, passes, time_us = measure(stations, trains, runs)
            print(f"| {trains} | {nodes} | {passes:.1f} | {time_us:.1f} |")
            sizes.append(nodes if growing == "fixed nodes" else trains)
            times.append(time_us)
        slopes[growing] = np.polyfit(np.log(sizes[-UPPER:]), np.log(times[-UPPER:]), 1)[0]
    print(f"\nSlopes of the last {UPPER} cases on logarithmic axes (1: linear):\n")
    for growing, slope in slopes.items():
        print(f"- over the {growing}: {slope:.2f}")


if __name__ == "__main__":
    main()
