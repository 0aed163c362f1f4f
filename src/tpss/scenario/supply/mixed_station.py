"""Converter stations whose converters are of different types."""

from typing import Annotated, Self

from pydantic import Field, field_validator, model_validator

from tpss.scenario.fields import (
    FromLibrary,
    Part,
    Real,
    Whole,
    fault,
    library_name,
)
from tpss.scenario.supply.converter_station import ConverterType
from tpss.scenario.supply.feedback import Feedback, feedback
from tpss.scenario.supply.feeding_station import FeedingStation

MOST_TYPES = 3
"""Types of converters that a station may have; the law has as many."""


class ConverterUnits(Part):
    """Converters of one type in a station with several."""

    type: Annotated[ConverterType, FromLibrary("converters", own="supply.converter_types")] = Field(
        description="Library name, a name of `supply.converter_types`, or a table of your own."
    )
    converters: Whole = Field(ge=1, le=100, description="Number of converters of this type.")

    @field_validator("type")
    @classmethod
    def _has_no_limit(cls, kind: ConverterType) -> ConverterType:
        if kind.current_limit_percent is not None:
            raise fault(
                "a station with several types has no current limits",
                "leave current_limit_percent out of its types, or give each type a station of its own",
            )
        return kind

    @property
    def rated_mva(self) -> float:
        """Rated power of all of them. [MVA]"""
        return self.converters * self.type.rating_mva


class MixedStation(FeedingStation):
    """A converter station with converters of several types at one busbar, which all run.

    The types share a load by their own droops and angles; one 50 Hz grid, infinitely strong, feeds all.
    """

    units: Annotated[tuple[ConverterUnits, ...], Field(min_length=1, max_length=MOST_TYPES)] = (
        Field(description="Converters by their types.")
    )
    feedback: Feedback = feedback()
    station_kw: Real | None = Field(
        default=None,
        ge=0,
        le=10_000,
        description="Power of the station's auxiliaries, as of a converter station.",
    )
    grid_angle_deg: Real = Field(
        default=0.0,
        ge=-60,
        le=60,
        description="Angle of the 50 Hz grid, seen at the railway's frequency.",
    )

    @model_validator(mode="after")
    def _types_share_a_load(self) -> Self:
        """At one voltage without load, and none so stiff that it would take all."""
        first = self.units[0].type.no_load_voltage_kv
        for i, each in enumerate(self.units):
            kind = each.type
            if kind.no_load_voltage_kv != first:
                raise fault(
                    f"units.{i} has {kind.no_load_voltage_kv:g} kV without load, units.0 {first:g} kV: "
                    "a current would circulate between them",
                    "give all of them one no_load_voltage_kv",
                )
            reactance = kind.generator_reactance_pu + kind.motor_reactance_pu
            if kind.droop_kv_per_mvar == 0.0 or reactance == 0.0:
                raise fault(
                    f"units.{i} has no droop or no reactance, by which it shares a load with the others",
                    "give it droop_kv_per_mvar and generator_reactance_pu above 0",
                )
        return self

    @property
    def installed(self) -> int:
        """Number of converters installed."""
        return sum(each.converters for each in self.units)

    @property
    def no_load_voltage_kv(self) -> float:
        """Terminal voltage without load. [kV]"""
        return self.units[0].type.no_load_voltage_kv

    @property
    def unit_mva(self) -> float:
        """Mean rated power of its converters. [MVA]"""
        return sum(each.rated_mva for each in self.units) / self.installed

    @property
    def in_words(self) -> str:
        """What stands there."""
        listed = [
            f"{each.converters} x {library_name('converters', each.type)} of "
            f"{each.type.rating_mva:g} MVA"
            for each in self.units
        ]
        return f"{' and '.join(listed)}, all on"
