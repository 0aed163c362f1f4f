"""Validation that reports every fault at once: each field by pydantic, then the parts together."""

import copy
from pathlib import Path
from typing import Any, TypeVar, get_args

from pydantic import BaseModel, ValidationError

from tpss import units
from tpss.errors import Finding, ScenarioError, suggest
from tpss.scenario.cross_check import cross_check
from tpss.scenario.files import read_gradients

_Model = TypeVar("_Model", bound=BaseModel)

_Location = tuple[int | str, ...]

_PROBLEMS = {
    "missing": "it is missing",
    "string_type": "not text",
    "bool_type": "neither true nor false",
    "int_type": "not a whole number",
    "int_from_float": "not a whole number",
    "finite_number": "not a finite number",
    "tuple_type": "not a list",
    "dict_type": "not a table",
    "model_type": "not a table, nor a name of the library",
    "string_too_short": "an empty name",
    "string_pattern_mismatch": "not a plain name",
    "too_short": "the list is too short",
}

_REMEDIES = {
    "missing": "add it",
    "string_type": "write text in quotes",
    "bool_type": "write true or false, without quotes",
    "int_type": "write a whole number, without quotes",
    "int_from_float": "write a whole number",
    "finite_number": "write a finite number",
    "tuple_type": "write a list in square brackets",
    "dict_type": "write a table",
    "model_type": "write a table",
    "string_too_short": "write a name",
    "string_pattern_mismatch": "use letters, digits, dots, hyphens and underscores only",
    "too_short": "add at least one more",
    "not_ascending": "put them in ascending order, each place once",
    "not_unique": "give each one its own",
    "either_or": "leave one of them out, or add the one that is missing",
}


def validate(model: type[_Model], document: dict[str, Any], source: Path) -> _Model:
    """Validated `model` of a document.

    Raises
    ------
    ScenarioError
        The document has faults; the error lists all of them.
    """
    document = copy.deepcopy(document)
    findings = _insert_profile(document, source)
    scenario = None
    try:
        scenario = model.model_validate(document)
    except ValidationError as error:
        details: list[dict[str, Any]] = [dict(d) for d in error.errors(include_url=False)]
        locations: set[_Location] = {detail["loc"] for detail in details}
        findings += [
            _finding(model, detail, source)
            for detail in details
            if not _follows_from_another(detail, locations, document)
        ]
    findings += cross_check(document, str(source))
    if findings or scenario is None:
        raise ScenarioError(findings)
    return scenario


def _insert_profile(document: dict[str, Any], source: Path) -> list[Finding]:
    """Read the gradients that a document names as a file into it."""
    line = document.get("line")
    if not isinstance(line, dict) or not isinstance(line.get("gradients_file"), str):
        return []
    name = line["gradients_file"]
    if "gradients" in line:
        problem = "gradients are given twice, as a file and as a list"
        remedy = "leave out gradients_file or gradients"
        return [Finding(str(source), "line.gradients_file", repr(name), problem, remedy)]
    del line["gradients_file"]
    try:
        line["gradients"] = read_gradients(source.parent / name)
    except ScenarioError as error:
        # A level line lets the rest of the document be judged.
        line["gradients"] = [{"from_km": 0.0, "permille": 0.0}]
        return list(error.findings)
    return []


def _follows_from_another(
    detail: dict[str, Any], locations: set[_Location], document: dict[str, Any]
) -> bool:
    """Whether a finding only repeats another: a list that lost its faulty items, and the like."""
    location = detail["loc"]
    if detail["type"] == "too_short":
        return any(other[: len(location)] == location != other for other in locations)
    if detail["type"] == "missing" and len(location) == 3 and location[0] == "trains":
        # Without its model, a train lacks all that the library would give it.
        return location[2] != "model" and (*location[:2], "model") in locations
    if location == ("line", "gradients"):
        return "gradients_file" in document.get("line", {}) and detail["type"] == "missing"
    return False


def _finding(model: type[BaseModel], detail: dict[str, Any], source: Path) -> Finding:
    kind, location = detail["type"], detail["loc"]
    shown = "" if kind in ("missing", "either_or", "conflict") else _short(detail["input"])
    key = ".".join(str(part) for part in location)
    problem, remedy = _explain(model, kind, location, detail)
    return Finding(str(source), key, shown, problem, remedy)


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _explain(
    model: type[BaseModel], kind: str, location: _Location, detail: dict[str, Any]
) -> tuple[str, str]:
    context, message = detail.get("ctx", {}), detail["msg"]
    words = [part for part in location if isinstance(part, str)]
    unit = units.label(words[-1]) if words else ""
    if kind == "extra_forbidden":
        return "unknown key", suggest(str(location[-1]), _known_keys(model, location[:-1]))
    if kind == "unknown_name":
        return message, suggest(str(detail["input"]), context["known"])
    if kind == "literal_error":
        known = [word.strip("' ") for word in context["expected"].replace(" or ", ",").split(",")]
        return "not one of the choices", suggest(str(detail["input"]), known)
    if kind in ("float_type", "float_parsing"):
        return "not a number", f"write a number{f' in {unit}' if unit else ''}, without quotes"
    if kind.startswith(("greater_than", "less_than")):
        return "out of range", f"{message[0].lower()}{message[1:]}{f' {unit}' if unit else ''}"
    if kind == "conflict":
        return message, context["remedy"]
    if location == ("line", "gradients") and kind == "missing":
        return "no gradients are given", "add gradients, or gradients_file with a CSV file"
    return _PROBLEMS.get(kind, message), _REMEDIES.get(
        kind, "see the commented examples for this key"
    )


def _known_keys(model: type[BaseModel], location: _Location) -> list[str]:
    """Keys that the part of a scenario at a location knows."""
    part = model
    for key in location:
        fields = {field.alias or name: field for name, field in part.model_fields.items()}
        if key in fields:  # otherwise the number of a list's item, or the name of a train
            part = _part_in(fields[str(key)].annotation) or part
    return [field.alias or name for name, field in part.model_fields.items()]


def _part_in(annotation: Any) -> type[BaseModel] | None:
    """The part, if any, inside an annotation such as ``tuple[Station, ...]``."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    return next((part for arg in get_args(annotation) if (part := _part_in(arg))), None)
