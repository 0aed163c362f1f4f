"""Variants of a scenario: named changes, kept in its file."""

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import AfterValidator, Field, model_validator

from tpss.errors import Finding, ScenarioError
from tpss.scenario.fields import Name, Part, fault
from tpss.scenario.override import copy_of, put_in
from tpss.scenario.paths import ONE_MORE, NoSuchPlaceError, places_of

ALL = "all"
"""Stands for the scenario as it is and each of its variants, where they are chosen."""


def _all_finite(value: Any) -> Any:
    """A value without numbers that are not finite, which no file of a result could hold."""
    for path, inside in _flat(value) if isinstance(value, dict) else [("it", value)]:
        if not all(map(math.isfinite, _numbers(inside))):
            raise fault(f"{path} has a number that is not finite", "write a finite number")
    return value


def _numbers(value: Any) -> Iterator[float]:
    """Numbers with decimals anywhere in a value."""
    if isinstance(value, float):
        yield value
    elif isinstance(value, dict | list | tuple):
        for each in value.values() if isinstance(value, dict) else value:
            yield from _numbers(each)


Value = Annotated[Any, AfterValidator(_all_finite)]
"""Any value; what else is wrong with it shows where it is put in."""

Values = Annotated[dict[str, Any], AfterValidator(_all_finite)]
"""Values by key path."""


class Variant(Part):
    """Changes of the scenario, made in this order."""

    description: str = Field(default="", description="What it is about.")
    changes: Values = Field(
        default={},
        alias="set",
        description="Values by key path. Keys without dots may be nested; a quoted path with a table "
        "replaces that as a whole.",
    )
    additions: Values = Field(
        default={},
        alias="add",
        description="Items by the key path of the list behind which they come.",
    )
    removals: tuple[str, ...] = Field(
        default=(), alias="remove", description="Key paths of what is taken out."
    )

    @property
    def paths(self) -> list[str]:
        """Key paths of all that it changes."""
        added = [f"{path}.+" for path, _ in _flat(self.additions)]
        return [*(path for path, _ in _flat(self.changes)), *added, *self.removals]

    @model_validator(mode="after")
    def _changes_something(self) -> Self:
        if not (self.changes or self.additions or self.removals):
            raise fault("it changes nothing", "give set, add or remove")
        return self


def _none_is_all(variants: dict[str, Variant]) -> dict[str, Variant]:
    if ALL in variants:
        raise fault(f"a variant is named {ALL}, which stands for all of them", "name it otherwise")
    return variants


Variants = Annotated[
    dict[Annotated[Name, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$")], Variant],
    AfterValidator(_none_is_all),
]
"""Variants by name, from which folders are named too."""


def apply_variant(
    document: Mapping[str, Any], name: str, variant: Variant, source: Path
) -> dict[str, Any]:
    """Document of a variant: the scenario's, changed, without its variants.

    Raises
    ------
    ScenarioError
        A path leads to no place; the finding says of which variant.
    """
    changed: dict[str, Any] = copy_of(document)
    changed.pop("variants", None)
    changed["name"] = f"{document['name']}-{name}"
    if variant.description:
        changed["description"] = variant.description
    make_changes(changed, f"variants.{name}", variant, source)
    return changed


def make_changes(document: dict[str, Any], place: str, variant: Variant, source: Path) -> None:
    """Make a variant's changes in a document itself.

    Parameters
    ----------
    document : dict
    place : str
        Key path of the variant in its file, which findings name.
    variant : Variant
    source : Path
        That file.

    Raises
    ------
    ScenarioError
        A path leads to no place.
    """
    for path, value in _flat(variant.changes):
        _put(document, f"{place}.set", path, value, source)
    for path, items in _flat(variant.additions):
        for item in items if isinstance(items, list | tuple) else [items]:
            _put(document, f"{place}.add", f"{path}.+", item, source)
    for path in variant.removals:
        _take_out(document, f"{place}.remove", path, source)


def _flat(table: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, Any]]:
    """Key paths and values of a table that may be nested."""
    for key, value in table.items():
        if isinstance(value, Mapping) and value and "." not in key and key != ONE_MORE:
            yield from _flat(value, f"{above}{key}.")
        else:
            yield f"{above}{key}", value


def _put(document: dict[str, Any], where: str, path: str, value: Any, source: Path) -> None:
    try:
        put_in(document, {path: value}, source)
    except ScenarioError as error:
        findings = [
            Finding(each.file, f"{where}.{each.key}", each.value, each.problem, each.remedy)
            for each in error.findings
        ]
        raise ScenarioError(findings) from error


def _take_out(document: dict[str, Any], where: str, path: str, source: Path) -> None:
    """Remove what is at a path; that there is nothing is a fault."""
    try:
        places = [place for place in places_of(document, path) if _is_there(document, place)]
        remedy = "name what the scenario has, or leave it out"
    except NoSuchPlaceError as error:
        places, remedy = [], str(error)
    if not places:
        problem = "there is nothing to take out"
        raise ScenarioError([Finding(str(source), where, repr(path), problem, remedy)])
    put_in(document, {path: None}, source)


def _is_there(container: Any, place: str) -> bool:
    for key in place.split("."):
        if isinstance(container, Mapping):
            if key not in container:
                return False
            container = container[key]
        elif int(key) < len(container):
            container = container[int(key)]
        else:
            return False
    return True
