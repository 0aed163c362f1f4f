"""Time of a step over the number of trains and of fixed nodes; it has to be linear in both.

Usage: python benchmarks/scaling.py [--runs N] [--publish]

With ``--publish`` the figure is drawn too, which needs matplotlib (``pip install ".[bench]"``).
"""

import statistics
import time
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

import tpss
from tpss.model import build_model
from tpss.model.traffic import build_services
from tpss.run.kernels import make_ready
from tpss.run.run import advance_to_end, run_of
from tpss.run.start import begin

from report import FIGURES, arguments, caption, deliver, machine, stay_on_one_core, table

SPACING_KM = 80.0  # between converter stations
SPEED_KMH = 90.0
STOPPING_KM = 2.0  # no train begins so near to the end
STEP_MIN, STEPS = 0.1, 300

LONGEST = 26
"""Stations of a line of 2,000 km."""
NODE_CASES = [(2, 1), (3, 1), (6, 1), (13, 1), (LONGEST, 1), (LONGEST, 4), (LONGEST, 9)]
"""Stations, and transformers between neighbouring ones."""
SERIES = {
    # what grows; stations, transformers between neighbouring ones, and trains
    "trains": [(LONGEST, 1, n) for n in (10, 20, 50, 100, 200, 500, 1000, 2000, 5000)],
    "fixed nodes": [(*case, 20) for case in NODE_CASES],
    "trains and fixed nodes": [
        (*case, n) for case, n in zip(NODE_CASES, (10, 20, 50, 120, 250, 625, 1250), strict=True)
    ],
}
UPPER = 4
"""The slope is that of the last cases, where what a step costs anyhow weighs little."""
STEEPEST = 1.1
STATED = 500
"""Number of trains for which the time of a train and step is stated."""


@dataclass(frozen=True)
class Point:
    """A case and what it took."""

    trains: int
    nodes: int
    passes: float
    """Evaluations of the network a step."""
    time_us: float
    """Processor time of a step."""


def scenario(stations: int, transformers: int, trains: int) -> tpss.Scenario:
    """A hilly line with railcars at equal distances; where one arrives, another one departs."""
    length_km = SPACING_KM * (stations - 1)
    distance_km = (length_km - STOPPING_KM) / trains
    return tpss.Scenario.from_document(
        {
            "format": 1,
            "name": "scaling",
            "simulation": {
                "time_step_min": STEP_MIN,
                "duration_min": STEPS * STEP_MIN,
                "motion": "stepped",
                "braking": "whole-steps",
            },
            "line": line(length_km),
            "supply": supply(stations, transformers),
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
    "mass_t": 60.0,
    "adhesive_mass_t": 30.0,
    "resistance_a_n": 600.0,
    "resistance_b_n_s_per_m": 12.0,
    "resistance_c_n_s2_per_m2": 2.5,
    "auxiliary_power_kw": 20.0,
}
"""So light that five thousand of them do not overload the line."""


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


def supply(stations: int, transformers: int) -> dict[str, Any]:
    """A ladder of two nodes at each converter station and at each transformer."""
    return {
        "frequency_hz": 16.7,
        "catenary": "BT",
        "high_voltage_line": {"type": "132kV", "transformers": transformers},
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


def measure(stations: int, transformers: int, trains: int, runs: int) -> Point:
    """Median over some runs of what the summary of a result gives as ``simulation_s``."""
    case = scenario(stations, transformers, trains)
    model, _ = build_model(case)
    make_ready(model)
    start = begin(model, build_services(case, model), STEPS)
    times = []
    for _ in range(runs):
        started = time.process_time()
        run = run_of(start)
        status = advance_to_end(run, start)
        times.append(1e6 * (time.process_time() - started) / STEPS)
        assert status == "finished"
    nodes, passes = run.recording.nodes.shape[1], run.recording.passes[:STEPS]
    return Point(trains, nodes, float(passes.mean()), statistics.median(times))


def size(point: Point, growing: str) -> int:
    return point.nodes if growing == "fixed nodes" else point.trains


def fit(points: list[Point], growing: str) -> tuple[float, float]:
    """Slope and logarithm of the factor of the straight line on logarithmic axes."""
    sizes, times = zip(*((size(p, growing), p.time_us) for p in points[-UPPER:]), strict=True)
    slope, factor = np.polyfit(np.log(sizes), np.log(times), 1)
    return float(slope), float(factor)


def draw(found: dict[str, list[Point]]) -> None:
    """All series with their straight lines, on logarithmic axes."""
    import matplotlib as mpl
    from matplotlib import pyplot as plt

    mpl.rcParams.update({"svg.hashsalt": "tpss", "svg.fonttype": "none", "font.size": 9})
    figure, axes = plt.subplots(
        1, len(found), figsize=(9.0, 3.4), sharey=True, layout="constrained"
    )
    for axis, (growing, points) in zip(axes, found.items(), strict=True):
        slope, factor = fit(points, growing)
        sizes = np.array([size(point, growing) for point in points])
        axis.loglog(sizes, [point.time_us for point in points], "o", color="#3949ab")
        upper = sizes[-UPPER:]
        axis.loglog(upper, np.exp(factor) * upper**slope, color="#ef6c00")
        axis.set(
            xlabel=f"number of {growing}"
            if growing != "trains and fixed nodes"
            else "number of trains, fixed nodes with them",
            title=f"slope {slope:.2f}",
        )
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("time of a step [µs]")
    FIGURES.mkdir(exist_ok=True)
    figure.savefig(FIGURES / "scaling.svg", metadata={"Date": None})
    plt.close(figure)


def main() -> None:
    options = arguments(__doc__, runs=9)
    stay_on_one_core()
    found = {
        growing: [measure(*case, options.runs) for case in cases]
        for growing, cases in SERIES.items()
    }
    slopes = {growing: fit(points, growing)[0] for growing, points in found.items()}
    stated = next(p.time_us for p in found["trains"] if p.trains == STATED) / STATED * 1e3
    where = machine()
    result = {
        "machine": where,
        "runs": options.runs,
        "steps": STEPS,
        "slopes": slopes,
        "ns_a_train_and_step": {STATED: stated},
        "points": {growing: [asdict(p) for p in points] for growing, points in found.items()},
    }
    if options.publish:
        draw(found)
    deliver(
        "scaling", result, describe(found, slopes, stated, options.runs, where), options.publish
    )


def describe(
    found: dict[str, list[Point]], slopes: dict[str, float], stated_ns: float, runs: int,
    where: dict[str, str],
) -> str:  # fmt: skip
    """Tables of all points and slopes."""
    rows = [
        (growing, f"{p.trains:,}", f"{p.nodes}", f"{p.passes:.1f}", f"{p.time_us:,.1f}",
         f"{1e3 * p.time_us / p.trains:,.0f}")
        for growing, points in found.items()
        for p in points
    ]  # fmt: skip
    head = ("growing", "trains", "fixed nodes", "passes a step", "step [µs]", "step and train [ns]")
    verdicts = [
        (growing, f"{slope:.2f}", "yes" if slope <= STEEPEST else "no")
        for growing, slope in slopes.items()
    ]
    return "\n\n".join(
        [
            table(("growing", "slope", f"at most {STEEPEST}"), verdicts),
            f"A step takes {stated_ns:.0f} ns a train with {STATED} trains.",
            table(head, rows),
            f"Median of {runs} runs of {STEPS} steps; slopes of the last {UPPER} cases. "
            f"{caption(where)}",
        ]
    )


if __name__ == "__main__":
    main()
