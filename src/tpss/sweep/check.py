"""Faults of a study that can be found before the first case is run, and how long it will take."""

import random
import time
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from tpss.api import Prepared, build
from tpss.errors import Finding, ScenarioError, TooLargeError, TpssError
from tpss.scenario.open_step import with_step
from tpss.sweep.batch import run_case
from tpss.sweep.columns import Names
from tpss.sweep.derive import scenario_of, scenario_with
from tpss.sweep.design import Design, key_of

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
    findings: list[Finding] = []
    built: list[Prepared] = []
    for name, values in design.ends():
        try:
            built.append(build(with_step(scenario_with(design, values, 0))))
        except (ScenarioError, TooLargeError) as error:
            findings += _of_parameter(error, design, name, values)
    if findings:
        raise ScenarioError(list(dict.fromkeys(findings)))
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


def _findings(error: TpssError, place: str) -> list[Finding]:
    if isinstance(error, ScenarioError):
        return list(error.findings)
    return [Finding(place, "", "", str(error), "vary it less, or change the base scenario")]


def _of_parameter(
    error: TpssError, design: Design, name: str, values: dict[str, Any]
) -> Iterator[Finding]:
    """Findings of a scenario, reported at the study's value that leads to them."""
    source = str(design.study.source)
    for finding in _findings(error, source):
        problem, remedy = finding.problem, finding.remedy
        if finding.key and not _is_place_of(name, finding.key):
            shown = f" = {finding.value}" if finding.value else ""
            problem = f"the scenario is not valid: {finding.key}{shown}: {problem}"
        if finding.problem == "not a whole number" and design.parameters[name].low is not None:
            remedy = "add whole = true to the range"
        yield Finding(source, key_of(name, design.study), repr(values[name]), problem, remedy)


def _is_place_of(name: str, key: str) -> bool:
    """Whether a key path matches a path with ``*``."""
    mine, other = name.split("."), key.split(".")
    return len(mine) == len(other) and all(a in ("*", b) for a, b in zip(mine, other, strict=True))


def _of_case(error: TpssError, design: Design, case: int) -> list[Finding]:
    """Findings of a scenario, reported with the values that lead to them."""
    values = design.values(case)
    together = ", ".join(f"{name} = {value!r}" for name, value in values.items())
    remedy = "vary less, or put values that belong together into choices"
    return [
        replace(
            finding,
            file=str(design.study.source),
            problem=f"case {case} is not valid: {finding.problem} ({together})",
            remedy=f"{finding.remedy}; {remedy}",
        )
        for finding in _findings(error, str(design.study.source))
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
