"""Converter stations between the 50 Hz grid and the railway."""

import math
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from tpss.scenario.fields import (
    FromLibrary,
    Part,
    Real,
    Whole,
    fault,
    library_name,
)
from tpss.scenario.own_laws import ConverterLaw, demand_voltages
from tpss.scenario.rating import Rating
from tpss.scenario.supply.feedback import ConverterFeedback, converter_feedback
from tpss.scenario.supply.feeding_station import FeedingStation
from tpss.scenario.supply.losses import ConverterLosses
from tpss.units import si


class ConverterType(Part):
    """A frequency converter; reactances in per unit of their bases."""

    rating_mva: Real = Field(ge=0.1, le=1_000, description="Rated power of one converter.")
    no_load_voltage_kv: Real = Field(ge=0.1, le=100, description="Terminal voltage without load.")
    droop_kv_per_mvar: Real = Field(ge=0, le=1, description="Fall of voltage per reactive power.")
    generator_reactance_pu: Real = Field(
        ge=0, le=10, description="q-axis reactance of the generator."
    )
    generator_base_mva: Real = Field(
        ge=0.1, le=1_000, description="Base of the generator's reactance."
    )
    motor_reactance_pu: Real = Field(ge=0, le=10, description="q-axis reactance of the motor.")
    motor_base_mva: Real = Field(ge=0.1, le=1_000, description="Base of the motor's reactance.")
    base_voltage_kv: Real = Field(ge=1, le=100, description="Base of both, on the railway's side.")
    current_limit_percent: Real | None = Field(
        default=None,
        ge=50,
        le=1_000,
        description="Highest current of a static converter, of that at rated power and no-load voltage: "
        "beyond it the voltage falls, and other stations have to give more; leave it out: no limit.",
    )
    losses: ConverterLosses | None = Field(
        default=None, description="What one converter loses; leave it out: not described."
    )
    rating: Rating | None = Field(
        default=None,
        description="What it bears without getting too hot, of `rating_mva`; leave it out: it is not "
        "judged.",
    )


class ConverterStation(FeedingStation):
    """A converter station that feeds the contact line."""

    type: Annotated[ConverterType, FromLibrary("converters", own="supply.converter_types")] = Field(
        description="Library name, a name of `supply.converter_types`, or a table of your own."
    )
    converters: Whole = Field(ge=1, le=100, description="Number of converters installed.")
    control: Literal["all-on", "loading"] = Field(
        default="all-on",
        description="Whether all converters run, or as many as the loading needs.",
    )
    law: ConverterLaw | None = Field(
        default=None,
        description="Voltage and angle of its converters by a law of another package, in place of those "
        "of their type; leave it out: by the type's droop and reactances.",
    )
    feedback: ConverterFeedback = converter_feedback()
    station_kw: Real | None = Field(
        default=None,
        ge=0,
        le=10_000,
        description="Power of the station's auxiliaries, such as cooling, taken from the 50 Hz grid as "
        "long as it is in service; leave it out: not described.",
    )
    grid_reactance_ohm: Real = Field(
        default=0.0, ge=0, le=100, description="Reactance of the 50 Hz grid, on the railway's side."
    )
    grid_reactive_power_mvar: Real = Field(
        default=0.0,
        ge=-100,
        le=100,
        description="Reactive power that the station delivers to the 50 Hz grid.",
    )
    grid_angle_deg: Real = Field(
        default=0.0,
        ge=-60,
        le=60,
        description="Angle of the 50 Hz grid, seen at the railway's frequency.",
    )

    @property
    def has_bounds(self) -> bool:
        """Whether its law has bounds: a highest current, or no power back."""
        return self.type.current_limit_percent is not None or self.feedback == "none"

    @property
    def least_reactive_mvar(self) -> float:
        """Reactive power to the 50 Hz grid at which it, or the motors, have no voltage left. [Mvar]

        There the denominator of an angle of (2.2) is 0: the grid carries the power of the whole station,
        a motor that of one converter, of the fewest that may run.
        """
        running = 1 if self.control == "loading" else self.converters
        square_kv2, kind = self.type.base_voltage_kv**2, self.type
        limits_mvar = [-math.inf]
        if kind.motor_reactance_pu > 0.0:
            limits_mvar.append(-running * kind.motor_base_mva / kind.motor_reactance_pu)
        if self.grid_reactance_ohm > 0.0:
            limits_mvar.append(-square_kv2 / self.grid_reactance_ohm)
        return max(limits_mvar)

    @model_validator(mode="after")
    def _motors_have_a_voltage(self) -> Self:
        if self.grid_reactive_power_mvar <= self.least_reactive_mvar:
            raise fault(
                f"grid_reactive_power_mvar ({self.grid_reactive_power_mvar:g} Mvar) leaves the motors "
                f"or the 50 Hz grid no voltage, which ends at {self.least_reactive_mvar:.4g} Mvar",
                "take less reactive power from the grid, or run more converters",
            )
        return self

    @model_validator(mode="after")
    def _own_law_stands_alone(self) -> Self:
        if self.law is None:
            return self
        for name in ("grid_reactance_ohm", "grid_reactive_power_mvar"):
            if getattr(self, name) != 0.0:
                raise fault(f"{name} has no part in {self.law.law!r}", f"leave out {name}, or law")
        if self.has_bounds:
            raise fault(
                f"the law {self.law.law!r} knows neither a limit of the current nor of what is fed back",
                'leave out law, or current_limit_percent and feedback = "none"',
            )
        demand_voltages(self.law, si(self.type, "rating_mva"))
        return self

    @property
    def installed(self) -> int:
        """Number of converters installed."""
        return self.converters

    @property
    def no_load_voltage_kv(self) -> float:
        """Terminal voltage without load. [kV]"""
        if self.law is not None:
            return self.law.unloaded_v / 1e3
        return self.type.no_load_voltage_kv

    @property
    def unit_mva(self) -> float:
        """Rated power of one unit. [MVA]"""
        return self.type.rating_mva

    @property
    def in_words(self) -> str:
        """What stands there."""
        converter = library_name("converters", self.type)
        by_law = f" by the law {self.law.law}" if self.law is not None else ""
        size = f"{self.converters} x {converter} of {self.unit_mva:g} MVA"
        return f"{size}{by_law}, control {self.control}"
