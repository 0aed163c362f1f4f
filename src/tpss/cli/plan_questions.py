"""The commands ``tpss plan price`` and ``tpss plan why``: questions to a plan that was solved."""

import math
import sys
from pathlib import Path

from tpss.cli.plan import GAP_LEFT, exit_code_of
from tpss.cli.plan_tables import print_firsts, print_frame
from tpss.cli.run import DONE, NO_SOLUTION
from tpss.cli.terminal import Console, say
from tpss.errors import AuditError, Finding, NoPlanError, PlanError, ScenarioError, no_such
from tpss.extras import demand


def price_plan(
    folder: Path, assignments: list[str], sweeps: list[str], gap: float, time_limit_s: float | None
) -> int:
    """Price a plan anew and print its first decisions, and where they turn; return the exit code."""
    demand("plan")
    from tpss.planning.answer import Effort, answer_of
    from tpss.planning.lazily import ALL
    from tpss.planning.plan import SIMULATION
    from tpss.planning.sentence import sentences
    from tpss.planning.turning import varied
    from tpss.planning.uncounted import unknown
    from tpss.planning.write import read_model, switching_table
    from tpss.scenario.override import parse_assignment

    try:
        model = read_model(folder, dict(parse_assignment(text) for text in assignments))
        if sweeps and model.has_bounds:
            raise PlanError(
                f"where the first decision turns is told if all cases were simulated: {ALL}"
            )
        answer = answer_of(model, Effort(gap, time_limit_s or math.inf))
    except (AuditError, NoPlanError) as error:
        print(str(error), file=sys.stderr)
        return exit_code_of(error)
    console = Console()
    for sentence in sentences(answer, ()):
        say(console, sentence)
    if model.plan.file.evaluate.by != SIMULATION:
        say(console, answer.claim)
    print_firsts(answer, console)
    for line in unknown(model):
        say(console, line)
    ranges = [_range_of(text) for text in sweeps]
    known = {each.key: each for each in varied(model)} if ranges else {}
    turns = []
    for key, low, high in ranges:
        if key not in known:
            raise ScenarioError([Finding("--sweep", key, "", *no_such("key", key, list(known)))])
        turns += [known[key].turn(area, low, high) for area in range(len(model.areas))]
    if turns:
        table = switching_table(model, turns)
        for column in ("now", "below", "above"):
            table[column] = [_shown(value) for value in table[column]]
        several = len(model.areas) > 1
        shown = [name for name in table.columns if name != "area" or several]
        headings = {name: name.replace("_", " ") for name in shown}
        print_frame(table, "Where the first decision turns", headings, console)
    return DONE if answer.is_closed else GAP_LEFT


def _shown(value: float | None) -> str:
    return "-" if value is None or math.isnan(value) else f"{value:.5g}"


def _range_of(text: str) -> tuple[str, float, float]:
    """Key and ends of ``KEY=LOW:HIGH``.

    Raises
    ------
    ScenarioError
        It is not of that form.
    """
    key, _, ends = text.partition("=")
    low, _, high = ends.partition(":")
    try:
        found = key.strip(), float(low), float(high)
    except ValueError:
        found = ("", 1.0, 0.0)
    if not found[0] or not found[1] <= found[2]:
        remedy = "write --sweep measures.AT.cost=800:1200"
        raise ScenarioError([Finding("--sweep", text, "", "not of the form KEY=LOW:HIGH", remedy)])
    return found


def why_not(folder: Path, text: str, assignments: list[str]) -> int:
    """Print what the best plan costs that contains some measures, and why; return the exit code."""
    demand("plan")
    from tpss.planning.answer import Effort
    from tpss.planning.lazily import ALL, refuse_bounds
    from tpss.planning.program import solve_any
    from tpss.planning.questions import best_with, not_carried, question_of
    from tpss.planning.sentence import money
    from tpss.planning.tables import cost_difference
    from tpss.planning.write import read_model
    from tpss.scenario.override import parse_assignment

    model = read_model(folder, dict(parse_assignment(each) for each in assignments))
    question, effort = question_of(text, model), Effort()
    best = solve_any(model.problem, effort.gap)
    refuse_bounds(model, best.policy, "the best plan")
    found = best_with(question, model, effort)
    console, currency = Console(), model.plan.file.economics.currency
    if found is None:
        say(console, f"There is no plan with {text}: dates, exclusions or the budget leave none.")
    elif units := model.lacking_of(found.policy):
        more = found.cost - best.cost
        say(console, f"The best plan with {text}: at least {money(found.cost)} {currency} expected, "
            f"at least {money(more)} more than the best of all; {len(units):,} of its configurations "
            f"with a traffic were not simulated. {ALL} simulates them.")  # fmt: skip
    else:
        more = found.cost - best.cost
        say(console, f"The best plan with {text}: {money(found.cost)} {currency} expected, "
            f"{money(more)} more than the best of all.")  # fmt: skip
        table = cost_difference(model, found.policy, best.policy)
        headings = {"component": "component", "with": "with it", "best": "best", "more": "more"}
        print_frame(table, f"Costs [{currency}, expected, discounted]", headings, console)
    for line in not_carried(question, model):
        say(console, line)
    return DONE if found is not None else NO_SOLUTION
