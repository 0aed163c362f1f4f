"""Collapses of odd lines, each held against paths of its own: is there a solution after all?

Usage: python benchmarks/collapses.py [--cases N] [--seed N] [--publish]

Random lines as those of `random_lines`, with trains under a current limitation, and with stations unlike
in reactance, no-load voltage and angle.  A line that is solved is held against its equations.  Where
none is found, two homotopies look for one, with an admittance matrix and a Newton's method of their own
(see `homotopy`):

- the loads raised from none, after the stations are brought apart;
- the stations, alike with the whole load, brought apart.

If either leads to a stable solution with the whole load and within the band, the collapse is false.  If
none does, and it is known why the loads' path does not get there, it is confirmed, else undecided.
The exit code is 1 if one is false, or if a solution does not hold; the seeds are printed.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # small matrices: threads only cost

import sys
from collections import Counter
from collections.abc import Iterable
from typing import Any

import numpy as np

from tpss.model.routes import Running
from tpss.model.trains import build_train_types
from tpss.powerflow.network import Ending
from tpss.powerflow.solve import solve
from tpss.scenario.rolling_stock import Train

import random_lines
from continuation import Equations
from homotopy import End, Found, is_sound, loads_last, sources_last
from random_lines import MODEL, Line, Random, put_on_line, random_network
from report import arguments, caption, deliver, machine, table

LIMITATION = {"max_current_a": 600.0, "umin2_kv": 11.0, "knee_factor": 0.9}
LIMITED, LIMITED_POINTS = build_train_types(
    [
        Running(
            Train(model=MODEL, current_limitation={**LIMITATION, "max_current_a": amperes}, **kind)
        )
        for amperes in (300.0, 600.0)
        for kind in ({}, {"reactive_power": "double-bridge", "filter_reactance_ohm": -0.45})
    ]
)
LARGEST_RESIDUAL = 1e-8
SOLVED, CONFIRMED, UNDECIDED = "solved", "collapse confirmed", "undecided"
FALSE, WRONG = "collapse false", "solution wrong"
SAID = {
    Ending.TURNED: "the branch turns",
    Ending.LEFT_BAND: "a voltage leaves the band",
    Ending.OUT_OF_STEP: "a machine falls out of step",
    Ending.LOST: "not found, and why is not known",
}
OUTCOMES = SOLVED, CONFIRMED, UNDECIDED, FALSE, WRONG
KNOWN = End.WHOLE, End.BACK, End.FAR_OFF, End.OUT_OF_STEP
"""Ends of a path that say why it does not lead to a solution within the band."""


def odd_line(rng: Random) -> Line:
    """A random line with current limitations, unlike stations, or both."""
    network = random_network(rng, rng.uniform(20e3, 200e3))
    loads = random_lines.random_loads(rng, network)
    if rng.random() < 0.7:
        for k in range(loads.trains.size):
            if rng.random() < 0.8:
                loads.types[k] = LIMITED[rng.integers(LIMITED.size)]
                random_lines.drive(rng, loads.trains[k], loads.types[k])
                own = loads.trains[k : k + 1]
                random_lines.prepare(own, loads.types, loads.scratch, LIMITED_POINTS)
    if rng.random() < 0.6:
        make_unlike(rng, network.sources)
    return put_on_line(network, loads)


def make_unlike(rng: Random, sources: Any) -> None:
    """Other reactances, no-load voltages and angles, by a little or by much."""
    law, count, much = sources.converter, sources.size, 10.0 ** rng.uniform(-1.5, 0.3)
    law.no_load_voltage_v *= np.exp(rng.normal(0.0, 0.05 * min(much, 1.0), count))
    law.grid_angle_rad += rng.normal(0.0, 0.3 * much, count)
    law.generator_reactance_ohm = 14.4 * np.exp(rng.normal(0.0, 1.5 * much, count))
    law.motor_reactance_ohm = 12.5 * np.exp(rng.normal(0.0, 1.0 * much, count))
    law.droop_v_per_var = rng.choice([0.0, 50e-6, 200e-6], count)


def outcome_of(seed: int) -> tuple[str, str, str]:
    """Outcome of a line, how the search for its solution ended, and where the loads' path led."""
    line = odd_line(np.random.default_rng(seed))
    share, _ = solve(False, line.network, line.flow, line.loads)
    equations = Equations.of(line.network, line.flow, line.loads)
    if share == 1.0:
        found = np.concatenate([line.flow.nodes.voltage_v, line.flow.standing.voltage_v])
        found = found / line.network.system.base_voltage_v
        left = np.abs(equations.residual(found, 1.0)).max()
        holds = left <= LARGEST_RESIDUAL and is_sound(equations, found)
        return (SOLVED if holds else WRONG), "", ""
    without_load = ", without load" if line.flow.search[0].without_load else ""
    ending = f"{SAID[Ending(int(line.flow.search[0].ending))]}{without_load}"
    ends = loads_last(equations), sources_last(equations)
    return verdict(equations, *ends), ending, ends[0].end.value


def verdict(equations: Equations, by_loads: Found, by_sources: Found) -> str:
    """What two paths say of a collapse."""
    for found in (by_loads, by_sources):
        if found.voltage is not None and is_sound(equations, found.voltage):
            return FALSE
    return CONFIRMED if by_loads.end in KNOWN else UNDECIDED


def run(
    seeds: Iterable[int],
) -> tuple[Counter[str], Counter[tuple[str, str]], list[tuple[int, str]]]:
    """Outcomes, how the collapses ended, and the faults and undecided ones with their seeds."""
    outcomes, endings, faults = Counter[str](), Counter[tuple[str, str]](), []
    for seed in seeds:
        outcome, *ending = outcome_of(seed)
        outcomes[outcome] += 1
        if outcome not in (SOLVED, WRONG):
            endings[ending[0], ending[1]] += 1
        if outcome not in (SOLVED, CONFIRMED):
            faults.append((seed, outcome))
    return outcomes, endings, faults


def main() -> int:
    options = arguments(__doc__, cases=2_000, seed=0)
    outcomes, endings, faults = run(range(options.seed, options.seed + options.cases))
    where = machine()
    result = {
        "machine": where,
        "lines": options.cases,
        "first_seed": options.seed,
        "outcomes": {outcome: outcomes[outcome] for outcome in OUTCOMES},
        "endings": [[*ending, count] for ending, count in endings.most_common()],
        "faults": faults,
    }
    counts = [f"{outcomes[outcome]:,}" for outcome in OUTCOMES]
    ways = [(*ending, f"{count:,}") for ending, count in endings.most_common()]
    text = "\n\n".join(
        [
            table(OUTCOMES, [counts]),
            table(("of a collapse, TPSS says", "the homotopy has led to", "lines"), ways),
            f"{options.cases:,} lines, seeds from {options.seed}. {caption(where)}",
        ]
    )
    deliver("collapses", result, text, options.publish)
    for seed, fault in faults:
        print(f"seed {seed}: {fault}")
    return int(outcomes[FALSE] + outcomes[WRONG] > 0)


if __name__ == "__main__":
    sys.exit(main())
