"""Time many scenarios: in threads by `tpss.simulate_many`, and as a study on a local Dask cluster.

Usage: python benchmarks/many.py [--cases N] [--publish]
"""

import os
import resource
import tempfile
import time
from collections.abc import Iterable
from itertools import repeat
from pathlib import Path
from typing import Any

import tomli_w

import tpss

from report import arguments, caption, deliver, machine, table

EXAMPLES = Path(__file__).parents[1] / "examples"
STEPPED = {"simulation.motion": "stepped", "simulation.braking": "whole-steps"}
FINE = {"simulation.time_step_min": 0.05, **STEPPED}
FIVE_MINUTES = {**FINE, "simulation.until": None, "simulation.duration_min": 5.0}
COARSE = {"simulation.time_step_min": 1.0, **STEPPED}
SHARE = {"2,032 steps": 0.1, "100 steps of 0.05 min": 1.0, "100 steps of 1 min": 1.0}
"""Share of the cases that are run, as some are longer."""

STUDY: dict[str, Any] = {
    "format": 1,
    "name": "throughput",
    "scenario": str(EXAMPLES / "thesis_160km.toml"),
    "design": "sobol",
    "set": COARSE,
    "vary": {
        "traffic.0.headway_min": {"low": 8.0, "high": 14.0},
        "supply.converter_stations.*.converters": [2, 3, 4, 6],
        "trains.freight.mass_t": {"low": 1000.0, "high": 1470.0},
        "line.speed_limits.*.speed_kmh": {"low": 80.0, "high": 110.0},
    },
    "gradients": {
        "mean_permille": {"low": -1.0, "high": 1.0},
        "standard_deviation_permille": {"low": 0.0, "high": 4.0},
    },
}
"""Cases of about ten trains on 160 km, each with a gradient profile of its own."""


def peak_mib() -> float:
    """Most memory that this process has had. [MiB]"""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def rate(items: Iterable[Any], count: int, threads: int | None = None) -> float:
    """Cases a second."""
    started = time.perf_counter()
    for _ in tpss.simulate_many(items, threads):
        pass
    return count / (time.perf_counter() - started)


def in_threads(cases: int) -> dict[str, dict[str, float]]:
    """Cases a second of prepared models in one thread and in all, and of scenarios in all."""
    line = tpss.load_scenario(EXAMPLES / "thesis_3_3.toml")
    found = {}
    for name, changes in zip(SHARE, (FINE, FIVE_MINUTES, COARSE), strict=True):
        scenario, count = line.with_(changes), max(10, round(cases * SHARE[name]))
        prepared = tpss.prepare(scenario)
        rate(repeat(prepared, 10), 10)
        before = peak_mib()
        found[name] = {
            "prepared, one thread": rate(repeat(prepared, count), count, 1),
            "prepared": rate(repeat(prepared, count), count),
            "from scenarios": rate(repeat(scenario, count), count),
            "memory grew [MiB]": peak_mib() - before,
        }
    return found


def as_study(cases: int) -> dict[str, float]:
    """Cases a second of a study in its middle part, overhead there, memory of scheduler and client."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "study.toml"
        file.write_text(tomli_w.dumps({**STUDY, "cases": cases}), "utf-8")
        memory_mib: list[float] = []
        ended = tpss.run_study(
            tpss.load_study(file),
            Path(folder) / "out",
            report=lambda _: memory_mib.append(peak_mib()),
        )
        rows = tpss.load_table(Path(folder) / "out")
    when = rows["timing.ended"]
    inner = rows[(when > when.quantile(0.2)) & (when <= when.quantile(0.8))]
    span_s = (inner["timing.ended"].max() - inner["timing.ended"].min()).total_seconds()
    busy_s = (inner["timing.build_s"] + inner["timing.run_s"]).sum()
    return {
        "cases": cases,
        "trains on the line": (rows.trip_time_min / rows.headway_min).mean(),
        "cases a second": len(inner) / span_s,
        "with the start of the cluster": cases / ended.elapsed_s,
        "overhead [%]": 100.0 * (1.0 - busy_s / (span_s * os.cpu_count())),
        "memory grew [MiB]": memory_mib[-1] - memory_mib[0],
    }


def main() -> None:
    options = arguments(__doc__, cases=2000)
    threads, study, where = (
        in_threads(options.cases),
        as_study(4 * options.cases),
        machine("distributed"),
    )
    head = ("case", *next(iter(threads.values())))
    rows = [
        (name, *(f"{value:,.0f}" for value in found.values())) for name, found in threads.items()
    ]
    of_study = [tuple(f"{value:,.4g}" for value in study.values())]
    text = (
        f"Cases a second by `tpss.simulate_many`, about ten trains, audit included:\n\n"
        f"{table(head, rows)}\n\n"
        "A study of `tpss sweep`, 160 km in steps of 1 min, each case another scenario with a "
        f"gradient profile of its own:\n\n{table(tuple(study), of_study)}\n\n{caption(where)}"
    )
    deliver("many", {"machine": where, "threads": threads, "study": study}, text, options.publish)


if __name__ == "__main__":
    main()
