"""Hold random cases in lanes against the same cases alone: every key figure, and the audit's verdict.

Usage: python benchmarks/lanes_agree.py [--cases N] [--seed N]
"""

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import tpss

from alike import difference, figures_in
from report import arguments

LINE = Path(__file__).parents[1] / "examples" / "thesis_3_3.toml"
AGREE = 1e-12
"""Relative difference that a rounding may make."""


def random_changes(random: np.random.Generator) -> dict[str, Any]:
    """Gradients, limits, masses, headways and stations of a case."""
    places_km = [
        0.0,
        *np.unique(random.uniform(1.0, 99.0, random.integers(1, 12)).round(1)).tolist(),
    ]
    limits_km = [
        0.0,
        *np.unique(random.uniform(5.0, 95.0, random.integers(0, 4)).round(0)).tolist(),
    ]
    return {
        "simulation.motion": "stepped",
        "simulation.braking": "whole-steps",
        "simulation.time_step_min": 0.2,
        "line.gradients_file": None,
        "line.gradients": [
            {"from_km": km, "permille": round(random.normal(0.0, 5.0), 2)} for km in places_km
        ],
        "line.speed_limits": [
            {"from_km": km, "speed_kmh": float(random.integers(60, 120))} for km in limits_km
        ],
        "trains.freight.mass_t": float(random.integers(700, 1470)),
        "traffic.0.headway_min": float(random.integers(8, 30)),
        "supply.converter_stations.*.converters": int(random.choice([3, 6])),
        "supply.converter_stations.*.control": "loading",
    }


def _judged(figures: tpss.KeyFigures) -> Iterator[tuple[str, Any]]:
    """All figures but those of the audit, and its verdict."""
    yield from figures_in(figures)
    yield "audit.passed", figures.audit.passed


def main() -> None:
    options = arguments(__doc__, cases=2000, seed=1)
    random, line = np.random.default_rng(options.seed), tpss.load_scenario(LINE)
    cases = [line.with_(random_changes(random)) for _ in range(options.cases)]
    alone = tpss.simulate_many(cases, lanes=False)
    together = tpss.simulate_many(cases, lanes=True)
    ways, worst, apart = Counter[str](), 0.0, 0
    for number, (one, other) in enumerate(zip(alone, together, strict=True)):
        ways[f"{other.way}, {other.status}"] += 1
        pairs = zip(_judged(one), _judged(other), strict=True)
        for (name, expected), (_, found) in pairs:
            off = difference(found, expected)
            if off > AGREE:
                apart += 1
                print(f"case {number}: {name} is {found} in lanes, {expected} alone")
            elif off > worst:
                worst = off
    print(f"{dict(ways)}; largest difference {worst:.1e}; {apart} figures differ by more")


if __name__ == "__main__":
    main()
