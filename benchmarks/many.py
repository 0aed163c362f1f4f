"""Time many scenarios: in threads by `tpss.simulate_many`, as a study, and as cases of a plan.

Usage: python benchmarks/many.py [--cases N] [--publish]
"""

import os
import resource
import tempfile
import time
import tomllib
from collections.abc import Iterable
from itertools import repeat
from pathlib import Path
from typing import Any

import tomli_w

import tpss
from tpss.planning.cases import CaseList, distinct
from tpss.planning.documents import run_documents, warm_up
from tpss.planning.load import load_plan

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

HEADWAYS_MIN = (20.0, 24.0, 30.0, 32.0, 36.0, 40.0, 45.0, 48.0, 50.0, 54.0, 60.0, 64.0, 72.0, 75.0,
                80.0, 90.0, 96.0, 100.0, 120.0, 144.0)  # fmt: skip
"""Traffic of a plan's cases."""


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


def as_plan() -> dict[str, float]:
    """Cases of a plan a second of one core's time: 16 supplies of 320 km, intact and with an outage."""
    document = tomllib.loads((EXAMPLES / "plan_320km.toml").read_text("utf-8"))
    document["scenario"] = str(EXAMPLES / document["scenario"])
    stages = len(document["stages"]["start"])
    share = 1.0 / len(HEADWAYS_MIN)
    document["scenarios"] = {
        f"every-{headway:g}-min": {
            "probability": share,
            "traffic": {"eastbound": {"headway_min": [headway] * stages}},
        }
        for headway in HEADWAYS_MIN
    }
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "plan.toml"
        file.write_text(tomli_w.dumps(document), "utf-8")
        cases = CaseList(load_plan(file))
        wanted = distinct(cases.cases)
        sent = [(case, cases.document(case)) for case in wanted]
    how = cases.plan.file.evaluate.model_dump_json()
    warm_up(sent[:1], how)
    times_s = []
    for _ in range(3):
        started = time.process_time()
        rows = run_documents(sent, how)
        times_s.append(time.process_time() - started)
    return {
        "cases": len(wanted),
        "steps of a case": sum(row["steps"] for row in rows) / len(rows),
        "cases a second and core": len(wanted) / min(times_s),
    }


def main() -> None:
    options = arguments(__doc__, cases=2000)
    threads, study, plan, where = (
        in_threads(options.cases),
        as_study(4 * options.cases),
        as_plan(),
        machine("distributed"),
    )
    head = ("case", *next(iter(threads.values())))
    rows = [
        (name, *(f"{value:,.0f}" for value in found.values())) for name, found in threads.items()
    ]
    of_study, of_plan = (
        [tuple(f"{value:,.4g}" for value in each.values())] for each in (study, plan)
    )
    text = (
        f"Cases a second by `tpss.simulate_many`, about ten trains, audit included:\n\n"
        f"{table(head, rows)}\n\n"
        "A study of `tpss sweep`, 160 km in steps of 1 min, each case another scenario with a "
        f"gradient profile of its own:\n\n{table(tuple(study), of_study)}\n\n"
        "Cases of a plan in one process, 320 km in steps of 1 min, 16 supplies, intact and with an "
        f"outage, each run to its steady state:\n\n{table(tuple(plan), of_plan)}\n\n{caption(where)}"
    )
    found = {"machine": where, "threads": threads, "study": study, "plan": plan}
    deliver("many", found, text, options.publish)


if __name__ == "__main__":
    main()
