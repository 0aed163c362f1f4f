"""Collapses of odd lines, each held against paths of its own: is there a solution after all?

Usage: python benchmarks/collapses.py [--cases N] [--seed N]

Random lines as those of `random_lines`, with trains under a current limitation, and with stations unlike
in reactance, no-load voltage and angle.  A line that is solved is held against its equations.  Where
none is found, two homotopies look for one, with an admittance matrix and a Newton's method of their own:

- the loads raised from none along the arc of the path, so that it may turn (pseudo-arclength);
- the stations, alike with the whole load, brought apart.

If either leads to a stable solution with the whole load and within the band, the collapse is false.
The exit code is 1 if one is, or if a solution does not hold; the seeds are printed.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # small matrices: threads only cost

import sys
from collections import Counter
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from tpss.model.trains import build_train_types
from tpss.powerflow.network import Ending
from tpss.powerflow.solve import solve
from tpss.record import copy_of_records
from tpss.scenario.rolling_stock import Train

import random_lines
from continuation import Complexes, Equations, Floats
from random_lines import MODEL, Line, Random, put_on_line, random_network
from report import arguments, table

LIMITATION = {"max_current_a": 600.0, "umin2_kv": 11.0, "knee_factor": 0.9}
LIMITED, LIMITED_POINTS = build_train_types(
    [
        Train(model=MODEL, current_limitation={**LIMITATION, "max_current_a": amperes}, **kind)
        for amperes in (300.0, 600.0)
        for kind in ({}, {"reactive_power": "double-bridge", "filter_reactance_ohm": -0.45})
    ]
)
LARGEST_RESIDUAL = 1e-8
MOST_POINTS = 3000
FIRST_ARC, LONGEST_ARC, SHORTEST_ARC = 0.01, 0.1, 1e-9
MOST_ITERATIONS = 10


def odd_line(rng: Random) -> Line:
    """A random line with current limitations, unlike stations, or both."""
    network = random_network(rng, rng.uniform(20e3, 200e3))
    loads = random_lines.random_loads(rng, network)
    if rng.random() < 0.7:
        for k in range(loads.trains.size):
            if rng.random() < 0.8:
                loads.types[k] = LIMITED[rng.integers(LIMITED.size)]
                random_lines.drive(rng, loads.trains[k], loads.types[k])
        random_lines.prepare(loads.trains, loads.types, loads.scratch, LIMITED_POINTS)
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


class Homotopy:
    """A path over a parameter t, followed along its arc.

    The direction of t along the arc is that of the determinant: it turns where the sign changes, be it
    smoothly or at the knee of a demand.
    """

    def __init__(self, equations: Equations) -> None:
        self.equations = equations

    def at(self, t: float) -> tuple[Equations, float]:
        """Equations and share of the loads."""
        return self.equations, t

    def residual(self, voltage: Complexes, t: float) -> Complexes:
        equations, share = self.at(t)
        return equations.residual(voltage, share)

    def slopes(self, voltage: Complexes, t: float) -> tuple[Floats, Floats]:
        """Jacobian over the voltages, and derivative over t by a difference."""
        equations, share = self.at(t)
        step = 1e-6
        by_t = self.residual(voltage, t + step) - self.residual(voltage, t - step)
        by_t = by_t / (2 * step)
        return equations.jacobian(voltage, share), np.concatenate([by_t.real, by_t.imag])

    def tangent(self, voltage: Complexes, t: float) -> tuple[Floats, float]:
        """Unit tangent towards growing arcs, and sign of the determinant."""
        jacobian, by_t = self.slopes(voltage, t)
        sign = float(np.linalg.slogdet(jacobian)[0])
        found = np.append(-np.linalg.solve(jacobian, by_t), 1.0)
        return sign * found / np.linalg.norm(found), sign

    def correct(self, point: Floats, tangent: Floats) -> Floats | None:
        """Newton's method in the plane across the tangent; None if it does not converge."""
        begun = point
        for _ in range(MOST_ITERATIONS):
            voltage, t = split(point)
            with np.errstate(all="ignore"):
                left = self.residual(voltage, t)
            if not np.isfinite(left).all():
                return None
            across = tangent @ (point - begun)
            if np.abs(left).max() < self.equations.converged:
                return point
            jacobian, by_t = self.slopes(voltage, t)
            whole = np.block([[jacobian, by_t[:, None]], [tangent[None, :]]])
            right = np.concatenate([left.real, left.imag, [across]])
            point = point - np.linalg.solve(whole, right)
        return None

    def follow(self, voltage: Complexes) -> Complexes | None:
        """Follow the path from t = 0; return the stable state at t = 1, if it gets there."""
        point = np.concatenate([voltage.real, voltage.imag, [0.0]])
        tangent, begun = self.tangent(voltage, 0.0)
        tangent, arc = tangent * begun, FIRST_ARC
        for _ in range(MOST_POINTS):
            found = self.correct(point + arc * tangent, tangent)
            if found is None or np.linalg.norm(found - point - arc * tangent) > 0.3 * arc:
                arc /= 2.0
                if arc < SHORTEST_ARC:
                    return None
                continue
            voltage, t = split(found)
            if t >= 1.0:
                return self.equations.correct(voltage, 1.0)
            if t < 0.0 or np.abs(voltage).min() < 0.1 or np.abs(voltage).max() > 3.0:
                return None
            tangent, _ = self.tangent(voltage, t)
            tangent, point = tangent * begun, found
            arc = min(LONGEST_ARC, 1.5 * arc)
        return None


