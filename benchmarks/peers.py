"""The load flow beside other programs: the same line, the same tolerance, one thread.

Usage: python benchmarks/peers.py [--runs N] [--publish]

Needs ``pip install ".[bench]"``.  On a machine with other work, `chrt -f 10` before the command (as
root) gives steadier figures.  Processor time is measured, in turns: each run of a program is followed
by a run of each of the others, so that a change of the processor's pace meets them all.
"""

import statistics
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any

import numpy as np
from lightsim2grid.algorithm import RefactorPolicyType

from load_flow import (
    with_casadi,
    with_lightsim2grid,
    with_pandapower,
    with_power_grid_model,
    with_tpss,
)
from load_flow.case import Case, Run, build_case
from report import arguments, caption, deliver, machine, stay_on_one_core, table

TRAINS = (20, 100, 500, 2000)
STEPS, FEW_STEPS = 100, 10
AGREEMENT = 1e-7
"""Largest difference of a bus voltage from that of TPSS. [p.u.]"""

PACKAGES = ("lightsim2grid", "power-grid-model", "casadi", "pandapower")
SAME, CHORD = RefactorPolicyType.AlwaysRefactor, RefactorPolicyType.Chord


@dataclass(frozen=True)
class Row:
    """A way to solve all steps of a case."""

    name: str
    prepare: Callable[[Case], Run]
    steps: int = STEPS
    same_network: bool = True
    """Whether its voltages have to be those of the first row."""


@dataclass(frozen=True)
class Group:
    """Rows that solve the same case; the first one is the measure of the others."""

    key: str
    title: str
    moving: bool
    rows: list[Row]


LIGHTSIM, GRID_MODEL = with_lightsim2grid, with_power_grid_model
GROUPS = [
    Group(
        "moving",
        "Trains move: the line's parameters change from step to step",
        moving=True,
        rows=[
            Row("**TPSS**, compiled loop", with_tpss.prepare_compiled),
            Row("TPSS, a call from Python a step", with_tpss.prepare_called),
            Row(
                "TPSS, compiled loop, with the converter law",
                with_tpss.prepare_with_converters,
                same_network=False,
            ),
            Row("lightsim2grid", partial(LIGHTSIM.prepare_moving, policy=SAME)),
            Row(
                "lightsim2grid, Jacobian factorised once a step",
                partial(LIGHTSIM.prepare_moving, policy=CHORD),
            ),
            Row(
                "lightsim2grid, the same from a predicted start",
                partial(LIGHTSIM.prepare_moving, policy=CHORD, predicted=True),
            ),
            Row("CasADi fast_newton", with_casadi.prepare_called),
            Row("CasADi fast_newton, through its buffers", with_casadi.prepare_buffered),
            Row(
                "power-grid-model, a new model a step",
                partial(GRID_MODEL.prepare_moving, method="Newton"),
                FEW_STEPS,
            ),
            Row("pandapower runpp with numba", with_pandapower.prepare_moving, FEW_STEPS),
        ],
    ),
    Group(
        "standing",
        "Trains stand: only P and Q change, in one call for all steps",
        moving=False,
        rows=[
            Row("**TPSS**, compiled loop", with_tpss.prepare_compiled),
            Row("lightsim2grid TimeSeries", partial(LIGHTSIM.prepare_batch, policy=SAME)),
            Row(
                "lightsim2grid TimeSeries, Jacobian factorised once a step",
                partial(LIGHTSIM.prepare_batch, policy=CHORD),
            ),
            Row("power-grid-model batch", partial(GRID_MODEL.prepare_batch, method="Newton")),
            Row(
                "power-grid-model batch, iterative current",
                partial(GRID_MODEL.prepare_batch, method="iterative current"),
            ),
        ],
    ),
]

AIMS = [("lightsim2grid", 5, 10), ("CasADi", 15, 15), ("pandapower", 100, 100)]
"""Program, and how many times faster TPSS is to be where trains move: at least, and as a goal."""

Times = dict[str, dict[int, float]]
"""Median time of a step by row and number of trains. [µs]"""


@dataclass(frozen=True)
class Measured:
    """What the rows of a group took, and how far their voltages are from those of TPSS."""

    time_us: Times
    difference_pu: dict[str, float]


