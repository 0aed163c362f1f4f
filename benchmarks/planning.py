"""Time of plans: pricing, the exact optimum, alternatives, budgets, and how much a proof simulates.

Usage: python benchmarks/planning.py [--budgets SECONDS]
"""

import argparse
import itertools
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from tpss.planning.costs import outlay
from tpss.planning.dynamic import first_decisions, solve
from tpss.planning.measures import Measure, make_transitions
from tpss.planning.money import Stages
from tpss.planning.prices import Quantities
from tpss.planning.problem import Area, Problem
from tpss.planning.program import solve_program
from tpss.planning.prove import Case, Evidence, Grade, prove
from tpss.planning.ranking import best_plans
from tpss.planning.tree import Tree, make_tree

AREAS, CONFIGURATIONS, MEASURES, TRAFFIC = 10, 50, 6, 81
STAGES = Stages((2030, 2035, 2040, 2045, 2055), 2085, 0.035)
COMPONENTS = ("energy", "late passengers", "late freight", "upkeep", "reserve", "train not run")
PRICE = np.array([0.6, 0.1, 0.1, 0.1, 0.1, 2.0])
RUNS = 9


@dataclass(frozen=True)
class Made:
    """Areas with made-up quantities, whose measures make supply stronger."""

    tree: Tree
    quantities: list[Quantities]
    areas: list[Area]

    def priced(self, price: np.ndarray) -> list[np.ndarray]:
        """Yearly costs of all areas."""
        return [each.priced(price).yearly_cost for each in self.quantities]

    def problem(self, price: np.ndarray) -> Problem:
        """The plan at some prices."""
        costs = self.priced(price)
        areas = (replace(a, yearly_cost=cost) for a, cost in zip(self.areas, costs, strict=True))
        return Problem(self.tree, STAGES, tuple(areas))


def made_up() -> Made:
    """A tree of 81 nodes, and ten areas of 50 configurations in 81 states of traffic."""
    rng = np.random.default_rng(1)
    branches = (1, 2, 3, 3, 3)
    paths = list(itertools.product(*(range(count) for count in branches)))
    tree = make_tree(
        [f"future {k}" for k in range(len(paths))], [1 / len(paths)] * len(paths), paths
    )
    sets = np.array(list(itertools.product((0, 1), repeat=MEASURES)))[:CONFIGURATIONS]
    levels = sets[np.argsort(sets.sum(axis=1), kind="stable")]
    quantities, areas = [], []
    for k in range(AREAS):
        prices = rng.uniform(50.0, 400.0, MEASURES)
        measures = [Measure(f"M{m}", (0.0, float(price)), 40.0) for m, price in enumerate(prices)]
        changes = make_transitions(STAGES, levels, measures)
        quantities.append(_quantities(rng, levels, tree))
        nothing = np.zeros((tree.nodes, CONFIGURATIONS))
        areas.append(Area(f"area {k}", nothing, changes, tuple(range(len(STAGES)))))
    return Made(tree, quantities, areas)


def _quantities(rng: np.random.Generator, levels: np.ndarray, tree: Tree) -> Quantities:
    """More measures carry more traffic and lose less energy."""
    strength = (levels * rng.uniform(0.5, 1.5, MEASURES)).sum(axis=1)
    density = np.linspace(1.0, 4.0, TRAFFIC)
    operation = density[:, None, None] * rng.uniform(0.0, 1.0, (TRAFFIC, len(levels), 6))
    operation[:, :, 0] = density[:, None] * (40.0 + 5.0 / (1.0 + strength))
    operation[:, :, 0] *= rng.uniform(0.98, 1.02, operation.shape[:2])
    carried = density[:, None] < 1.3 + strength
    carried[0] = True
    unserved = np.zeros((TRAFFIC, TRAFFIC, 6))
    unserved[:, :, 5] = 20.0 * np.maximum(0.0, density[:, None] - density)
    growth = 0.5 * tree.stage / (len(STAGES) - 1) + 0.5 * rng.random(tree.nodes)
    state = np.minimum(TRAFFIC - 1, (TRAFFIC * growth).astype(np.int64))
    may = density <= density[:, None]
    return Quantities(COMPONENTS, operation, carried, unserved, may, state)


