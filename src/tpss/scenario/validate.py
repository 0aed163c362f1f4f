"""Validation that reports every fault at once: each field by pydantic, then the parts together."""

import copy
import difflib
from collections.abc import Iterable
from pathlib import Path
from typing import Any, TypeVar, get_args

from pydantic import BaseModel, ValidationError

from tpss import units
from tpss.errors import Finding, ScenarioError
from tpss.scenario.cross_check import cross_check
from tpss.scenario.files import read_gradients

_Model = TypeVar("_Model", bound=BaseModel)

_Location = tuple[int | str, ...]

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
        for detail in error.errors(include_url=False):
            findings.append(_finding(model, dict(detail), source))
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
    unit = units.label(str(location[-1])) if location else ""
    if kind == "extra_forbidden":
        return "unknown key", _suggest(str(location[-1]), _known_keys(model, location[:-1]))
    if kind == "unknown_name":
        return message, _suggest(str(detail["input"]), context["known"])
    if kind == "literal_error":
        known = [word.strip("' ") for word in context["expected"].replace(" or ", ",").split(",")]
        return "not one of the choices", _suggest(str(detail["input"]), known)
    if kind in ("float_type", "float_parsing"):
        return "not a number", f"write a number{f' in {unit}' if unit else ''}, without quotes"
    if kind.startswith(("greater_than", "less_than")):
        return "out of range", f"{message[0].lower()}{message[1:]}{f' {unit}' if unit else ''}"
    if kind == "conflict":
        return message, context["remedy"]
    return message, _REMEDIES.get(kind, "see the scenario reference for this key")


def _suggest(word: str, known: Iterable[str]) -> str:
    names = sorted(known)
    near = difflib.get_close_matches(word, names, n=1, cutoff=0.5)
    listed = f"choose from {', '.join(names)}"
    return f"did you mean {near[0]}? {listed}" if near else listed


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
