"""Compile what several tests need and few users do, each once, while the tests begin.

    python tests/warm_up.py

There are as many processes at a time as cores.  A test that needs a kernel which is being compiled waits
for it, see `one_compile`: without, each process of the tests would compile all of it.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import subprocess
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from hashlib import sha256
from pathlib import Path
from typing import Any

import tpss
from lines import double_track, scenario_of, with_posts
from tpss.kernel import cache_folder

from one_compile import compile_once
from scenarios import short_line

MINUTE = {"simulation.duration_min": 1.0}
OVERLOADED = Path(__file__).parents[1] / "examples" / "overloaded.toml"
BY_SQUARES = {"simulation.load_flow": "least-squares"}
SPARED = {
    "continuous_a": 1250.0, "short_time_a": 2080.0, "short_time_min": 6.0, "preload_percent": 70.0,
    "spared": True,
}  # fmt: skip


def coupled(ohm_per_km: float, **changes: Any) -> tpss.Scenario:
    """Two tracks that are tied at a post, and have an impedance in common."""
    half = {"mutual_r_ohm_per_km": 0.5 * ohm_per_km, "mutual_x_ohm_per_km": 0.5 * ohm_per_km}
    catenary = {"r_ohm_per_km": ohm_per_km, "x_ohm_per_km": ohm_per_km, **half}
    document = with_posts(double_track("posts", **catenary), 20.0)
    return scenario_of(document).with_({"simulation.duration_min": 5.0, **changes})


def spared() -> tpss.Scenario:
    """A train whose driver spares its motors."""
    motion = {"simulation.motion": None, "simulation.braking": None}
    return short_line({**motion, **MINUTE, "trains.freight.motor_rating": SPARED})


OCCASIONS: dict[str, Callable[[], tpss.Scenario]] = {
    "coupled tracks": lambda: coupled(0.1),
    "searches": lambda: tpss.load_scenario(OVERLOADED),
    "searches, coupled tracks": lambda: coupled(10.0),
    "least squares": lambda: short_line({**MINUTE, **BY_SQUARES}),
    "spared motors": spared,
    "least squares, coupled tracks": lambda: coupled(0.1, **BY_SQUARES),
}
"""Scenarios by what they need, longest first."""


def run_each() -> bool:
    """Run the occasions in processes of their own; whether all came to an end."""
    calls = [[sys.executable, __file__, name] for name in OCCASIONS]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        ended = list(pool.map(subprocess.run, calls))
    return all(each.returncode == 0 for each in ended)


def main(names: Sequence[str]) -> None:
    """Compile for one occasion, or for all unless that was done for these kernels and occasions."""
    for name in names:
        compile_once()
        tpss.simulate(OCCASIONS[name]())
    done = cache_folder() / f"tests-{sha256(Path(__file__).read_bytes()).hexdigest()[:8]}"
    if not names and not done.exists() and run_each():
        done.touch()


if __name__ == "__main__":
    main(sys.argv[1:])