def measure(group: Group, runs: int) -> Measured:
    """Measure all rows of a group with all numbers of trains."""
    measured = Measured({row.name: {} for row in group.rows}, {row.name: 0.0 for row in group.rows})
    for trains in TRAINS:
        case = build_case(trains, STEPS, group.moving)
        cases = [case.first(row.steps) for row in group.rows]
        solvers = [row.prepare(case) for row, case in zip(group.rows, cases, strict=True)]
        found = [solve().copy() for solve in solvers]
        taken = take_turns(solvers, runs)
        for row, case, voltage, seconds in zip(group.rows, cases, found, taken, strict=True):
            difference = np.abs(voltage - found[0][: case.steps]).max()
            worst = max(measured.difference_pu[row.name], float(difference))
            measured.time_us[row.name][trains] = 1e6 * seconds / case.steps
            measured.difference_pu[row.name] = worst
            if row.same_network and not worst < AGREEMENT:
                raise SystemExit(
                    f"{row.name}, {trains} trains: voltages differ by {worst:.1e} p.u."
                )
    return measured


def take_turns(solvers: list[Run], runs: int) -> list[float]:
    """Median processor time of each solver over some rounds. [s]"""
    taken: list[list[float]] = [[] for _ in solvers]
    for _ in range(runs):
        for solve, times in zip(solvers, taken, strict=True):
            started = time.process_time()
            solve()
            times.append(time.process_time() - started)
    return [statistics.median(times) for times in taken]


def times_table(group: Group, measured: Measured) -> str:
    """Times, how many times that of TPSS they are, and how well the voltages agree."""
    own = measured.time_us[group.rows[0].name]
    rows = []
    for row in group.rows:
        times = measured.time_us[row.name]
        cells = [f"{times[n]:,.1f} ({times[n] / own[n]:,.1f})" for n in TRAINS]
        difference = f"{measured.difference_pu[row.name]:.0e}".replace("0e+00", "0")
        rows.append([row.name, *cells, difference if row.same_network else "other law"])
    head = ["µs a step (multiple)", *(f"{n:,} trains" for n in TRAINS), "voltages differ [p.u.]"]
    return f"{group.title}:\n\n{table(head, rows)}"


def aims(times: Times) -> list[dict[str, Any]]:
    """How many times faster than the fastest row of each program, and whether that is enough."""
    own = next(iter(times.values()))
    found = []
    for program, least, goal in AIMS:
        rows = [each for name, each in times.items() if name.startswith(program)]
        faster = {n: min(row[n] for row in rows) / own[n] for n in TRAINS}
        met = {n: factor >= least for n, factor in faster.items()}
        found.append(
            {"program": program, "least": least, "goal": goal, "faster": faster, "met": met}
        )
    return found


def aims_table(found: list[dict[str, Any]]) -> str:
    rows = []
    for aim in found:
        cells = [f"{aim['faster'][n]:.1f}, {'met' if aim['met'][n] else 'not met'}" for n in TRAINS]
        wanted = (
            f"{aim['least']}"
            if aim["goal"] == aim["least"]
            else f"{aim['least']}, goal {aim['goal']}"
        )
        rows.append([aim["program"], wanted, *cells])
    return table(["faster than", "at least", *(f"{n:,} trains" for n in TRAINS)], rows)


def main() -> None:
    options = arguments(__doc__, runs=9)
    stay_on_one_core()
    found = {group.key: measure(group, options.runs) for group in GROUPS}
    passes = {n: with_tpss.passes_a_step(build_case(n, STEPS, moving=True)) for n in TRAINS}
    reached = aims(found["moving"].time_us)
    where = machine(*PACKAGES)
    texts = [times_table(group, found[group.key]) for group in GROUPS]
    texts += [
        aims_table(reached),
        f"Median of {options.runs} runs of {STEPS} steps. {caption(where)}",
    ]
    result = {
        "machine": where,
        "runs": options.runs,
        "steps": STEPS,
        "tpss_passes_a_step": passes,
        "groups": {key: asdict(measured) for key, measured in found.items()},
        "aims": reached,
    }
    deliver("peers", result, "\n\n".join(texts), options.publish)


if __name__ == "__main__":
    main()
