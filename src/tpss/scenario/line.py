"""The line: where it begins, its length, gradients, speed limits and stations."""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, Self

from pydantic import (
    AfterValidator,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    field_validator,
    model_validator,
)
from pydantic.dataclasses import dataclass
from pydantic.json_schema import JsonSchemaValue

from tpss.scenario.fields import (
    Flag,
    Name,
    Part,
    Position,
    Real,
    Whole,
    ascending,
    fault,
    unique,
)
from tpss.scenario.routes import EQUAL_KM
from tpss.units import kilometres

FARTHEST_KM = 10_000.0
"""No line begins farther from kilometre 0: nanometres would be lost in rounding. [km]"""

FARTHEST_VALUE_KM = 100_000.0
"""No gradient or limit begins farther from kilometre 0. [km]"""

CLOSEST_KM = 0.001 - 1e-9
"""Least distance between feeding points, or a network's stations, less a margin for rounding. [km]"""

DECIMALS = 9
"""Of the position of a line's end: a micrometre."""

MOST_TRACKS = 8
"""Of a line."""

Piece = tuple[float, float, float]
"""Beginning and end of a piece of constant value [km], and that value."""


@dataclass(frozen=True, slots=True, config=ConfigDict(extra="forbid", allow_inf_nan=False))
class Gradient:
    """A gradient that applies from its position to that of the next one."""

    # A profile has thousands of them: with slots they need a fifth of the memory.

    from_km: Real = Field(
        ge=-FARTHEST_VALUE_KM,
        le=FARTHEST_VALUE_KM,
        description="Position from which the gradient applies.",
    )
    permille: Real = Field(ge=-100, le=100, description="Rise over run, positive uphill.")


class SpeedLimit(Part):
    """A speed limit that applies from its position to that of the next one."""

    from_km: Position = Field(
        ge=-FARTHEST_VALUE_KM,
        le=FARTHEST_VALUE_KM,
        description="Position from which the limit applies.",
    )
    speed_kmh: Real = Field(ge=1, le=500, description="Highest speed.")


class TrackCount(Part):
    """A number of tracks that applies from its position to that of the next one."""

    from_km: Position = Field(
        ge=-FARTHEST_VALUE_KM,
        le=FARTHEST_VALUE_KM,
        description="Position from which the number applies.",
    )
    count: Whole = Field(ge=1, le=MOST_TRACKS, description="Number of tracks.")


class TrackCurve(Part):
    """A curve of the track, which opposes trains on it."""

    from_km: Position = Field(ge=-100_000, le=100_000, description="Where the curve begins.")
    to_km: Position = Field(ge=-100_000, le=100_000, description="Where it ends.")
    radius_m: Real = Field(ge=100, le=100_000, description="Radius; of standard gauge.")

    @model_validator(mode="after")
    def _ends_beyond_its_beginning(self) -> Self:
        if self.to_km <= self.from_km:
            raise fault(
                f"the curve ends at {self.to_km:g} km, and begins at {self.from_km:g} km",
                "give the lower position as from_km",
            )
        return self


class CurveResistance(Part):
    """A formula for the resistance of curves, k / (R - c) in per mille of the train's weight."""

    permille_m: Real = Field(
        ge=0,
        le=5_000,
        description="k, per mille times metres: 800 for 800 / R, 650 for 650 / (R - 55).",
    )
    offset_m: Real = Field(default=0.0, ge=0, le=90, description="c, less than any radius.")


def _one_after_another(curves: Sequence[TrackCurve]) -> Sequence[TrackCurve]:
    for before, after in pairwise(curves):
        if after.from_km < before.to_km:
            raise fault(
                f"a curve begins at {after.from_km:g} km, before the last one ends, at "
                f"{before.to_km:g} km",
                "give each place one radius, and list the curves in ascending order",
            )
    return curves


TrackNumber = Annotated[Whole, Field(ge=1, le=MOST_TRACKS)]
"""Number of a track of a line, counted from the left as seen in rising kilometres."""

Tracks = Annotated[
    Annotated[Whole, Field(ge=1, le=MOST_TRACKS), Tag("number")]
    | Annotated[tuple[TrackCount, ...], Field(min_length=1), ascending("from_km"), Tag("list")],
    Discriminator(lambda value: "list" if isinstance(value, list | tuple) else "number"),
]
"""A number, or one for each stretch."""


