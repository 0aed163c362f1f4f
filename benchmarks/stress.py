"""Robustness of the load flow: random lines up to and past collapse, judged by a slow one.

Usage: python benchmarks/stress.py [--cases N] [--seed N] [--publish]

Every line is solved from a flat start, a step later from the solution before, as in a simulation, and
from voltages and currents drawn at random, as bad as a start can be.  Where a line cannot carry its
load, Newton's method also starts at the other solution beside the turning point, on the lower branch.
Each result is judged by `continuation`.  The exit code is 1 if one is wrong; its seed is printed.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # small matrices: threads only cost

import sys
from collections import Counter, defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tpss.powerflow.chain import WARM
from tpss.powerflow.newton import MOST_PASSES, Solution, newton
from tpss.powerflow.solve import solve

from continuation import Complexes, Equations, carry
from random_lines import Line, Random, moved, random_line
from report import arguments, caption, deliver, machine, table

STARTS = {
    "flat": "from a flat start",
    "step": "a step later, from the solution before",
    "random": "from random voltages and currents",
    "low": "at a root on the lower branch",
}
SAME_SHARE = 3e-4
"""TPSS gives up where the load can grow by less than 1e-4."""
SAME_VOLTAGE, SAME_VOLTAGE_AT_THE_END = 1e-7, 1e-4
"""In p.u.; where the path ends, a rounding moves the voltages most."""
LARGEST_RESIDUAL = 1e-8
"""Of base power; pieces of line of a metre make a rounding of the voltages as large as 1e-9."""

BESIDE_THE_TURN = (-4.0, -1.0)
"""Powers of ten of the shares by which the load stays below that of the turning point."""
DISTINCT = 1e-4
"""Roots closer than this are the same one. [p.u.]"""

SOLVED, COLLAPSED, REFUSED = "solved", "collapsed", "refused"
FAULTS = {
    "not finite": "a voltage is not a number",
    "false root": "the equations do not hold",
    "other branch": "a solution that is not on the path from zero load",
    "missed": "no solution found though there is one",
    "wrong share": "another share of the load than the line can carry",
}


@dataclass
class Tally:
    """Outcomes and passes of all results of a kind of start."""

    outcomes: Counter[str] = field(default_factory=Counter)
    passes: dict[str, list[int]] = field(default_factory=lambda: defaultdict(list))

    def add(self, outcome: str, passes: int) -> None:
        self.outcomes[outcome] += 1
        self.passes[outcome].append(passes)

    @property
    def faults(self) -> int:
        return sum(self.outcomes[fault] for fault in FAULTS)

    def figures(self) -> dict[str, Any]:
        """Counts, and mean and largest number of passes."""
        return {
            "outcomes": dict(self.outcomes),
            "passes": {
                outcome: {"mean": float(np.mean(passes)), "worst": max(passes)}
                for outcome, passes in self.passes.items()
            },
        }


def voltages(line: Line) -> Complexes:
    """Of the fixed nodes, then of the trains along the line. [p.u.]"""
    found = np.concatenate([line.flow.nodes.voltage_v, line.flow.standing.voltage_v])
    return found / line.network.system.base_voltage_v


def judge(line: Line, share: float, carried: float, expected: Complexes) -> str:
    """Outcome of a solution by what the path from zero load says."""
    found, equations = voltages(line), equations_of(line)
    if not np.isfinite(found).all():
        return "not finite"
    if np.abs(equations.residual(found, share)).max() > LARGEST_RESIDUAL:
        return "false root"
    if share < 1.0:
        if carried == 1.0:
            return "missed"
        if abs(share - carried) > SAME_SHARE:
            return "wrong share"
        _, there = carry(equations, most=share)
        near = np.abs(found - there).max() < SAME_VOLTAGE_AT_THE_END
        return COLLAPSED if near else "other branch"
    if carried < 1.0 - SAME_SHARE or np.abs(found - expected).max() > SAME_VOLTAGE:
        return "other branch"
    return SOLVED


def equations_of(line: Line) -> Equations:
    return Equations.of(line.network, line.flow, line.loads)


def scatter(rng: Random, line: Line) -> None:
    """Put a line's state anywhere: 0.1 to 1.2 p.u., any current up to 2 kA."""
    nodes, sections = line.flow.nodes, line.flow.sections

    def any_phasor(low: float, high: float, count: int, widest: float) -> Complexes:
        angle = rng.uniform(-widest, widest, count)
        return rng.uniform(low, high, count) * np.exp(1j * angle)

    nodes.voltage_v = line.network.system.base_voltage_v * any_phasor(0.1, 1.2, nodes.size, 1.0)
    sections.current_a = any_phasor(0.0, 2000.0, sections.size, np.pi)