def many_configurations(measures: int) -> Problem:
    """One area in the same tree, whose measures make 2^measures configurations."""
    rng = np.random.default_rng(2)
    tree = made_up().tree
    levels = np.array(list(itertools.product((0, 1), repeat=measures)))
    prices = rng.uniform(50.0, 400.0, measures)
    changes = make_transitions(
        STAGES, levels, [Measure(f"M{m}", (0.0, float(p)), 40.0) for m, p in enumerate(prices)]
    )
    saved = 0.8 * levels.sum(axis=1) * (1 + tree.stage[:, None])
    cost = rng.uniform(50.0, 60.0, (tree.nodes, len(levels))) - saved
    area = Area("area", cost, changes, tuple(range(len(STAGES))))
    return Problem(tree, STAGES, (area,))


def timed_ms(call: Callable[[], object], runs: int = RUNS) -> float:
    """Median time of some calls. [ms]"""
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return 1000.0 * statistics.median(times)


def proof_of(problem: Problem, error: float) -> str:
    """How much is simulated if bounds are too low by a random share with some mean."""
    rng = np.random.default_rng(3)
    truth = [area.yearly_cost for area in problem.areas]
    lower = [table * (1.0 - rng.uniform(0.0, 2.0 * error, table.shape)) for table in truth]
    states = [np.arange(problem.tree.nodes)] * AREAS

    def simulated(cases: list[Case]) -> list[tuple[Case, float]]:
        return [(case, truth[case.area][case.state, case.configuration]) for case in cases]

    start = time.perf_counter()
    proof = prove(Evidence(problem, lower, states, {}), simulated, Grade.BOUNDED)
    same = abs(proof.solution.cost - solve(problem).cost) <= 1e-9 * proof.solution.cost
    return (
        f"{100 * error:g} % error: {proof.simulated:,} of {proof.cases:,} cases in "
        f"{len(proof.rounds)} rounds, {time.perf_counter() - start:.2f} s; the optimum: {same}"
    )


def main() -> None:
    """Print all times."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--budgets", type=float, default=0.0, help="time for each budget [s]")
    limit_s = parser.parse_args().budgets
    made = made_up()
    problem = made.problem(PRICE)
    by_stage = PRICE * (1.0 + 0.1 * made.tree.stage[:, None] * (np.arange(6) == 0))
    print(f"{AREAS} areas, {CONFIGURATIONS} configurations, {made.tree.nodes} nodes:")
    rows = [
        ("priced, the same everywhere", lambda: made.priced(PRICE), RUNS),
        ("priced, prices of each stage", lambda: made.priced(by_stage), RUNS),
        ("best plan", lambda: solve(problem), RUNS),
        ("priced and best plan", lambda: solve(made.problem(PRICE)), RUNS),
        ("all first decisions", lambda: first_decisions(problem), 3),
        ("twenty best plans", lambda: best_plans(problem, 20), 3),
    ]
    for name, call, runs in rows:
        print(f"  {name}: {timed_ms(call, runs):.1f} ms")
    for measures in (10, 15):
        large = many_configurations(measures)
        print(
            f"  one area, {2**measures:,} configurations: {timed_ms(lambda p=large: solve(p), 3):.0f} ms"
        )
    for error in (0.02, 0.05, 0.10, 0.30):
        print(f"  {proof_of(problem, error)}")
    if limit_s:
        spent = outlay(problem, solve(problem).policy)
        most = np.array([spent[made.tree.stage == s].max() for s in range(len(STAGES))])
        for share in (0.9, 0.8, 0.6, 0.4, 0.2):
            tight = replace(problem, budget=share * most[made.tree.stage])
            start = time.perf_counter()
            found = solve_program(tight, 1e-4, limit_s)
            took_s = time.perf_counter() - start
            print(f"  budget of {100 * share:g} %: gap {100 * found.gap:.3f} % in {took_s:.0f} s")


if __name__ == "__main__":
    main()
