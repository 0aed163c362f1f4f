"""Time of a train and step in a network: twenty double-track lines, five hundred trains both ways.

Usage: python benchmarks/network.py [--runs N] [--publish]
"""

import statistics
import time
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

import tpss
from tpss.model import build_model
from tpss.model.start import start_of
from tpss.run.kernels import make_ready
from tpss.run.run import advance_to_end, run_of
from tpss.step.state import TrainState

from report import arguments, caption, deliver, machine, stay_on_one_core, table

LINES, LENGTH_KM, TRAINS = 20, 80.0, 500
STEPS_MIN, DURATION_MIN = (0.05, 0.1), 60.0
"""Steps of 3 s are one phase for most trains, those of 6 s are several while a train accelerates."""

BORDER_KM = LENGTH_KM / 2.0
"""Where a line meets the one it hangs from; every line has a feeding station at its far end."""


def scenario(step_min: float, trains: int = TRAINS) -> tpss.Scenario:
    """A tree of lines, each from the middle of an earlier one, with posts every 15 km.

    Railcars run all along each line, in both directions, at equal distances in time.
    """
    each = trains // (2 * LINES)
    return tpss.Scenario.from_document(
        {
            "format": 1,
            "name": "network",
            "simulation": {"time_step_min": step_min, "duration_min": DURATION_MIN},
            "lines": {f"line {i}": _line(i) for i in range(LINES)},
            "supply": {
                "catenary": {"r_ohm_per_km": 0.12, "x_ohm_per_km": 0.13},
                "tracks_tied": "posts",
                "converter_stations": _stations(),
                "posts": [
                    {"name": f"post {i} {k}", "line": f"line {i}", "position_km": 8.0 + 15.0 * k}
                    for i in range(LINES)
                    for k in range(5)
                ],
            },
            "trains": {"railcar": RAILCAR},
            "traffic": [
                {
                    "name": f"{i} {way}",
                    "train": "railcar",
                    "from": ends[0],
                    "to": ends[1],
                    "headway_min": LENGTH_KM / 100.0 * 60.0 / each,
                    "already_running": True,
                }
                for i in range(LINES)
                for way, ends in (("up", _ends(i)), ("down", _ends(i)[::-1]))
            ],
        },
        "network",
    )


def _ends(i: int) -> tuple[str, str]:
    return f"begin {i}" if i == 0 else f"middle {(i - 1) // 2}", f"end {i}"


def _line(i: int) -> dict[str, Any]:
    begin, end = _ends(i)
    hills = np.random.default_rng(i).uniform(-6.0, 6.0, 40)
    return {
        "length_km": LENGTH_KM,
        "tracks": 2,
        "gradients": [{"from_km": 2.0 * k, "permille": float(g)} for k, g in enumerate(hills)],
        "speed_limits": [{"from_km": 0.0, "speed_kmh": 120.0}],
        "stations": [
            {"name": begin, "position_km": 0.0},
            {"name": f"middle {i}", "position_km": BORDER_KM},
            {"name": end, "position_km": LENGTH_KM},
        ],
    }


def _stations() -> list[dict[str, Any]]:
    kind = {"type": "Q48/Q49", "converters": 6}
    ends = [
        {"name": f"far {i}", "line": f"line {i}", "position_km": 75.0, **kind} for i in range(LINES)
    ]
    middles = [
        {"name": f"near {i}", "line": f"line {i}", "position_km": 20.0, **kind} for i in range(10)
    ]
    return [*ends, *middles]


RAILCAR = {
    "mass_t": 110.0,
    "adhesive_mass_t": 55.0,
    "max_speed_kmh": 120.0,
    "max_retardation_m_s2": 0.6,
    "resistance_a_n": 1500.0,
    "resistance_b_n_s_per_m": 20.0,
    "resistance_c_n_s2_per_m2": 6.0,
    "rotating_mass_share": 0.07,
    "tractive_effort": {"max_force_kn": 90.0, "max_power_kw": 1600.0},
    "power_factor": 0.98,
    "efficiency": 0.86,
    "auxiliary_power_kw": 60.0,
}


@dataclass(frozen=True)
class Point:
    """A time step, and what runs with it took."""

    step_min: float
    sections: int
    nodes: int
    trains: float
    """On their way at a time, on average."""
    steps: int
    passes: float
    """Evaluations of the network a step."""
    run_ms: float
    """Median of the processor time of a run."""
    train_step_ns: float
    """Least processor time of a train and step."""


def measure(step_min: float, runs: int) -> Point:
    """Run the network several times with a time step."""
    model, _ = build_model(scenario(step_min))
    start = start_of(scenario(step_min), model)
    times = []
    for _ in range(runs):
        run = run_of(start)
        began = time.process_time()
        status = advance_to_end(run, start)
        times.append(time.process_time() - began)
        assert status == "finished"
    state = run.recording.train_state[: run.step]
    train_steps = int(((state >= 0) & (state != TrainState.ARRIVED)).sum())
    return Point(
        step_min=step_min,
        sections=len(model.network.sections),
        nodes=model.network.source_of_node.size,
        trains=train_steps / run.step,
        steps=run.step,
        passes=float(run.recording.passes[: run.step].mean()),
        run_ms=1e3 * statistics.median(times),
        train_step_ns=1e9 * min(times) / train_steps,
    )


def main() -> None:
    options = arguments(__doc__, runs=7)
    where = machine()
    stay_on_one_core()
    make_ready(build_model(scenario(STEPS_MIN[0]))[0])
    points = [measure(step_min, options.runs) for step_min in STEPS_MIN]
    head = ("step [min]", "sections", "nodes", "trains", "steps", "passes a step", "run [ms]",
            "step and train [ns]")  # fmt: skip
    rows = [
        (f"{p.step_min:g}", f"{p.sections}", f"{p.nodes}", f"{p.trains:.0f}", f"{p.steps:,}",
         f"{p.passes:.1f}", f"{p.run_ms:.0f}", f"{p.train_step_ns:.0f}")
        for p in points
    ]  # fmt: skip
    text = f"{table(head, rows)}\n\nOf {options.runs} runs. {caption(where)}"
    result = {"machine": where, "points": [asdict(p) for p in points]}
    deliver("network", result, text, options.publish)


if __name__ == "__main__":
    main()