def set_state(line: Line, voltage: Complexes) -> None:
    """Put a line's state to a solution, given by all of its voltages."""
    flow, volts = line.flow, line.network.system.base_voltage_v * voltage
    flow.nodes.voltage_v = volts[: flow.nodes.size]
    for section, found in zip(line.network.sections, flow.sections, strict=True):
        beside, length_m = section.end_node, found.closing_m
        if found.first < found.end:
            beside = flow.nodes.size + found.first
            length_m = flow.standing[found.first].piece_m
        start_v = volts[section.start_node]
        through = (start_v - volts[beside]) / (section.impedance_ohm_per_m * length_m)
        found.current_a = through + 0.5j * section.susceptance_s_per_m * length_m * start_v


def from_the_lower_branch(rng: Random, line: Line, carried: float) -> tuple[str, int] | None:
    """Outcome and passes from the root on the lower branch; None if there is none nearby.

    Beside the turning point the voltages go with the root of the distance from it, so the lower
    solution is as far behind the turn as twice the tangent reaches from the upper one.
    """
    equations = equations_of(line)
    share, upper = carry(equations, most=carried * (1.0 - 10.0 ** rng.uniform(*BESIDE_THE_TURN)))
    tangent = equations.tangent(upper, share)
    lower = equations.correct(upper + 4.0 * (carried - share) * tangent, share)
    if lower is None or np.abs(lower - upper).max() < DISTINCT:
        return None
    set_state(line, lower)
    status, passes = newton(share, WARM, MOST_PASSES, line.network, line.flow, line.loads)
    if status != Solution.SOLVED:
        return REFUSED, passes
    back = np.abs(voltages(line) - upper).max() < SAME_VOLTAGE_AT_THE_END
    return SOLVED if back else "other branch", passes


def results(seed: int) -> Iterable[tuple[str, str, int]]:
    """Kind of start, outcome and passes of the solutions of one random line."""
    rng = np.random.default_rng(seed)
    line = random_line(rng)
    carried, expected = carry(equations_of(line))
    share, passes = solve(False, line.network, line.flow, line.loads)
    yield "flat", judge(line, share, carried, expected), passes
    again = line.standing_anew()
    scatter(rng, again)
    share_again, passes = solve(True, again.network, again.flow, again.loads)
    yield "random", judge(again, share_again, carried, expected), passes
    if carried < 1.0:
        lower = from_the_lower_branch(rng, line.standing_anew(), carried)
        if lower is not None:
            yield "low", *lower
    if share == 1.0:
        later = moved(rng, line)
        later.flow.nodes.voltage_v = line.flow.nodes.voltage_v
        later.flow.sections.current_a = line.flow.sections.current_a
        share, passes = solve(True, later.network, later.flow, later.loads)
        yield "step", judge(later, share, *carry(equations_of(later))), passes


def run(seeds: Iterable[int]) -> tuple[dict[str, Tally], list[tuple[int, str, str]]]:
    """Tallies of all kinds of start, and the faults with their seeds."""
    tallies, faults = {start: Tally() for start in STARTS}, []
    for seed in seeds:
        for start, outcome, passes in results(seed):
            tallies[start].add(outcome, passes)
            if outcome in FAULTS:
                faults.append((seed, start, outcome))
    return tallies, faults


def describe(tallies: dict[str, Tally]) -> str:
    """Outcomes by kind of start, and passes of those with a solution and of those without."""

    def passes(tally: Tally, *outcomes: str) -> str:
        found = [count for outcome in outcomes for count in tally.passes[outcome]]
        return f"{np.mean(found):.1f}, {max(found)}" if found else ""

    rows = [
        (
            STARTS[start],
            *(f"{tally.outcomes[outcome]:,}" for outcome in (SOLVED, COLLAPSED, REFUSED)),
            f"{tally.faults}",
            passes(tally, SOLVED),
            passes(tally, COLLAPSED, REFUSED),
        )
        for start, tally in tallies.items()
    ]
    ends = "passes to a solution: mean, worst", "to the end without"
    text = table(("start", SOLVED, COLLAPSED, REFUSED, "**wrong**", *ends), rows)
    return f"{text}\n\nWrong would be: {'; '.join(FAULTS.values())}."


def main() -> int:
    options = arguments(__doc__, cases=10_000, seed=0)
    seeds = range(options.seed, options.seed + options.cases)
    tallies, faults = run(seeds)
    where = machine()
    result = {
        "machine": where,
        "lines": options.cases,
        "first_seed": options.seed,
        "starts": {start: tally.figures() for start, tally in tallies.items()},
        "faults": faults,
    }
    note = f"{options.cases:,} lines, seeds from {options.seed}. {caption(where)}"
    deliver("stress", result, f"{describe(tallies)}\n\n{note}", options.publish)
    for seed, start, outcome in faults:
        print(f"seed {seed}, {STARTS[start]}: {outcome}, {FAULTS[outcome]}")
    return int(bool(faults))


if __name__ == "__main__":
    sys.exit(main())
