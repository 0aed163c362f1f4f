"""A high-voltage line beside the track, and its transformers."""

from typing import Annotated, Self

from pydantic import ConfigDict, Field, model_validator

from tpss.scenario.fields import (
    FromLibrary,
    Name,
    Part,
    Position,
    Real,
    Whole,
    ascending,
    either_or,
    name_of_line,
    one_of,
)
from tpss.scenario.rating import LineTransformerRating
from tpss.scenario.supply.catenary import SMALLEST_OHM


class Transformer(Part):
    """A transformer between high-voltage line and contact line."""

    r_ohm: Real = Field(
        ge=SMALLEST_OHM, le=100, description="Resistance on the contact line's side."
    )
    x_ohm: Real = Field(
        ge=SMALLEST_OHM, le=100, description="Reactance on the contact line's side."
    )
    rating: LineTransformerRating | None = Field(
        default=None,
        description="What it bears without getting too hot; leave it out: it is not judged.",
    )


class LineType(Part):
    """Conductors of a high-voltage line."""

    r_ohm_per_km: Real = Field(ge=0.001, le=10, description="Resistance at the line's own voltage.")
    x_ohm_per_km: Real = Field(ge=0, le=10, description="Reactance at the line's own voltage.")


class HighVoltageLine(Part):
    """A high-voltage line beside the track, tied to the contact line by transformers."""

    model_config = ConfigDict(json_schema_extra=one_of("transformers_km", "transformers"))

    line: Name | None = name_of_line()
    type: Annotated[LineType, FromLibrary("high_voltage_lines")] = Field(
        description="Library name, or a table of your own."
    )
    transformers_km: Annotated[tuple[Position, ...], ascending("transformers_km")] | None = Field(
        default=None, description="Positions of the transformers between stations."
    )
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
    def _transformers_are_placed_once(self) -> Self:
        if (self.transformers_km is None) == (self.transformers is None):
            raise either_or("transformers_km", "transformers")
        return self
