"""Criteria for a result: limits of the voltage, the peak window, zones of the line."""

from functools import cache
from typing import Annotated, Any, Self

from pydantic import Field, model_validator

from tpss import library
from tpss.scenario.fields import (
    FromLibrary,
    Name,
    Part,
    Position,
    Real,
    entry_of,
    fault,
    name_of_line,
    unique,
)
from tpss.scenario.rail_limits import KIND as RAIL_LIMITS
from tpss.scenario.rail_limits import RailLimits

KIND = "voltage_limits"

USEFUL = ("mean_useful_kv", "mean_useful_fast_kv")
"""Keys of the least mean useful voltage."""


@cache
def limits_of_system(system: str) -> "VoltageLimits":
    """Voltage limits of a system, those of the library."""
    return VoltageLimits.model_validate({"system": system})


class VoltageLimits(Part):
    """Limits of the voltage at the pantograph: those of a system in the library, or one's own."""

    system: Annotated[Name, entry_of(KIND)] = Field(
        default="15kV-16.7Hz",
        description="Library entry, that of the supply's system; the other keys override its values.",
    )
    un_kv: Real = Field(gt=0, description="Nominal voltage, Un.")
    umin2_kv: Real = Field(gt=0, description="Lowest non-permanent voltage, Umin2.")
    umin1_kv: Real = Field(gt=0, description="Lowest permanent voltage, Umin1.")
    umax1_kv: Real = Field(gt=0, description="Highest permanent voltage, Umax1.")
    umax2_kv: Real = Field(gt=0, description="Highest non-permanent voltage, Umax2.")
    longest_low_min: Real = Field(ge=0, description="Longest uninterrupted time below Umin1.")
    longest_high_min: Real = Field(ge=0, description="Longest uninterrupted time above Umax1.")
    mean_useful_kv: Real | None = Field(
        default=None,
        gt=0,
        description="Least mean useful voltage of zones and trains; without one they are not judged. "
        "That of the system holds for its own `un_kv` only.",
    )
    mean_useful_fast_kv: Real | None = Field(
        default=None, gt=0, description="The same on lines with speeds above 200 km/h."
    )

    @model_validator(mode="before")
    @classmethod
    def _start_from_the_library(cls, given: Any) -> Any:
        if not isinstance(given, dict):
            return given
        known = library.entries(KIND)
        system = given.get("system", cls.model_fields["system"].default)
        # An unknown system is reported by its own field; any values allow the others to be checked too.
        entry = system if isinstance(system, str) and system in known else next(iter(known))
        usual = library.values(KIND, entry)
        if given.get("un_kv", usual["un_kv"]) != usual["un_kv"]:
            # A least mean useful voltage belongs to a nominal voltage.
            usual = {key: value for key, value in usual.items() if key not in USEFUL}
        return {**usual, **given}

    @model_validator(mode="after")
    def _limits_are_in_order(self) -> Self:
        keys = ("umin2_kv", "umin1_kv", "un_kv", "umax1_kv", "umax2_kv")
        for low, high in zip(keys, keys[1:], strict=False):
            if getattr(self, low) > getattr(self, high):
                raise fault(
                    f"{low} ({getattr(self, low)} kV) is more than {high} ({getattr(self, high)} kV)",
                    f"keep to the order {', '.join(keys)}",
                )
        return self


class Zone(Part):
    """A section of line whose mean useful voltage is evaluated."""

    name: Name = Field(description="Name, shown in the results.")
    line: Name | None = name_of_line()
    from_km: Position = Field(description="Where it begins.")
    to_km: Position = Field(description="Where it ends.")

    @model_validator(mode="after")
    def _ends_beyond_its_beginning(self) -> Self:
        _demand_growth(self, "from_km", "to_km")
        return self


class Standards(Part):
    """Criteria by which the result is judged; they do not change it."""

    voltage_limits: VoltageLimits = Field(
        default={},
        validate_default=True,
        description="Limits of the voltage at the pantograph.",
    )
    rails: Annotated[RailLimits, FromLibrary(RAIL_LIMITS)] = Field(
        default={},
        validate_default=True,
        description="Limits of rails that are conductors of their own, see `supply.conductors`.",
    )
    peak_from_min: Real = Field(
        default=0.0, ge=0, description="Where the peak window of the mean useful voltage begins."
    )
    peak_to_min: Real | None = Field(
        default=None, gt=0, description="Where it ends; leave it out: at the end of the run."
    )
    zones: Annotated[tuple[Zone, ...], unique("name")] = Field(
        default=(),
        description="Zones of the mean useful voltage; leave them out: the feeding sections "
        "between feeding stations.",
    )

    @model_validator(mode="after")
    def _peak_window_has_a_length(self) -> Self:
        _demand_growth(self, "peak_from_min", "peak_to_min")
        return self


def _demand_growth(part: Part, first: str, last: str) -> None:
    begin, end = getattr(part, first), getattr(part, last)
    if end is not None and end <= begin:
        raise fault(f"{last} ({end}) does not lie beyond {first} ({begin})", f"raise {last}")
