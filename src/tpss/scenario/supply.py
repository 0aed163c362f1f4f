"""The power supply: contact line, high-voltage line, transformers, converter stations."""

from typing import Annotated, Literal, Self

from pydantic import ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

from tpss.scenario.fields import (
    FromLibrary,
    Name,
    Part,
    Position,
    Real,
    Whole,
    ascending_numbers,
    one_of,
    unique,
)

SMALLEST_OHM = 0.0001
"""Lumped impedances smaller than this are lost in the rounding of voltages. [Ω]"""


class Catenary(Part):
    """A contact-line system, per kilometre; a connection impedance makes it an AT system."""

    r_ohm_per_km: Real = Field(ge=0.001, le=10, description="Resistance.")
    x_ohm_per_km: Real = Field(ge=0, le=10, description="Reactance at the supply's frequency.")
    capacitance_nf_per_km: Real = Field(
        default=0.0, ge=0, le=1_000, description="Capacitance to earth."
    )
    connection_r_ohm: Real = Field(
        default=0.0, ge=0, le=100, description="Resistance between a feeding point and the line."
    )
    connection_x_ohm: Real = Field(
        default=0.0, ge=0, le=100, description="Reactance between a feeding point and the line."
    )

    @model_validator(mode="after")
    def _a_connection_has_an_impedance_that_counts(self) -> Self:
        impedance_ohm = abs(complex(self.connection_r_ohm, self.connection_x_ohm))
        if 0.0 < impedance_ohm < SMALLEST_OHM:
            raise PydanticCustomError(
                "conflict",
                "the connection impedance ({impedance} ohm) is next to nothing",
                {
                    "impedance": impedance_ohm,
                    "remedy": f"give at least {SMALLEST_OHM:g} ohm, or 0: no connection impedance",
                },
            )
        return self


class Transformer(Part):
    """A transformer between high-voltage line and contact line."""

    r_ohm: Real = Field(
        ge=SMALLEST_OHM, le=100, description="Resistance on the contact line's side."
    )
    x_ohm: Real = Field(
        ge=SMALLEST_OHM, le=100, description="Reactance on the contact line's side."
    )


class LineType(Part):
    """Conductors of a high-voltage line."""

    r_ohm_per_km: Real = Field(ge=0.001, le=10, description="Resistance at the line's own voltage.")
    x_ohm_per_km: Real = Field(ge=0, le=10, description="Reactance at the line's own voltage.")


class HighVoltageLine(Part):
    """A high-voltage line beside the track, tied to the contact line by transformers."""

    model_config = ConfigDict(json_schema_extra=one_of("transformers_km", "transformers"))

    type: Annotated[LineType, FromLibrary("high_voltage_lines")] = Field(
        description="Library name, or a table of your own."
    )
    transformers_km: (
        Annotated[tuple[Position, ...], ascending_numbers("transformers_km")] | None
    ) = Field(default=None, description="Positions of the transformers between stations.")
    transformers: Whole | None = Field(
        default=None,
        ge=0,
        le=100,
        description="Number of transformers, equally spaced between neighbouring converter "
        "stations, in place of `transformers_km`.",
    )
    base_kv: Real = Field(default=132.0, ge=15, le=400, description="Voltage of the line.")
    line_transformer: Annotated[Transformer, FromLibrary("transformers")] = Field(
        default="16MVA", validate_default=True, description="Transformer between stations."
    )
    station_transformer: Annotated[Transformer, FromLibrary("transformers")] = Field(
        default="25MVA", validate_default=True, description="Transformer at converter stations."
    )

    @model_validator(mode="after")
    def _one_way_to_place_transformers(self) -> Self:
        if (self.transformers_km is None) == (self.transformers is None):
            raise PydanticCustomError(
                "either_or",
                "give either {first} or {second}",
                {"first": "transformers_km", "second": "transformers"},
            )
        return self


class ConverterType(Part):
    """A frequency converter; reactances in per unit of their bases."""

    rating_mva: Real = Field(ge=0.1, le=1_000, description="Rated power of one converter.")
    no_load_voltage_kv: Real = Field(ge=8.25, le=19.8, description="Terminal voltage without load.")
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


class ConverterStation(Part):
    """A converter station that feeds the contact line."""

    name: Name = Field(description="Name, shown in the results.")
    position_km: Position = Field(ge=0, description="Position on the line.")
    type: Annotated[ConverterType, FromLibrary("converters")] = Field(
        description="Library name, or a table of your own."
    )
    converters: Whole = Field(ge=1, le=100, description="Number of converters installed.")
    control: Literal["all-on", "loading"] = Field(
        default="all-on",
        description="Whether all converters run, or as many as the loading needs.",
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


class Supply(Part):
    """Everything that feeds the trains."""

    frequency_hz: Real = Field(ge=10, le=60, description="Frequency of the contact line.")
    catenary: Annotated[Catenary, FromLibrary("catenaries")] = Field(
        description="Library name, or a table of your own."
    )
    high_voltage_line: HighVoltageLine | None = Field(
        default=None, description="High-voltage line; leave it out if there is none."
    )
    converter_stations: Annotated[
        tuple[ConverterStation, ...],
        Field(min_length=1),
        unique("name"),
        unique("position_km"),
    ] = Field(description="Converter stations, at least one.")