class Station(Part):
    """A passenger station, where trains may begin, stop or end."""

    name: Name = Field(description="Name that traffic entries refer to.")
    position_km: Position = Field(description="Position on the line.")
    tracks: Whole = Field(
        default=1,
        ge=1,
        le=50,
        description="Tracks at the station: with more than one, trains may cross there.",
    )
    track_length_m: Real | None = Field(
        default=None,
        ge=10,
        le=10_000,
        description="Length of its shortest track where trains cross; leave it out: any train has room.",
    )


IN_FILES = ("gradients", "speed_limits", "stations")
"""Lists that a line needs, and that may stand in files of their own."""


def _of_files(schema: JsonSchemaValue) -> None:
    """For the JSON Schema: lists that stand in the line's table, or in files that it names."""
    schema["required"] = [key for key in schema["required"] if key not in IN_FILES]
    schema["allOf"] = [
        {"oneOf": [{"required": [key]}, {"required": [f"{key}_file"]}]} for key in IN_FILES
    ]


class Line(Part):
    """A railway line from the kilometre where it begins, over its length; nothing lies outside."""

    model_config = ConfigDict(json_schema_extra=_of_files)

    begins_at_km: Real = Field(
        default=0.0,
        ge=-FARTHEST_KM,
        le=FARTHEST_KM,
        description="Position of its beginning; all positions are in these kilometres.",
    )
    length_km: Real = Field(
        ge=0.01, le=2_000, description="Length; the contact line runs along all of it."
    )
    gradients_file: str | None = Field(
        default=None,
        description="CSV file or workbook next to the scenario with the columns position_km and "
        "gradient_permille, or altitude_m, in place of `gradients`.",
    )
    gradients_smoothed_over_km: Real | None = Field(
        default=None,
        ge=0.01,
        le=100,
        description="Length over which altitudes of `gradients_file` are averaged before gradients are "
        "derived from them, one a length; leave it out: they are taken as they are.",
    )
    gradients: Annotated[tuple[Gradient, ...], Field(min_length=1), ascending("from_km")] = Field(
        description="Gradients; the outer ones continue beyond the ends of the profile."
    )
    speed_limits_file: str | None = Field(
        default=None,
        description="CSV file or workbook with the columns position_km and speed_kmh, in place of "
        "`speed_limits`; with to_km limits have ends, and of several the lowest holds.",
    )
    speed_limits: Annotated[tuple[SpeedLimit, ...], Field(min_length=1), ascending("from_km")] = (
        Field(description="Speed limits; the first one begins where the line does.")
    )
    speed_limits_down: Annotated[tuple[SpeedLimit, ...], ascending("from_km")] = Field(
        default=(),
        description="Speed limits of trains that run towards falling kilometres, if they are others; in "
        "rising kilometres too.",
    )
    speed_limits_down_file: str | None = Field(
        default=None, description="Likewise, in place of `speed_limits_down`."
    )
    tracks: Tracks = Field(
        default=1,
        description="Number of tracks; or a list, each number with from_km, where it begins.",
    )
    left_hand_running: Flag = Field(
        default=False,
        description="Whether trains run on the left of several tracks, seen in their direction.",
    )
    curves: Annotated[tuple[TrackCurve, ...], AfterValidator(_one_after_another)] = Field(
        default=(), description="Curves; between them the track is straight."
    )
    curve_resistance: CurveResistance | None = Field(
        default=None, description="Formula for their resistance; leave it out: that of Röckl."
    )
    stations_file: str | None = Field(
        default=None,
        description="CSV file or workbook with the columns name and position_km, and perhaps tracks and "
        "track_length_m, in place of `stations`.",
    )
    stations: Annotated[
        tuple[Station, ...], Field(min_length=2), unique("name"), unique("position_km")
    ] = Field(description="Stations, at least two.")

    @field_validator("stations")
    @classmethod
    def _stations_lie_apart(cls, stations: tuple[Station, ...]) -> tuple[Station, ...]:
        """Nearer ones would be equally far from anywhere, so that no way could be told from another."""
        for one, next_ in pairwise(sorted(stations, key=lambda station: station.position_km)):
            if next_.position_km - one.position_km <= EQUAL_KM:
                raise fault(
                    f"{one.name} and {next_.name} lie within a millimetre of each other",
                    "move one of them, or leave it out",
                )
        return stations

    @field_validator("gradients_smoothed_over_km")
    @classmethod
    def _smooths_a_file(cls, value: float | None) -> float | None:
        if value is not None:  # with a file, the key has gone where the file has
            raise fault("no gradients_file is given whose altitudes it smooths", "leave it out")
        return value

    @property
    def end_km(self) -> float:
        """Position of its end. [km]"""
        return end_of_line(self.begins_at_km, self.length_km)

    @property
    def speeds_kmh(self) -> list[float]:
        """Speeds of all limits, those of both directions. [km/h]"""
        return [limit.speed_kmh for limit in (*self.speed_limits, *self.speed_limits_down)]

    @property
    def in_words(self) -> str:
        """Its length and, unless it begins at 0, its ends."""
        length, begin, end = map(kilometres, (self.length_km, self.begins_at_km, self.end_km))
        return (
            f"{length} km" if self.begins_at_km == 0.0 else f"{length} km, from {begin} to {end} km"
        )

    @property
    def most_tracks(self) -> int:
        """Number of tracks where it has most."""
        return max(int(count) for *_, count in self.tracks_by_stretch)

    @property
    def tracks_by_stretch(self) -> list[Piece]:
        """Stretches with the same number of tracks."""
        if isinstance(self.tracks, int):
            return [(self.begins_at_km, self.end_km, self.tracks)]
        counts = [(each.from_km, each.count) for each in self.tracks]
        return _pieces(counts, self.begins_at_km, self.end_km)

    def mirrored(self) -> Self:
        """The line as trains see it that run towards falling kilometres: positions are minus those here.

        It rises where this one falls.
        """
        gradients = [(each.from_km, each.permille) for each in self.gradients]
        limits = [
            (each.from_km, each.speed_kmh) for each in self.speed_limits_down or self.speed_limits
        ]
        turned = {
            "begins_at_km": -self.end_km,
            "gradients": tuple(
                Gradient(from_km=from_km, permille=-permille)
                for from_km, permille in _turned(gradients, self.end_km)
            ),
            "speed_limits": tuple(
                SpeedLimit(from_km=from_km, speed_kmh=speed_kmh)
                for from_km, speed_kmh in _turned(limits, self.end_km)
            ),
            "curves": tuple(
                curve.model_copy(update={"from_km": -curve.to_km, "to_km": -curve.from_km})
                for curve in reversed(self.curves)
            ),
            "stations": tuple(
                station.model_copy(update={"position_km": -station.position_km})
                for station in reversed(self.stations)
            ),
        }
        return self.model_copy(update=turned)

    def gradients_between(self, start_km: float, end_km: float) -> list[Piece]:
        """Pieces of the gradient profile between two positions. [‰]"""
        return _pieces([(g.from_km, g.permille) for g in self.gradients], start_km, end_km)

    def speed_limits_between(self, start_km: float, end_km: float) -> list[Piece]:
        """Pieces of the speed profile between two positions. [km/h]"""
        return _pieces([(s.from_km, s.speed_kmh) for s in self.speed_limits], start_km, end_km)


def end_of_line(begin_km: float, length_km: float) -> float:
    """Position of the end of a line, as one would write it. [km]

    A sum such as 438.1 + 40.2 is not 478.3 to the last digit, where a station stands.
    """
    return length_km if begin_km == 0.0 else round(begin_km + length_km, DECIMALS)


def _turned(profile: Sequence[tuple[float, float]], end_km: float) -> list[tuple[float, float]]:
    """A profile over minus its positions; the outer values continue there too. [km]"""
    last_km = profile[-1][0]
    before_km = -end_km if last_km < end_km else max(-last_km - 1.0, -FARTHEST_VALUE_KM)
    begins = [before_km, *(-km for km, _ in profile[:0:-1])]
    return list(zip(begins, (value for _, value in reversed(profile)), strict=True))


def _pieces(profile: Sequence[tuple[float, float]], start_km: float, end_km: float) -> list[Piece]:
    begins = [-math.inf, *(from_km for from_km, _ in profile[1:])]
    pieces = [
        (max(begin, start_km), min(end, end_km), value)
        for begin, end, (_, value) in zip(begins, [*begins[1:], math.inf], profile, strict=True)
    ]
    return [piece for piece in pieces if piece[0] < piece[1]]
