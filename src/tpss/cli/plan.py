"""The commands ``tpss plan check`` and ``tpss plan run``."""

import math
import os
import random
import sys
import time
from collections.abc import Callable, Sized
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tpss.cli.plan_tables import print_answer
from tpss.cli.run import AUDIT_FAILED, BAD_INPUT, DONE, INTERRUPTED, NO_SOLUTION
from tpss.cli.terminal import Console, announce_compilation, progress_bar, say
from tpss.errors import AuditError, NoPlanError
from tpss.extras import demand

if TYPE_CHECKING:
    from tpss.planning.cases import CaseList
    from tpss.planning.load import Plan
    from tpss.planning.prove import Round
    from tpss.sweep.progress import Advance

GAP_LEFT = 5
"""Exit code of a plan that may not be the best one."""

PROGRESS = "{task.completed}/{task.total} cases  {task.fields[detail]}"

TRIAL_S, TRIAL_CASES = 2.0, 12
"""How long, and with how many cases, the time of a case is measured at most."""


def check_plan(file: Path) -> int:
    """Print what a plan consists of; return the exit code."""
    demand("plan")
    from tpss.planning.load import load_plan
    from tpss.planning.run import check_plan as checked

    case_list = checked(load_plan(file))
    console = Console()
    _print_size(case_list, console)
    _print_tree(case_list, console)
    for line in _without_source(case_list.plan):
        say(console, line)
    _print_time(case_list, console)
    return DONE


def _print_size(case_list: "CaseList", console: Console) -> None:
    file = case_list.plan.file
    for each in case_list.areas:
        name = each.area.name or file.name
        outages = file.require.also_with
        listed = [
            _counted(each.area.measures, "measure"),
            _counted(each.configurations, "configuration"),
            _counted(each.states.states, "state", " of traffic"),
            *([f"each with {_counted(outages, 'outage')}"] if outages else []),
        ]
        say(console, f"{name}: {', '.join(listed)}")


def _counted(things: Sized, word: str, more: str = "") -> str:
    """How many things there are, in words."""
    return f"{len(things)} {word}{'' if len(things) == 1 else 's'}{more}"


def _print_tree(case_list: "CaseList", console: Console) -> None:
    """The scenarios with their probabilities, and when one knows which it is."""
    from tpss.planning.solve import tree_of

    tree, start = tree_of(case_list), case_list.plan.file.stages.start
    shares = zip(tree.names, tree.scenario_probability, strict=True)
    say(console, "Scenarios: " + ", ".join(f"{name} {100 * p:.4g} %" for name, p in shares))
    for parting in tree.partings():
        groups = ", or ".join(" or ".join(group) for group in parting.groups)
        say(console, f"From {start[parting.stage]} one knows whether it is {groups}.")
        if parting.stage == 0:
            say(console, "They part at once: the first decision differs between them.")


def _without_source(plan: "Plan") -> list[str]:
    """Prices without a source, in a line."""
    from tpss.planning.plan_faults import prices_of

    file = plan.file
    sources = {f"economics.{key}": each.source for key, each in prices_of(file).items()}
    sources |= {f"measures.{name}": each.source for name, each in file.measures.items()}
    sources |= {f"renewals.{name}": each.source for name, each in file.renewals.items()}
    silent = [key for key, source in sources.items() if not source]
    return [f"Prices without a source: {', '.join(silent)}"] if silent else []


def _print_time(case_list: "CaseList", console: Console) -> None:
    """How many cases there are, and how long they take, from a few of them."""
    from tpss.planning.cases import distinct
    from tpss.planning.plan import SIMULATION
    from tpss.planning.rows import row_of

    cases = distinct(case_list.cases)
    announce_compilation(Console(stderr=True))
    evaluation = case_list.plan.file.evaluate
    drawn = random.Random(len(cases)).sample(cases, min(TRIAL_CASES, len(cases)))
    row_of(drawn[0], lambda: case_list.scenario(drawn[0]), evaluation)  # which compiles
    started, done = time.perf_counter(), 0
    for case in drawn:
        row_of(case, lambda case=case: case_list.scenario(case), evaluation)  # type: ignore[misc]
        done += 1
        if time.perf_counter() - started > TRIAL_S:
            break
    case_s = (time.perf_counter() - started) / done
    cores = os.cpu_count() or 1
    most = "" if evaluation.by == SIMULATION else "At most "
    whole_s = math.ceil(len(cases) * case_s / cores)
    say(
        console,
        f"{most}{len(cases):,} cases, {1e3 * case_s:.0f} ms each, about {whole_s:,} s on "
        f"{cores} core(s).  Nothing was written.",
    )


def run_plan(
    file: Path,
    out: Path,
    workers: int | None,
    scheduler: str | None,
    gap: float,
    time_limit_s: float | None,
    simulate_all: bool,
    quiet: bool,
) -> int:
    """Simulate the cases of a plan, solve it and write the answer; return the exit code."""
    demand("plan", *(["scheduler"] if scheduler else []))
    from tpss.planning.load import load_plan
    from tpss.planning.plan import SIMULATION
    from tpss.planning.run import run_plan as run

    plan = load_plan(file)
    if simulate_all:
        plan = plan.with_({"evaluate.by": SIMULATION})
    console = Console(stderr=True, quiet=quiet)
    announce_compilation(console)
    try:
        with progress_bar(plan.file.name, PROGRESS, _progress, console) as report:
            answered = run(
                plan, out, workers=workers, scheduler=scheduler, gap=gap,
                time_limit_s=time_limit_s, report=report,
                tell=_rounds(console),
            )  # fmt: skip
    except KeyboardInterrupt:
        print(
            "Interrupted; finished cases are kept, and the same command continues.", file=sys.stderr
        )
        return INTERRUPTED
    except (AuditError, NoPlanError) as error:
        print(str(error), file=sys.stderr)
        return exit_code_of(error)
    if not quiet:
        print_answer(answered.answer, answered.turns, answered.finer, Console())
        say(Console(), f"The plan is in {out / 'plan.json'}, its tables are in {out / 'tables'}")
    return DONE if answered.answer.is_closed else GAP_LEFT


def exit_code_of(error: AuditError | NoPlanError) -> int:
    """Exit code of a plan that has no answer."""
    if isinstance(error, AuditError):
        return AUDIT_FAILED
    return BAD_INPUT if error.limit == "budget" else NO_SOLUTION


def _rounds(console: Console) -> Callable[["Round"], None]:
    """Prints rounds of a proof by bounds in which a better plan was found, and those that close it."""
    best = math.nan

    def tell(each: "Round") -> None:
        nonlocal best
        if each.upper != best or each.lower >= each.upper:
            say(console, _round_in_words(each))
        best = each.upper

    return tell


def _round_in_words(each: "Round") -> str:
    """How far a proof by bounds has come."""
    from tpss.planning.sentence import money

    best = f"the best so far {money(each.upper)}" if math.isfinite(each.upper) else "none known yet"
    return (
        f"{each.simulated:,} cases simulated: no plan costs less than {money(each.lower)}, {best}"
    )


def _progress(state: "Advance") -> dict[str, Any]:
    rate = (state.done - state.before) / max(state.elapsed_s, 1e-9)
    return {"completed": state.done, "total": state.cases, "detail": f"{rate:,.0f} per second"}
