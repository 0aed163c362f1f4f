"""Building blocks of all parts of a scenario: strict numbers, library names, ordered profiles."""

from collections.abc import Sequence
from typing import Annotated, Any, TypeVar

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    Strict,
)
from pydantic_core import PydanticCustomError

from tpss import library


class Part(BaseModel):
    """A frozen part of a scenario that refuses unknown keys."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", allow_inf_nan=False, validate_by_name=True
    )


Real = Annotated[float, Strict()]
Whole = Annotated[int, Strict()]
Flag = Annotated[bool, Strict()]
Name = Annotated[str, Field(min_length=1)]

_Item = TypeVar("_Item")


def from_library(kind: str) -> BeforeValidator:
    """Accept the name of a library entry in place of a table."""

    def look_up(value: Any) -> Any:
        if not isinstance(value, str):
            return value
        entries = library.entries(kind)
        if value not in entries:
            raise PydanticCustomError(
                "unknown_name",
                "the library has no such entry in {kind}",
                {"kind": kind, "known": sorted(entries)},
            )
        return library.values(kind, value)

    return BeforeValidator(look_up)


def ascending(field: str) -> AfterValidator:
    """Demand that the items' `field` grows strictly from one to the next."""

    def check(items: Sequence[_Item]) -> Sequence[_Item]:
        _demand_ascending([getattr(item, field) for item in items], field)
        return items

    return AfterValidator(check)


def ascending_numbers(field: str) -> AfterValidator:
    """Demand that the numbers grow strictly from one to the next."""

    def check(numbers: Sequence[float]) -> Sequence[float]:
        _demand_ascending(numbers, field)
        return numbers

    return AfterValidator(check)


def _demand_ascending(values: Sequence[float], field: str) -> None:
    for before, after in zip(values, values[1:], strict=False):
        if after <= before:
            raise PydanticCustomError(
                "not_ascending",
                "{field} does not grow: {after} follows {before}",
                {"field": field, "before": before, "after": after},
            )


def unique(field: str) -> AfterValidator:
    """Demand that no two items share the same `field`."""

    def check(items: Sequence[_Item]) -> Sequence[_Item]:
        seen: set[Any] = set()
        for item in items:
            value = getattr(item, field)
            if value in seen:
                raise PydanticCustomError(
                    "not_unique", "{field} {value} occurs twice", {"field": field, "value": value}
                )
            seen.add(value)
        return items

    return AfterValidator(check)
