"""Times of the clock: HH:MM or HH:MM:SS, which go on beyond 24:00 on the following day.

A simulation counts minutes from its start.  Where it says what the clock shows then, times may be given
by the clock; they become minutes as they are read.
"""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import (
    AfterValidator,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    ValidationInfo,
    WithJsonSchema,
)
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from tpss.scenario.fields import Real, fault

PATTERN = r"^[0-9]{1,3}:[0-5][0-9](:[0-5][0-9])?$"
"""Regular expression of a time of the clock."""

DAY_S = 24 * 3600
"""A day. [s]"""

START_S = "start_s"
"""Key of the validation's context: what the clock shows at minute 0, None if it is not known. [s]"""


def seconds_of(text: str) -> int | None:
    """Seconds from midnight to a time of the clock; None if the text is none. [s]"""
    if re.match(PATTERN, text) is None:
        return None
    hours, minutes, *seconds = (int(part) for part in text.split(":"))
    return 3600 * hours + 60 * minutes + sum(seconds)


def clock_at(minute: float, start_s: float) -> str:
    """What the clock shows at a minute of a simulation, in whole seconds; empty if that is NaN."""
    if math.isnan(minute):
        return ""
    minutes, seconds = divmod(round(start_s + 60.0 * minute), 60)
    return f"{minutes // 60:02d}:{minutes % 60:02d}:{seconds:02d}"


def start_of(document: Mapping[str, Any]) -> float | None:
    """What the clock shows at the start of a document's simulation; None if that is not said. [s]

    Of a time that is none, which has a fault of its own, it is 0.
    """
    simulation = document.get("simulation")
    text = simulation.get("starts_at") if isinstance(simulation, Mapping) else None
    if text is None:
        return None
    return float((seconds_of(text) if isinstance(text, str) else None) or 0)


def minute_of(text: str, start_s: float | None) -> float:
    """Minute of a simulation at a time of the clock. [min]

    Raises
    ------
    PydanticCustomError
        It is no such time, or one before the start, or the start is not known.
    """
    time_s = seconds_of(text)
    if time_s is None:
        raise fault(
            "neither a number of minutes nor a time of the clock",
            "write a number without quotes, or HH:MM or HH:MM:SS in quotes",
        )
    if start_s is None:
        raise fault(
            "a time of the clock, of which minute 0 is not known",
            'add starts_at to [simulation], such as starts_at = "05:30", or give minutes',
        )
    if time_s < start_s:
        start = clock_at(0.0, start_s)
        raise fault(
            f"before the start of the simulation, at {start}",
            f"let simulation.starts_at be earlier; after midnight, go on with {time_s // 3600 + 24}:00",
        )
    return (time_s - start_s) / 60.0


@dataclass(frozen=True)
class OrClock:
    """Accept a time of the clock in place of minutes."""

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.with_info_before_validator_function(self._read, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        return {"anyOf": [handler(schema), {"type": "string", "pattern": PATTERN}]}

    def _read(self, value: Any, info: ValidationInfo) -> Any:
        if not isinstance(value, str):
            return value
        return minute_of(value, (info.context or {}).get(START_S))


Moment = Annotated[Real, Field(ge=0, le=100_000), OrClock()]
"""A minute of the simulation, or a time of the clock."""


def _is_of_a_day(text: str) -> str:
    time_s = seconds_of(text)
    if time_s is None or time_s >= DAY_S:
        raise fault("not a time of the clock", 'write HH:MM or HH:MM:SS, such as "05:30"')
    return text


ClockTime = Annotated[
    str, AfterValidator(_is_of_a_day), WithJsonSchema({"type": "string", "pattern": PATTERN})
]
"""A time of the clock."""
