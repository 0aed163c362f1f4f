"""Proof by simulation: solve with lower bounds, simulate what the plan uses, repeat."""

import numpy as np
import pytest

from tpss.errors import PlanError
from tpss.planning.claim import claim, counted
from tpss.planning.dynamic import solve
from tpss.planning.program import solve_program
from tpss.planning.prove import Case, Evidence, Grade, prove

from made_up_plans import random_plan

seeds = pytest.mark.parametrize("seed", range(40))


class Simulator:
    """Knows the truth of a plan, and counts what it is asked for; fails after some cases, if told to."""

    def __init__(self, problem, states):
        self.truth = [area.yearly_cost for area in problem.areas]
        self.states = states
        self.asked: list[Case] = []
        self.fails_after = np.inf

    def __call__(self, cases):
        for case in cases:
            if len(self.asked) >= self.fails_after:
                raise KeyboardInterrupt
            assert case not in self.asked, "simulated twice"
            self.asked.append(case)
            nodes = np.flatnonzero(self.states[case.area] == case.state)
            yield case, self.truth[case.area][nodes, case.configuration]


def plan_and_states(seed, **options):
    """A random plan, in which some nodes have the same traffic but prices of their own."""
    problem = random_plan(seed, **options)
    rng = np.random.default_rng(seed)
    nodes = problem.tree.nodes
    states = [rng.integers(0, max(2, nodes - 2), nodes) for _ in problem.areas]
    return problem, states


def below(problem, seed, error=0.3):
    """Bounds: the truth less a random error of some mean; what is not allowed stays so."""
    rng = np.random.default_rng(seed)
    return [table * (1.0 - rng.uniform(0.0, 2.0 * error, table.shape)) for table in _costs(problem)]


def unknown(problem):
    """No bounds: everything that is allowed has to be simulated."""
    return [np.where(np.isinf(area.yearly_cost), np.inf, np.nan) for area in problem.areas]


@seeds
@pytest.mark.parametrize("error", [0.02, 0.3])
def test_with_bounds_below_the_truth_it_ends_at_the_optimum(seed, error):
    problem, states = plan_and_states(seed)
    simulator = Simulator(problem, states)
    evidence = Evidence(problem, below(problem, seed, error), states, {})
    proof = prove(evidence, simulator, Grade.BOUNDED)
    assert proof.solution.cost == pytest.approx(solve(problem).cost, rel=1e-12)
    assert proof.holds
    assert proof.simulated == len(simulator.asked) <= proof.cases
    used = {Case(0, states[0][n], c) for n, c in enumerate(proof.solution.policy[0])}
    assert used <= set(simulator.asked)


@seeds
def test_the_gap_falls_to_nothing(seed):
    """Each round the bound rises, and the best plan that was simulated does not get worse."""
    problem, states = plan_and_states(seed)
    evidence = Evidence(problem, below(problem, seed), states, {})
    told = []
    proof = prove(evidence, Simulator(problem, states), Grade.BOUNDED, tell=told.append)
    lower, upper = np.array([(each.lower, each.upper) for each in told]).T
    assert (np.diff(lower) >= -1e-9 * upper[-1]).all()
    assert (np.diff(upper) <= 0.0).all()
    assert lower[-1] == pytest.approx(upper[-1], rel=1e-12)
    assert proof.rounds == tuple(told)


@seeds
def test_without_bounds_everything_is_simulated(seed):
    problem, states = plan_and_states(seed)
    simulator = Simulator(problem, states)
    proof = prove(Evidence(problem, unknown(problem), states, {}), simulator, Grade.EXHAUSTIVE)
    assert proof.solution.cost == pytest.approx(solve(problem).cost, rel=1e-12)
    assert proof.simulated == proof.cases == len(simulator.asked)
    assert len(proof.rounds) == 1


def test_a_case_without_a_bound_is_simulated_at_once():
    """One that lies outside an approximator's domain, whether the plan uses it or not."""
    problem, states = plan_and_states(1)
    lower = below(problem, 1)
    n, c = np.argwhere(np.isfinite(lower[0]))[-1]
    lower[0][states[0] == states[0][n], c] = np.nan
    simulator = Simulator(problem, states)
    prove(Evidence(problem, lower, states, {}), simulator, Grade.APPROXIMATED)
    assert simulator.asked[0] == Case(0, states[0][n], c)


@seeds
def test_an_interrupted_proof_goes_on_and_comes_to_the_same_plan(seed):
    """It is stopped at 20 random moments; what was simulated until then is not simulated again."""
    problem, states = plan_and_states(seed)
    lower = below(problem, seed)
    whole = prove(
        Evidence(problem, lower, states, {}), Simulator(problem, states), Grade.APPROXIMATED, 5
    )
    rng = np.random.default_rng(seed)
    simulator, known = Simulator(problem, states), {}
    for _ in range(20):
        simulator.fails_after = len(simulator.asked) + int(rng.integers(0, 3))
        try:
            prove(Evidence(problem, lower, states, known), simulator, Grade.APPROXIMATED, 5)
        except KeyboardInterrupt:
            assert len(known) == len(simulator.asked)
    simulator.fails_after = np.inf
    proof = prove(Evidence(problem, lower, states, known), simulator, Grade.APPROXIMATED, 5)
    assert proof.solution.policy.tolist() == whole.solution.policy.tolist()
    assert proof.solution.cost == whole.solution.cost
    assert proof.simulated == len(simulator.asked)


