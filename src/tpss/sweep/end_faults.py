"""Faults at the ends of a study's parameters, each told once, at the parameter that leads to it.

One end of one parameter is tried at a time, while the others stay at their first values.  A fault of the
first values is met at nearly every end, and belongs to one parameter only.
"""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Any

from tpss.api import Prepared, build
from tpss.errors import Finding, ScenarioError, TooLargeError, TpssError
from tpss.scenario.open_step import with_step
from tpss.scenario.paths import NoSuchPlaceError, places_of
from tpss.sweep.derive import scenario_with
from tpss.sweep.design import DRAWN, Design, key_of

End = tuple[str, dict[str, Any], list[Finding]]
"""Name of a parameter, values with one of its ends, and what is wrong with them."""


def build_ends(design: Design) -> list[Prepared]:
    """Cases at the ends of every parameter.

    Raises
    ------
    ScenarioError
        Some cannot be built; each finding names the study's key and value.
    """
    built: list[Prepared] = []
    ends: list[End] = []
    for name, values in design.ends():
        findings: list[Finding] = []
        try:
            built.append(build(with_step(scenario_with(design, values, 0))))
        except (ScenarioError, TooLargeError) as error:
            findings = findings_of(error, str(design.study.source))
        ends.append((name, values, findings))
    told = [*_of_first_values(design, ends), *_of_others(design, ends)]
    if told:
        raise ScenarioError(list(dict.fromkeys(told)))
    return built


def findings_of(error: TpssError, place: str) -> list[Finding]:
    """What is wrong with a scenario, as findings."""
    if isinstance(error, ScenarioError):
        return list(error.findings)
    return [Finding(place, "", "", str(error), "vary it less, or change the base scenario")]


def together(values: Mapping[str, Any]) -> str:
    """Values of parameters in words."""
    return ", ".join(f"{name} = {value!r}" for name, value in values.items())


def _of_first_values(design: Design, ends: list[End]) -> Iterator[Finding]:
    """Faults of the first values, each at the parameter to which it belongs."""
    _, first, findings = ends[0]
    for finding in findings:
        name = _owner(finding.key, design, ends)
        if name is not None:
            yield _at_parameter(finding, design, name, first[name])
            continue
        problem = f"{finding.key}: {finding.problem}" if finding.key else finding.problem
        words = f"the scenario of the first values is not valid: {problem} ({together(first)})"
        yield Finding(str(design.study.source), "vary", "", words, finding.remedy)


def _of_others(design: Design, ends: list[End]) -> Iterator[Finding]:
    known = {finding.key for finding in ends[0][2]}
    for name, values, findings in ends:
        for finding in findings:
            if finding.key not in known:
                yield _at_parameter(finding, design, name, values[name])


def _owner(key: str, design: Design, ends: list[End]) -> str | None:
    """The parameter to which a fault of the first values belongs, by its key; None if that is unclear.

    It is the one whose path is the key, or of which another value has no such fault, or whose path
    begins like the key.
    """
    if len(design.parameters) == 1:
        return next(iter(design.parameters))
    paths = {name: _paths_of(name, design) for name in design.parameters}
    own = (n for n, each in paths.items() if any(_is_place_of(p, key, design) for p in each))
    cured = (name for name, _, found in ends if all(other.key != key for other in found))
    likeness = {name: max(_common(p, key) for p in each) for name, each in paths.items()}
    alike = max(likeness, key=likeness.__getitem__)
    return next(own, None) or next(cured, None) or (alike if likeness[alike] else None)


def _paths_of(name: str, design: Design) -> list[str]:
    """Key paths that a parameter sets."""
    file = design.study.file
    if name in file.choices:
        return [path for option in file.choices[name].values() for path in option] or [""]
    if name in DRAWN and file.gradients is not None:
        return [f"{file.gradients.key}.gradients"]
    return [name]


def _is_place_of(path: str, key: str, design: Design) -> bool:
    """Whether a key path, of keys and numbers, is one of those that a path of names and ``*`` means."""
    with suppress(NoSuchPlaceError):
        if key in places_of(design.study.base, path):
            return True
    mine, other = path.split("."), key.split(".")
    return len(mine) == len(other) and _common(path, key) == len(mine)


def _common(path: str, key: str) -> int:
    """How many keys two paths have in common from their beginning."""
    count = 0
    for mine, other in zip(path.split("."), key.split("."), strict=False):
        if mine not in ("*", other) or not other:
            break
        count += 1
    return count


def _at_parameter(finding: Finding, design: Design, name: str, value: Any) -> Finding:
    """A finding of a scenario, told at the study's value that leads to it."""
    problem, remedy = finding.problem, finding.remedy
    if finding.key and not _is_place_of(name, finding.key, design):
        shown = f" = {finding.value}" if finding.value else ""
        problem = f"the scenario is not valid: {finding.key}{shown}: {problem}"
    if finding.problem == "not a whole number" and design.parameters[name].low is not None:
        remedy = "add whole = true to the range"
    key = key_of(name, design.study)
    return replace(
        finding,
        file=str(design.study.source),
        key=key,
        value=repr(value),
        problem=problem,
        remedy=remedy,
    )
