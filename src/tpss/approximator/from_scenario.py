"""Inputs of a scenario where they are what a study varies, by reading the study backwards.

What the study varies is read from the scenario; in all else the scenario must be the study's own, as an
approximator knows nothing of what was the same in all cases.
"""

from collections.abc import Iterator
from typing import Any

from tpss.approximator.forms import FED_BACK, FORMS, LOST
from tpss.approximator.model_file import ModelFile
from tpss.approximator.parameters import PROFILE, input_name
from tpss.errors import ApproximatorError, Finding, ScenarioError, TpssError, shortened
from tpss.scenario.differences import differences
from tpss.scenario.paths import NoSuchPlaceError, places_of
from tpss.scenario.scenario import Scenario
from tpss.sweep.derive import scenario_with
from tpss.sweep.design import DEVIATION, DRAWN, MEAN, Design, design_of
from tpss.sweep.gradients import gradient_statistics
from tpss.sweep.study import study_of_json

MOST_REPORTED = 10
"""Differences from the study that are reported one by one."""

STEP = "simulation.time_step_min"
"""What does not say what is simulated, but how exactly."""


def inputs_from_scenario(file: ModelFile, scenario: Scenario) -> dict[str, Any]:
    """Values of what the study of an approximator varies in a scenario, by the names of the inputs.

    Raises
    ------
    ApproximatorError
        The approximator does not hold its study.
    ScenarioError
        The scenario has no value of a parameter, or differs from the study in what that did not vary.
    """
    if not file.data.definition:
        raise ApproximatorError(
            "the approximator does not hold the study that it was trained on; give its inputs with "
            "--set, or train it again"
        )
    design = design_of(study_of_json(file.data.definition))
    known = _document_of(scenario)
    first = {name: parameter.ends[0] for name, parameter in design.parameters.items()}
    values: dict[str, Any] = {}
    findings: list[Finding] = []
    for name in design.parameters:
        if name == PROFILE:
            values[name] = first[name]
            continue
        try:
            values[name] = _value(name, design, scenario, known, first)
        except LookupError as error:
            findings.append(Finding(scenario.given_source, name, "", *error.args))
    findings = findings or list(_others(scenario, design, values))
    if findings:
        raise ScenarioError(findings)
    return {
        input_name(name): str(value) if design.parameters[name].is_text else value
        for name, value in values.items()
        if name != PROFILE
    }


def demand_same_kind(file: ModelFile, scenario: Scenario) -> None:
    """Refuse a scenario that differs in kind from the study, in what no aggregated input says.

    Raises
    ------
    ScenarioError
        Its trains have electric brakes and those of the study none, or the reverse; or the approximator
        predicts what converters lose, and the scenario does not describe it.
    """
    if not (file.form in FORMS and FORMS[file.form].where_told):
        return
    predicted = {output.name for output in file.outputs}
    types = {entry.train for entry in scenario.traffic}
    braking = [name for name in sorted(types) if scenario.trains[name].regeneration is not None]
    place, findings = scenario.given_source, []
    if braking and FED_BACK[0] not in {*predicted, *file.untold}:
        problem = "the study had no electric brakes: an approximator cannot know what they do"
        remedy = "simulate it, or train on a study whose trains have them"
        findings = [
            Finding(place, f"trains.{name}.regeneration", "", problem, remedy) for name in braking
        ]
    if not braking and FED_BACK[0] in predicted:
        problem = "no train has electric brakes, and those of the study did"
        findings.append(Finding(place, "trains", "", problem, "simulate it, or give them some"))
    losses = [kind.losses for kind in scenario.supply.converters_in_use]
    if LOST[0] in predicted and None in losses:
        problem = "converters do not say what they lose, and those of the study did"
        remedy = "give their type losses, as the study has them"
        findings.append(Finding(place, "supply.converter_stations", "", problem, remedy))
    if findings:
        raise ScenarioError(findings)