class SourceHomotopy(Homotopy):
    """The stations are brought apart from like ones, at a share of the loads."""

    def __init__(self, equations: Equations, share: float) -> None:
        super().__init__(equations)
        self.share = share

    def at(self, t: float) -> tuple[Equations, float]:
        return apart(self.equations, t), self.share


def split(point: Floats) -> tuple[Complexes, float]:
    """Voltages and parameter of a point."""
    half = point.size // 2
    return point[:half] + 1j * point[half:-1], float(point[-1])


def apart(equations: Equations, t: float) -> Equations:
    """Equations whose stations differ from the mean one by a share t of what they do."""
    sources = copy_of_records(equations.network.sources)
    law = sources.converter
    mean_v, mean_angle = law.no_load_voltage_v.mean(), law.grid_angle_rad.mean()
    law.no_load_voltage_v = mean_v + t * (law.no_load_voltage_v - mean_v)
    law.grid_angle_rad = mean_angle + t * (law.grid_angle_rad - mean_angle)
    return replace(equations, network=equations.network._replace(sources=sources))


def without_load(equations: Equations) -> Complexes | None:
    """State without load, from that of like stations."""
    law = equations.network.sources.converter
    mean = law.no_load_voltage_v.mean() * np.exp(1j * law.grid_angle_rad.mean())
    begin = np.full(equations.buses, mean / equations.system.base_voltage_v)
    begun = apart(equations, 0.0).correct(begin, 0.0)
    return None if begun is None else SourceHomotopy(equations, 0.0).follow(begun)


def loaded_then_apart(equations: Equations) -> Complexes | None:
    """State with the whole load, from that of like stations with it."""
    alike = apart(equations, 0.0)
    law = equations.network.sources.converter
    mean = law.no_load_voltage_v.mean() * np.exp(1j * law.grid_angle_rad.mean())
    begin = alike.correct(np.full(equations.buses, mean / equations.system.base_voltage_v), 0.0)
    loaded = None if begin is None else Homotopy(alike).follow(begin)
    return None if loaded is None else SourceHomotopy(equations, 1.0).follow(loaded)


def is_sound(equations: Equations, voltage: Complexes) -> bool:
    """Whether a state with the whole load is within the band, stable, and all machines in step."""
    system, network = equations.system, equations.network
    size = np.abs(voltage) * system.base_voltage_v
    if size.min() < system.lowest_voltage_v or size.max() > system.highest_voltage_v:
        return False
    law, at = network.sources.converter, network.sources.node
    fed = voltage[at] * np.conj(equations.admittance @ voltage)[at] * system.base_power_va
    running = equations.running.running
    own_v = law.no_load_voltage_v - law.droop_v_per_var * fed.imag / running
    along = own_v**2 + law.generator_reactance_ohm * fed.imag / running
    if own_v.min() <= 0.0 or along.min() <= 0.0:
        return False
    alike = np.full(equations.buses, 1.0 + 0.0j)
    stable = np.linalg.slogdet(apart(equations, 0.0).jacobian(alike, 0.0))[0]
    return bool(np.linalg.slogdet(equations.jacobian(voltage, 1.0))[0] == stable)


def outcome_of(seed: int) -> tuple[str, str]:
    """Outcome of a line, and how the search for its solution ended."""
    line = odd_line(np.random.default_rng(seed))
    share, _ = solve(False, line.network, line.flow, line.loads)
    equations = Equations.of(line.network, line.flow, line.loads)
    if share == 1.0:
        found = np.concatenate([line.flow.nodes.voltage_v, line.flow.standing.voltage_v])
        found = found / line.network.system.base_voltage_v
        left = np.abs(equations.residual(found, 1.0)).max()
        return ("solved" if left <= LARGEST_RESIDUAL else "does not hold"), ""
    ending = Ending(int(line.flow.search[0].ending)).name
    ending += " WITHOUT LOAD" if line.flow.search[0].without_load else ""
    begun = without_load(equations)
    ends = [
        None if begun is None else Homotopy(equations).follow(begun),
        loaded_then_apart(equations),
    ]
    false = any(end is not None and is_sound(equations, end) for end in ends)
    return "false" if false else "confirmed", ending


def run(seeds: Iterable[int]) -> tuple[Counter[str], Counter[str], list[tuple[int, str]]]:
    """Outcomes, how the collapses ended, and the faults with their seeds."""
    outcomes, endings, faults = Counter[str](), Counter[str](), []
    for seed in seeds:
        outcome, ending = outcome_of(seed)
        outcomes[outcome] += 1
        if ending:
            endings[ending] += 1
        if outcome in ("false", "does not hold"):
            faults.append((seed, f"{outcome} {ending}"))
    return outcomes, endings, faults


def main() -> int:
    options = arguments(__doc__, cases=2_000, seed=0)
    outcomes, endings, faults = run(range(options.seed, options.seed + options.cases))
    kinds = "solved", "confirmed", "false", "does not hold"
    print(table(("lines", *kinds), [(f"{options.cases:,}", *(f"{outcomes[k]:,}" for k in kinds))]))
    print("\nHow the collapses ended:", ", ".join(f"{k} {n}" for k, n in endings.most_common()))
    for seed, fault in faults:
        print(f"seed {seed}: {fault}")
    return int(bool(faults))


if __name__ == "__main__":
    sys.exit(main())