@seeds
def test_bounds_above_the_truth_are_caught_and_the_claim_is_withdrawn(seed):
    """All but those of today's supply are 50 % too high: if the plan uses none, the audit does."""
    problem, states = plan_and_states(seed, forbid=0.0)
    lower = [np.where(np.arange(t.shape[1]) > 0, 1.5 * t, 0.9 * t) for t in _costs(problem)]
    evidence = Evidence(problem, lower, states, {})
    proof = prove(evidence, Simulator(problem, states), Grade.APPROXIMATED, audit=1000)
    assert not proof.holds
    assert proof.fault_rate is None
    assert all(each.cost < each.bound for each in proof.violations)
    assert claim(proof, 10).startswith("Nothing is claimed of other plans")
    assert proof.solution.cost == pytest.approx(solve(problem).cost, rel=1e-12)  # all was drawn


def test_a_simulated_case_below_its_bound_is_enough():
    """Without an audit too: here the plan itself uses it."""
    problem, states = plan_and_states(3)
    lower = [table * 1.001 for table in _costs(problem)]
    proof = prove(Evidence(problem, lower, states, {}), Simulator(problem, states), Grade.BOUNDED)
    assert not proof.holds
    assert proof.violations[0].cost == pytest.approx(proof.violations[0].bound / 1.001)


def test_an_audit_draws_the_same_cases_whatever_was_simulated():
    problem, states = plan_and_states(5)
    lower = below(problem, 5)
    first = Simulator(problem, states)
    proof = prove(Evidence(problem, lower, states, {}), first, Grade.APPROXIMATED, audit=4)
    assert proof.audited == 4
    assert proof.fault_rate == 0.75  # 3 / 4
    everything = dict(Simulator(problem, states)(_all(evidence_cases(problem, states))))
    again = Simulator(problem, states)
    known = prove(Evidence(problem, lower, states, everything), again, Grade.APPROXIMATED, audit=4)
    assert again.asked == []
    assert known.solution.policy.tolist() == proof.solution.policy.tolist()


@pytest.mark.parametrize("seed", range(10))
def test_with_a_budget_the_same_loop_runs_on_the_integer_program(seed):
    problem, states = plan_and_states(seed, areas=2, budget=True)
    evidence = Evidence(problem, below(problem, seed), states, {})
    proof = prove(evidence, Simulator(problem, states), Grade.BOUNDED, solver=solve_program)
    assert proof.solution.cost == pytest.approx(solve_program(problem).cost, rel=1e-9)


def test_what_may_be_claimed():
    problem, states = plan_and_states(2)
    lower = below(problem, 2, 0.1)
    every = prove(
        Evidence(problem, unknown(problem), states, {}),
        Simulator(problem, states),
        Grade.EXHAUSTIVE,
    )
    assert claim(every, 1200) == (
        "Of all 1,200 plans over these configurations, stages and scenarios none has a lower expected "
        f"discounted cost: all {every.cases} cases were simulated."
    )
    bounded = prove(Evidence(problem, lower, states, {}), Simulator(problem, states), Grade.BOUNDED)
    assert bounded.simulated < bounded.cases
    assert "if no case costs less than its bound" in claim(bounded, 1200)
    guessed = prove(
        Evidence(problem, lower, states, {}),
        Simulator(problem, states),
        Grade.APPROXIMATED,
        audit=2,
    )
    assert "at most 1e+02 % of all are" in claim(guessed, 1200)
    assert "a rate and no proof" in claim(guessed, 1200)


def test_large_numbers_of_plans_in_words():
    assert counted(999_999) == "999,999"
    assert counted(12 * 10**40) == "1.2·10^41"


def test_faults_of_a_proof_are_named():
    problem, states = plan_and_states(2)
    lower = below(problem, 2)
    with pytest.raises(PlanError, match="an exhaustive proof has no bounds"):
        prove(Evidence(problem, lower, states, {}), Simulator(problem, states), Grade.EXHAUSTIVE)
    with pytest.raises(PlanError, match="was to be simulated, and was not"):
        prove(Evidence(problem, lower, states, {}), lambda cases: [], Grade.BOUNDED)
    with pytest.raises(PlanError, match="has no cost"):
        prove(
            Evidence(problem, lower, states, {}),
            lambda cases: [(case, np.nan) for case in cases],
            Grade.BOUNDED,
        )
    with pytest.raises(PlanError, match="do not have the shapes"):
        Evidence(problem, [lower[0][:, 1:]], states, {})


def _costs(problem):
    return [area.yearly_cost for area in problem.areas]


def _all(cases):
    return sorted(cases)


def evidence_cases(problem, states):
    """All cases of a plan."""
    return {
        Case(k, int(states[k][n]), int(c))
        for k, table in enumerate(_costs(problem))
        for n, c in np.argwhere(np.isfinite(table))
    }
