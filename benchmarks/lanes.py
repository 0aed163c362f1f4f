"""Time cases in lanes beside the same cases alone, in turns, in one thread: `tpss.simulate_many`.

Usage: python benchmarks/lanes.py [--cases N] [--turns N] [--publish]
"""

import time
from collections import Counter
from itertools import cycle, islice
from pathlib import Path
from statistics import median
from typing import Any

import tpss
from tpss.api import Prepared, build

from report import arguments, caption, deliver, machine, stay_on_one_core, table

EXAMPLES = Path(__file__).parents[1] / "examples"
STEPPED = {"simulation.motion": "stepped", "simulation.braking": "whole-steps"}
FINE = {"simulation.time_step_min": 0.05, **STEPPED}
MASSES = [{"trains.freight.mass_t": 1000.0 + 50.0 * k} for k in range(8)]
CASES: dict[str, tuple[str, dict[str, Any], list[dict[str, Any]]]] = {
    "2,032 steps, the same case": ("thesis_3_3", FINE, [{}] * 8),
    "2,032 steps, eight masses": ("thesis_3_3", FINE, MASSES),
    "2,032 steps, headways of 9.6 to 10.3 min": (
        "thesis_3_3", FINE, [{"traffic.0.headway_min": 9.6 + 0.1 * k} for k in range(8)],
    ),
    "2,032 steps, headways of 8 to 13 min": (
        "thesis_3_3", FINE, [{"traffic.0.headway_min": 8.0 + 0.75 * k} for k in range(8)],
    ),
    "1,016 steps, eight masses": ("thesis_3_3", STEPPED, MASSES),
    "300 steps, 50 trains, eight masses": ("at_headway_3", STEPPED, MASSES),
}  # fmt: skip
"""Example, what is changed in all cases, and in each."""


def time_of(cases: list[Prepared], lanes: bool) -> tuple[float, Counter[str]]:
    """Processor time of a case [ms], and which ways they went."""
    started = time.process_time()
    ways = Counter(each.way for each in tpss.simulate_many(cases, 1, lanes=lanes))
    return 1e3 * (time.process_time() - started) / len(cases), ways


def measure(name: str, count: int, turns: int) -> dict[str, Any]:
    """Times of a case alone and in lanes, medians of all turns, and their ratio."""
    example, common, changes = CASES[name]
    line = tpss.load_scenario(EXAMPLES / f"{example}.toml").with_(common)
    built = [build(line.with_(each)) for each in changes]
    cases = list(islice(cycle(built), count))
    time_of(cases, lanes=True)
    alone, together = [], []
    for _ in range(turns):
        alone.append(time_of(cases, lanes=False)[0])
        found, ways = time_of(cases, lanes=True)
        together.append(found)
    ratios = [a / b for a, b in zip(alone, together, strict=True)]
    return {
        "alone_ms": median(alone),
        "in_lanes_ms": median(together),
        "times_as_fast": median(ratios),
        "in_lanes_percent": 100.0 * ways["lanes"] / count,
    }


def main() -> None:
    options = arguments(__doc__, cases=32, turns=9)
    stay_on_one_core()
    where = machine()
    found = {name: measure(name, options.cases, options.turns) for name in CASES}
    head = ("cases", "alone [ms]", "in lanes [ms]", "times as fast", "in lanes [%]")
    rows = [
        (
            name,
            *(
                f"{value:.{digits}f}"
                for value, digits in zip(each.values(), (1, 1, 1, 0), strict=True)
            ),
        )
        for name, each in found.items()
    ]
    text = (
        f"Processor time of a case, one thread, audit included:\n\n{table(head, rows)}\n\n"
        f"Median of {options.turns} turns. {caption(where)}"
    )
    deliver("lanes", {"machine": where, "cases": found}, text, options.publish)


if __name__ == "__main__":
    main()
