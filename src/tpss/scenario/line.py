"""The line: its length, gradients, speed limits and stations."""

from typing import Annotated

from pydantic import ConfigDict, Field
from pydantic.dataclasses import dataclass

from tpss.scenario.fields import Name, Part, Position, Real, ascending, one_of, unique


@dataclass(frozen=True, slots=True, config=ConfigDict(extra="forbid", allow_inf_nan=False))
class Gradient:
    """A gradient that applies from its position to that of the next one."""

    # A profile has thousands of them: with slots they need a fifth of the memory.

    from_km: Real = Field(
        ge=-100_000, le=100_000, description="Position from which the gradient applies."
    )
    permille: Real = Field(ge=-100, le=100, description="Rise over run, positive uphill.")


class SpeedLimit(Part):
    """A speed limit that applies from its position to that of the next one."""

    from_km: Position = Field(
        ge=0, le=100_000, description="Position from which the limit applies."
    )
    speed_kmh: Real = Field(ge=1, le=500, description="Highest speed.")


class Station(Part):
    """A passenger station, where trains may begin, stop or end."""

    name: Name = Field(description="Name that traffic entries refer to.")
    position_km: Position = Field(ge=0, description="Position on the line.")


class Line(Part):
    """A railway line from position 0 to its length."""

    model_config = ConfigDict(json_schema_extra=one_of("gradients", "gradients_file"))

    length_km: Real = Field(
        ge=0.01, le=2_000, description="Length; the contact line runs along all of it."
    )
    gradients_file: str | None = Field(
        default=None,
        description="CSV file next to the scenario with the columns position_km and "
        "gradient_permille, in place of `gradients`.",
    )
    gradients: Annotated[tuple[Gradient, ...], Field(min_length=1), ascending("from_km")] = Field(
        description="Gradients; the outer ones continue beyond the ends of the profile."
    )
    speed_limits: Annotated[tuple[SpeedLimit, ...], Field(min_length=1), ascending("from_km")] = (
        Field(description="Speed limits; the first one begins at 0.")
    )
    stations: Annotated[
        tuple[Station, ...], Field(min_length=2), unique("name"), unique("position_km")
    ] = Field(description="Stations, at least two.")