def _document_of(scenario: Scenario) -> dict[str, Any]:
    tables = [table.model_dump(mode="json") for table in scenario.timetables]
    return scenario.as_document() | {"timetables": tables}


def _value(
    name: str, design: Design, scenario: Scenario, known: dict[str, Any], first: dict[str, Any]
) -> Any:
    """Value of a parameter in a scenario; a `LookupError` holds problem and remedy if it has none."""
    parameter = design.parameters[name]
    if name in DRAWN:
        return _of_profile(name, design, scenario)
    if not parameter.is_text and not isinstance(parameter.ends[0], bool):
        return _number(known, name)
    for value in parameter.ends:
        try:
            case = scenario_with(design, {**first, name: value}, 0)
        except TpssError:
            continue  # this one goes with other values than the first ones only
        paths = _paths(name, design)
        if _at(_document_of(case), paths) == _at(known, paths):
            return value
    options = ", ".join(str(value) for value in parameter.ends)
    raise LookupError(
        "it is none of what was trained", f"the study varies it: {shortened(options)}"
    )


def _of_profile(name: str, design: Design, scenario: Scenario) -> float:
    drawn = design.study.file.gradients
    lines = scenario.lines_by_name
    line = lines[drawn.line or "line"] if drawn is not None else next(iter(lines.values()))
    ends = (line.begins_at_km, line.end_km)
    statistics = gradient_statistics(line, *ends, ends)
    return {MEAN: statistics.mean, DEVIATION: statistics.deviation}[name]


def _paths(name: str, design: Design) -> list[str]:
    choices = design.study.file.choices
    if name not in choices:
        return [name.removesuffix(".+")]
    paths = [path.removesuffix(".+") for option in choices[name].values() for path in option]
    return list(dict.fromkeys(paths))


def _number(known: dict[str, Any], name: str) -> Any:
    found = [value for _, value in _items(known, name)]
    numbers = [v for v in found if isinstance(v, int | float) and not isinstance(v, bool)]
    if not numbers or len(numbers) < len(found):
        raise LookupError("the scenario has no number here", "the study varies it: give one")
    if any(number != numbers[0] for number in numbers):
        raise LookupError(
            f"it is {min(numbers):g} to {max(numbers):g} here",
            "the study varies all of them as one",
        )
    return numbers[0]


def _at(known: dict[str, Any], paths: list[str]) -> list[tuple[str, Any]]:
    return [item for path in paths for item in _items(known, path)]


def _items(known: dict[str, Any], path: str) -> Iterator[tuple[str, Any]]:
    """Places that match a path, and what is there."""
    try:
        places = places_of(known, path)
    except NoSuchPlaceError:
        return
    for place in places:
        value: Any = known
        for key in place.split("."):
            value = value[int(key)] if isinstance(value, list) else (value or {}).get(key)
        yield place, value


def _others(scenario: Scenario, design: Design, values: dict[str, Any]) -> Iterator[Finding]:
    """What differs from the study in all that it did not vary."""
    rebuilt = scenario_with(design, values, 0)
    drawn = design.study.file.gradients
    own = f"{drawn.key}.gradients" if drawn is not None else STEP
    unused = ("outages",) if scenario.simulation.outage is None else ()
    apart = (STEP, own, *unused)
    rows = {
        path: row
        for path, row in differences([scenario, rebuilt]).items()
        if not any(path == each or path.startswith(f"{each}.") for each in apart)
    }
    for path, (here, there) in list(rows.items())[:MOST_REPORTED]:
        problem = f"the study had {shortened(repr(there))} only: an approximator cannot know this"
        remedy = "simulate it, or vary it in a study and train on that"
        yield Finding(scenario.given_source, path, shortened(repr(here)), problem, remedy)
    if len(rows) > MOST_REPORTED:
        problem = f"{len(rows) - MOST_REPORTED} more such differences from the study"
        yield Finding(scenario.given_source, "", "", problem, "simulate it")
