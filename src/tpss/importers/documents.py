"""JSON documents of other formats, read into models; faults become findings with their places."""

from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ConfigDict, TypeAdapter, ValidationError

from tpss.errors import Finding, ScenarioError, shortened
from tpss.files.json_text import parse_json
from tpss.files.read import MEGABYTE
from tpss.scenario.files import read_text, shown_line


class Item(BaseModel):
    """A part of a document of another format; what is not known here is passed over."""

    model_config = ConfigDict(frozen=True, extra="ignore", allow_inf_nan=False)


Model = TypeVar("Model")

MOST_JSON = 500 * MEGABYTE
"""Longest document that is read: networks of whole countries are shorter. [byte]"""

MOST_FINDINGS = 20
"""More of one file tell nothing new."""


def read_json(path: Path) -> Any:
    """Document of a JSON file.

    Raises
    ------
    ScenarioError
        The file cannot be read or is not JSON.
    """
    text = read_text(path, most_bytes=MOST_JSON)
    try:
        return parse_json(text)
    except ValueError as error:
        number = getattr(error, "lineno", None)  # of errors of the format alone
        place, value = shown_line(text, number) if number else ("", "")
        remedy = "correct the file at that place, or name another file"
        finding = Finding(str(path), place, value, f"not JSON: {error}", remedy)
        raise ScenarioError([finding]) from error


def as_model(kind: type[Model] | Any, document: Any, path: Path, remedy: str) -> Model:
    """A document as a model.

    Raises
    ------
    ScenarioError
        Values are missing or not of their kind.
    """
    try:
        return TypeAdapter(kind).validate_python(document)  # type: ignore[no-any-return]
    except ValidationError as error:
        findings = []
        for detail in error.errors()[:MOST_FINDINGS]:
            key = ".".join(str(part) for part in detail["loc"])
            missing = detail["type"] == "missing"
            value = "" if missing else shortened(repr(detail["input"]))
            problem = "it is missing" if missing else detail["msg"]
            findings.append(Finding(str(path), key, value, problem, remedy))
        raise ScenarioError(findings) from error
