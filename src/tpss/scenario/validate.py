"""Validation that reports every fault at once: each field by pydantic, then the parts together."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar, get_args

from pydantic import BaseModel, Tag, ValidationError

from tpss import units
from tpss.errors import Finding, ScenarioError, alike_together, closest, shortened, suggest
from tpss.scenario.absences import absence_of
from tpss.scenario.clock import START_S, start_of
from tpss.scenario.cross_check import cross_check
from tpss.scenario.document_places import lines_of
from tpss.scenario.fields import fields_of
from tpss.scenario.inline import inline_files
from tpss.scenario.inlined import Inlined, Location
from tpss.scenario.line import IN_FILES, Line
from tpss.scenario.own_library import SUFFIX
from tpss.scenario.positions import kilometres_fall
from tpss.scenario.standing import stand_at_stations

_Model = TypeVar("_Model", bound=BaseModel)

_PROBLEMS = {
    "missing": "it is missing",
    "string_type": "not text",
    "bool_type": "neither true nor false",
    "int_type": "not a whole number",
    "int_from_float": "not a whole number",
    "int_parsing_size": "a number of too many digits",
    "finite_number": "not a finite number",
    "tuple_type": "not a list",
    "dict_type": "not a table",
    "dataclass_type": "not a table",
    "model_type": "not a table, nor a name of the library",
    "string_too_short": "an empty name",
    "string_unicode": "not text in Unicode",
    "string_pattern_mismatch": "not a plain name",
    "too_short": "the list is too short",
}

_REMEDIES = {
    "missing": "add it",
    "string_type": "write text in quotes",
    "bool_type": "write true or false, without quotes",
    "int_type": "write a whole number, without quotes",
    "int_from_float": "write a whole number",
    "int_parsing_size": "write a smaller number",
    "finite_number": "write a finite number",
    "tuple_type": "write a list in square brackets",
    "dict_type": "write a table",
    "dataclass_type": "write a table",
    "model_type": "write a table",
    "string_too_short": "write a name",
    "string_unicode": "write text in UTF-8",
    "control_character": "write it on one line, without control characters and others that are not seen",
    "string_pattern_mismatch": "use letters (a to z), digits, dots, hyphens and underscores only",
    "too_short": "add at least one more",
    "not_ascending": "put them in ascending order, each value once",
    "not_unique": "give each one its own",
}


def validate(model: type[_Model], document: dict[str, Any], source: Path) -> _Model:
    """Validated `model` of a document.

    Raises
    ------
    ScenarioError
        The document has faults; the error lists all of them.
    """
    return validate_with_notes(model, document, source)[0]


def validate_with_notes(
    model: type[_Model], document: dict[str, Any], source: Path
) -> tuple[_Model, tuple[str, ...]]:
    """Validated `model` of a document, and what is told of how its files were read.

    Raises
    ------
    ScenarioError
        The document has faults; the error lists all of them.
    """
    inlined = inline_files(document, source)
    inlined.document = stand_at_stations(inlined.document)
    findings = inlined.findings
    scenario = None
    try:
        context = {START_S: start_of(inlined.document)}
        scenario = model.model_validate(inlined.document, context=context)
    except ValidationError as error:
        details: list[dict[str, Any]] = [dict(d) for d in error.errors(include_url=False)]
        locations: set[Location] = {detail["loc"] for detail in details}
        findings += [
            _finding(model, detail, inlined)
            for detail in details
            if not _follows_from_another(detail, locations, inlined)
            and not (_is_of_positions(detail) and kilometres_fall(inlined.document))
        ]
    if not any(place[0] in ("line", "lines") for place in inlined.unread):
        findings += [
            _traced(finding, inlined) for finding in cross_check(inlined.document, str(source))
        ]
    if findings or scenario is None:
        raise ScenarioError(alike_together(dict.fromkeys(findings)))
    return scenario, tuple(dict.fromkeys(inlined.notes))


def _follows_from_another(
    detail: dict[str, Any], locations: set[Location], inlined: Inlined
) -> bool:
    """Whether a finding only repeats another: a list that lost its faulty items, and the like."""
    location = detail["loc"]
    if inlined.is_unread(location):
        return True
    if detail["type"] == "too_short":
        if location == ("traffic",) and inlined.document.get("timetables"):
            return True  # of which none gave a train
        return any(other[: len(location)] == location != other for other in locations)
    if detail["type"] == "unknown_name":
        own = _at(detail["ctx"]["own"], inlined.document)
        return not isinstance(own, dict) or detail["input"] in own  # which has a fault of its own
    if detail["type"] == "default_factory_not_called":
        return True  # what is left out follows from another key, which has a fault
    if detail["type"] == "missing" and len(location) == 3 and location[0] == "trains":
        # Without its model, a train lacks all that the library would give it.
        return (*location[:2], "model") in locations
    if location[:-1] in (lines := lines_of(inlined.document)) and detail["type"] == "missing":
        return f"{location[-1]}_file" in lines[location[:-1]]  # which has a fault of its own
    return False


def _at(path: str, document: dict[str, Any]) -> Any:
    """What stands at a key path of a document; an empty table if nothing does."""
    found: Any = document
    for key in path.split("."):
        found = found.get(key, {}) if isinstance(found, dict) else {}
    return {} if found is None else found


def _is_of_positions(detail: dict[str, Any]) -> bool:
    """Whether a finding is that positions are not in ascending order."""
    return detail["type"] == "not_ascending" and "departures_min" not in detail["loc"]


def _traced(finding: Finding, inlined: Inlined) -> Finding:
    """A finding of a key path, traced to its file."""
    file, place = inlined.origin(tuple(finding.key.split(".")))
    return replace(finding, file=str(file), key=".".join(str(name) for name in place))


def _finding(model: type, detail: dict[str, Any], inlined: Inlined) -> Finding:
    part, location = _follow(model, detail["loc"])
    file, place = inlined.origin(location)
    if detail["type"] == "unknown_name":
        problem, remedy = _explain_name(detail, inlined.document)
    else:
        problem, remedy = _explain(part, place, detail)
    key = ".".join(str(name) for name in place)
    return Finding(str(file), key, _shown(detail), problem, remedy)


def _shown(detail: dict[str, Any]) -> str:
    """The value of a fault, where one value is at fault."""
    value = detail["input"]
    if detail["type"] == "missing":
        return ""
    if "remedy" in detail.get("ctx", {}) and isinstance(value, dict | None):
        return ""  # a fault between several values, or of one that is not there
    try:
        return shortened(repr(value))
    except ValueError:  # Python does not print integers of more than 4300 digits
        return "a number of thousands of digits"


def _explain(part: type, place: Location, detail: dict[str, Any]) -> tuple[str, str]:
    """What is wrong at a place of a file, and how to correct it."""
    kind, context, message = detail["type"], detail.get("ctx", {}), detail["msg"]
    words = [name for name in place if isinstance(name, str)]
    unit = units.label(words[-1]) if words else ""
    if kind in ("extra_forbidden", "unexpected_keyword_argument"):
        return _unknown_key(part, detail["loc"])
    if kind == "literal_error":
        known = [word.strip("' ") for word in context["expected"].replace(" or ", ",").split(",")]
        return "not one of the choices", suggest(str(detail["input"]), known)
    if kind in ("float_type", "float_parsing"):
        return "not a number", f"write a number{f' in {unit}' if unit else ''}, without quotes"
    if kind.startswith(("greater_than", "less_than")):
        return "out of range", f"{message[0].lower()}{message[1:]}{f' {unit}' if unit else ''}"
    if "remedy" in context:
        return message, context["remedy"]
    if kind == "too_long":
        most = context["max_length"]
        return f"the list has {context['actual_length']} items", f"leave at most {most}"
    if kind == "missing" and issubclass(part, Line) and words[-1] in IN_FILES:
        name = words[-1]
        return f"no {name.replace('_', ' ')} are given", f"add {name}, or {name}_file with a table"
    if kind == "missing" and place[0] == "trains" and len(place) == 3:
        return _PROBLEMS[kind], "add it, or name a model that gives it"
    return _PROBLEMS.get(kind, message), _REMEDIES.get(
        kind, "see the commented examples for this key"
    )


def _explain_name(detail: dict[str, Any], document: dict[str, Any]) -> tuple[str, str]:
    """What is wrong with a name that neither the library has nor, where it may, the document itself."""
    context, problem = detail["ctx"], detail["msg"]
    own = _at(context["own"], document)
    if own:
        problem += f", nor has {context['own']}"
    remedy = suggest(str(detail["input"]), {*context["known"], *own})
    return problem, f"{remedy}; or name a file of your own that ends in {SUFFIX}"


def _unknown_key(part: type, location: Location) -> tuple[str, str]:
    """What is wrong with a key that a part does not have: not modelled, misspelt, or neither."""
    key, known = str(location[-1]), _keys(part)
    absence = absence_of(location)
    if absence is not None and not closest(key, known):
        return f"unknown key; not modelled: {absence.words}", absence.instead
    return "unknown key", suggest(key, known)


def _keys(part: type) -> list[str]:
    """Keys of a part, as they are written."""
    return [field.alias or name for name, field in fields_of(part).items()]


def _follow(model: type, location: Location) -> tuple[type, Location]:
    """Part of a scenario that holds a location, and the location as the user would write it.

    Pydantic's locations name the alternative that it took (a number or a curve) too.
    """
    part, within = model, model
    choices: dict[str, Any] = {}
    written: list[int | str] = []
    for key in location:
        if key in choices:
            taken = choices[str(key)]
            within, choices = _part_in(taken) or within, _choices(get_args(taken))
            continue
        written.append(key)
        part = within
        fields = {field.alias or name: field for name, field in fields_of(part).items()}
        if key in fields:  # otherwise the number of a list's item, or the name of a train
            choices = _choices([fields[str(key)].annotation])
            within = _part_in(fields[str(key)].annotation) or part
    return part, tuple(written)


def _choices(annotations: Iterable[Any]) -> dict[str, Any]:
    """Alternatives within annotations by their tags; not those within an alternative."""
    choices: dict[str, Any] = {}
    waiting = list(annotations)
    while waiting:
        annotation = waiting.pop()
        tags = [m.tag for m in getattr(annotation, "__metadata__", ()) if isinstance(m, Tag)]
        choices |= dict.fromkeys(tags, annotation)
        waiting += [] if tags else get_args(annotation)
    return choices


def _part_in(annotation: Any) -> type | None:
    """The part, if any, inside an annotation such as ``tuple[Station, ...]``."""
    if isinstance(annotation, type) and fields_of(annotation):
        return annotation
    return next((part for arg in get_args(annotation) if (part := _part_in(arg))), None)
