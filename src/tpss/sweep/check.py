"""Faults of a study that can be found before the first case is run, and how long it will take."""

import random
import time
from collections.abc import Iterator
from dataclasses import replace

from tpss.api import Prepared, build
from tpss.errors import Finding, ScenarioError, TooLargeError, TpssError
from tpss.scenario.open_step import with_step
from tpss.sweep.batch import run_case
from tpss.sweep.columns import Names
from tpss.sweep.derive import scenario_of
from tpss.sweep.design import Design
from tpss.sweep.end_faults import build_ends, findings_of, together

SAMPLE = 100
"""Number of cases, drawn from the study, that are built to find invalid ones."""

TRIAL_S, TRIAL_CASES = 2.0, 20
"""How long, and with how many cases, the time of a case is measured at most."""


def check(design: Design) -> Names:
    """Build the cases at the ends of every parameter, and a sample of the others.

    Returns
    -------
    Names
        Of all stations and services that occur.

    Raises
    ------
    ScenarioError
        Some cannot be built; each finding names the study's key and value.
    """
    with design.study.named_as_given():
        built = build_ends(design)
        built += [_build(design, case) for case in spread(design.cases, SAMPLE)]
    return Names(
        stations=tuple(dict.fromkeys(name for each in built for name in each.layout.stations)),
        services=tuple(dict.fromkeys(s.name for each in built for s in each.start.services)),
    )


def _build(design: Design, case: int) -> Prepared:
    try:
        return build(with_step(scenario_of(design, case)))
    except (ScenarioError, TooLargeError) as error:
        raise ScenarioError(_of_case(error, design, case)) from error


def spread(cases: int, most: int) -> Iterator[int]:
    """Some of the cases, the first one among them, drawn at random: cases at equal distances in a Sobol
    sequence would be in one slice of its space.
    """
    drawn = random.Random(cases).sample(range(1, cases), min(cases, most) - 1)
    yield from (0, *sorted(drawn))


def _of_case(error: TpssError, design: Design, case: int) -> list[Finding]:
    """Findings of a scenario, reported with the values that lead to them."""
    values = together(design.values(case))
    remedy = "vary less, or put values that belong together into choices"
    return [
        replace(
            finding,
            file=str(design.study.source),
            problem=f"case {case} is not valid: {finding.problem} ({values})",
            remedy=f"{finding.remedy}; {remedy}",
        )
        for finding in findings_of(error, str(design.study.source))
    ]


def time_per_case(design: Design) -> float:
    """Time that a case takes, its scenario and model included, in one process. [s]

    The first call compiles the kernels, which does not count.
    """
    run_case(design, 0)
    started, done = time.perf_counter(), 0
    for case in spread(design.cases, TRIAL_CASES):
        run_case(design, case)
        done += 1
        if time.perf_counter() - started > TRIAL_S:
            break
    return (time.perf_counter() - started) / done
