"""Building blocks of all parts of a scenario: strict numbers, library names, ordered profiles."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache, partial
from itertools import pairwise
from operator import lt
from typing import Annotated, Any, Literal, Protocol, TypeVar, get_args, get_origin

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    Strict,
)
from pydantic.fields import FieldInfo
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, PydanticCustomError, PydanticKnownError, core_schema

from tpss import library
from tpss.printable import in_nfc, steering
from tpss.scenario.own_library import own_entries


class Part(BaseModel):
    """A frozen part of a scenario that refuses unknown keys."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", allow_inf_nan=False, validate_by_name=True
    )

    def __dir__(self) -> list[str]:
        """Names that a prompt completes: what a part is, not what pydantic gives to any model."""
        return [
            name
            for name in super().__dir__()
            if name.startswith("__") or not hasattr(BaseModel, name)
        ]


def fields_of(part: Any) -> dict[str, FieldInfo]:
    """Fields of a part of a scenario, a model or a dataclass; empty for anything else."""
    if isinstance(part, type) and issubclass(part, BaseModel):
        return part.model_fields
    fields: dict[str, FieldInfo] = getattr(part, "__pydantic_fields__", {})
    return fields


def _is_integer_one(value: Any) -> Any:
    if type(value) is not int:  # true and 1.0 equal 1
        raise PydanticKnownError("literal_error", {"expected": "1"})
    return value


def marked(part: Any, marker: type, path: str = "") -> Iterator[str]:
    """Key paths below a part of a scenario, ``*`` for any item or key, of the fields with a marker."""
    if get_origin(part) is Annotated:
        kind, *metadata = get_args(part)
        if any(isinstance(each, marker) for each in metadata):
            yield path
        yield from marked(kind, marker, path)
    elif get_origin(part) in (tuple, dict):
        items = get_args(part)[0 if get_origin(part) is tuple else 1]
        yield from marked(items, marker, f"{path}.*")
    elif get_args(part):  # one of several types
        yield from (place for kind in get_args(part) for place in marked(kind, marker, path))
    for name, field in fields_of(part).items():
        key = f"{path}.{field.alias or name}".lstrip(".")
        if any(isinstance(each, marker) for each in field.metadata):
            yield key
        yield from marked(field.annotation, marker, key)


Version = Annotated[Literal[1], BeforeValidator(_is_integer_one)]
Real = Annotated[float, Strict()]
Whole = Annotated[int, Strict()]
Flag = Annotated[bool, Strict()]


class AlongLine:
    """Marks a position that a study scales when it changes the length of the line."""


Position = Annotated[Real, AlongLine()]


LINE = "line"
"""Name of the line that the key of this name describes."""


def _plain_name(name: str) -> str:
    """A name in the form C of Unicode, without anything that cannot be seen."""
    if character := steering(name):
        code = f"U+{ord(character):04X}"
        raise PydanticCustomError(
            "control_character",
            "a control character in a name, {code}, which steers or cannot be seen",
            {"code": code},
        )
    return in_nfc(name)


Name = Annotated[str, Field(min_length=1), AfterValidator(_plain_name)]


def name_of_line() -> Any:
    """Field with the name of the line on which something stands."""
    return Field(
        default=None, description="Name of the line on which it is; needed where there are several."
    )


def station_at() -> Any:
    """Field with the name of the station at which something stands."""
    return Field(
        default=None,
        description="Station where it stands, in place of `position_km` and of `line`.",
    )


class OnLine(Protocol):
    """A part of a scenario on one of its lines."""

    @property
    def line(self) -> str | None:
        """Name of the line; None where there is only one."""


OWN_FILE = {
    "type": "string",
    "pattern": r"\.toml$",
    "description": "A file next to the scenario, which holds the table.",
}
"""JSON Schema of a name that `tpss.scenario.inline` replaces by what is in the file."""

_Item = TypeVar("_Item")


def fault(problem: str, remedy: str) -> PydanticCustomError:
    """A fault with its own message."""
    return PydanticCustomError("fault", "{problem}", {"problem": problem, "remedy": remedy})


def either_or(*keys: str) -> PydanticCustomError:
    """The fault that several of some keys are given, or none."""
    too_many = "leave one of them out" if len(keys) == 2 else "leave all but one of them out"
    remedy = f"{too_many}, or add the one that is missing"
    return fault(f"give either {', '.join(keys[:-1])} or {keys[-1]}", remedy)


def demand_entry(kind: str, name: str, own: str = "") -> str:
    """A name, which must be one of the library's entries of a kind.

    Parameters
    ----------
    kind : str
    name : str
    own : str
        Key path of tables whose names would have been accepted too, for those who tell of the fault.
    """
    known = library.entries(kind)
    if name not in known:
        raise PydanticCustomError(
            "unknown_name",
            "the library has no such entry in {kind}",
            {"kind": kind, "known": sorted({*known, *own_entries().get(kind, ())}), "own": own},
        )
    return name


def entry_of(kind: str) -> AfterValidator:
    """Demand the name of a library entry."""
    return AfterValidator(partial(demand_entry, kind))


@cache
def _library_parts(kind: str, part: type["Part"]) -> dict[str, "Part"]:
    return {name: part.model_validate(library.values(kind, name)) for name in library.entries(kind)}


def library_name(kind: str, part: "Part") -> str:
    """Name of the library entry with the values of a part, or "own"."""
    entries = _library_parts(kind, type(part)).items()
    return next((name for name, known in entries if known == part), "own")


@dataclass(frozen=True)
class FromLibrary:
    """Accept the name of a library entry in place of a table."""

    kind: str
    own: str = ""
    """Key whose tables have names that are accepted too, and are replaced before."""

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.no_info_before_validator_function(self._look_up, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        names: JsonSchemaValue = {"type": "string", "enum": sorted(library.entries(self.kind))}
        own: JsonSchemaValue = {"type": "string", "description": f"A name of {self.own}."}
        return {"anyOf": [names, *([own] if self.own else []), OWN_FILE, handler(schema)]}

    def _look_up(self, value: Any) -> Any:
        if not isinstance(value, str):
            return value
        return library.values(self.kind, demand_entry(self.kind, value, self.own))


def one_of(*keys: str) -> Callable[[JsonSchemaValue], None]:
    """For the JSON Schema of a part: demand exactly one of some keys."""

    def demand(schema: JsonSchemaValue) -> None:
        schema["required"] = [key for key in schema["required"] if key not in keys]
        schema["oneOf"] = [{"required": [key]} for key in keys]

    return demand


def ascending(field: str) -> AfterValidator:
    """Demand that numbers, or the items' `field`, increase strictly from one to the next."""

    def check(items: Sequence[_Item]) -> Sequence[_Item]:
        values: list[Any] = [getattr(item, field, item) for item in items]
        if not all(map(lt, values, values[1:])):
            before, after = next(pair for pair in pairwise(values) if not lt(*pair))
            raise PydanticCustomError(
                "not_ascending",
                "{field} does not increase: {after} follows {before}",
                {"field": field, "before": before, "after": after},
            )
        return items

    return AfterValidator(check)


def unique(field: str, of: str = "") -> AfterValidator:
    """Demand that no two items share the same `field`, or none of those with the same `of`."""

    def check(items: Sequence[_Item]) -> Sequence[_Item]:
        demand_unique(items, field, of)
        return items

    return AfterValidator(check)


def demand_unique(items: Sequence[Any], field: str, of: str = "") -> None:
    """Raise a fault if two items share the same `field`, and `of`."""
    seen: set[Any] = set()
    for item in items:
        value, whole = getattr(item, field), getattr(item, of) if of else None
        if (whole, value) in seen:
            raise PydanticCustomError(
                "not_unique", "{field} {value} occurs twice", {"field": field, "value": value}
            )
        seen.add((whole, value))
