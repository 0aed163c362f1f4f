"""The contact line along lines of several tracks: its make by stretch, ties between tracks, breaks."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from tpss.scenario.fields import (
    Flag,
    FromLibrary,
    Name,
    Part,
    Position,
    Real,
    fault,
    name_of_line,
    station_at,
)
from tpss.scenario.line import DECIMALS
from tpss.scenario.supply.catenary import Catenary
from tpss.units import kilometres, on_line

Tied = Literal["everywhere", "posts", "no"]
"""Where the contact lines of several tracks are tied."""


class ContactLine(Part):
    """A stretch of a line whose contact line is another one than the supply's."""

    line: Name | None = name_of_line()
    from_km: Position | None = Field(
        default=None, description="Where it begins; leave it out: where the line does."
    )
    to_km: Position | None = Field(
        default=None, description="Where it ends; leave it out: where the line does."
    )
    catenary: Annotated[Catenary, FromLibrary("catenaries")] | None = Field(
        default=None,
        description="Library name, or a table of your own; leave it out: the supply's.",
    )
    tracks_tied: Tied | None = Field(
        default=None,
        description="Where the contact lines of its tracks are tied; leave it out: as the supply says.",
    )

    @model_validator(mode="after")
    def _ends_beyond_its_beginning(self) -> Self:
        if self.from_km is not None and self.to_km is not None and self.to_km <= self.from_km:
            raise fault(
                f"the stretch ends at {self.to_km:g} km, and begins at {self.from_km:g} km",
                "give the lower position as from_km",
            )
        return self


class Post(Part):
    """A coupling post, a switch that ties the contact lines of all tracks at its place."""

    name: Name = Field(description="Name, shown in the results.")
    line: Name | None = name_of_line()
    at: Name | None = station_at()
    position_km: Position = Field(description="Position on its line.")
    closed: Flag = Field(default=True, description="Whether it ties the tracks.")


class NeutralSection(Part):
    """A neutral section, which parts two phases or systems: trains pass it with their power off."""

    line: Name | None = name_of_line()
    from_km: Position = Field(
        description="Where it begins: trains switch off there, coming from lower kilometres."
    )
    to_km: Position = Field(description="Where it ends, at a higher position.")
    raise_s: Real = Field(
        default=0.0,
        ge=0,
        le=3_600,
        description="Time until a train has power again after its head has left it.",
    )

    @property
    def in_words(self) -> str:
        """Where it is, and how long power stays off behind it."""
        ends = f"{kilometres(self.from_km)}-{kilometres(self.to_km)} km"
        off = f", {self.raise_s:g} s until power is back" if self.raise_s > 0.0 else ""
        return f"{on_line(self.line or '', ends)}{off}"

    @property
    def middle_km(self) -> float:
        """Where the contact line is parted. [km]"""
        return round((self.from_km + self.to_km) / 2.0, DECIMALS)

    @model_validator(mode="after")
    def _ends_beyond_its_beginning(self) -> Self:
        if self.to_km <= self.from_km:
            raise fault(
                f"the neutral section ends at {self.to_km:g} km, and begins at {self.from_km:g} km",
                "give the lower position as from_km",
            )
        return self


class WithoutContactLine(Part):
    """A stretch of a line without contact line, along which trains run from their own stores."""

    line: Name | None = name_of_line()
    from_km: Position = Field(description="Where the contact line ends, from lower kilometres.")
    to_km: Position = Field(description="Where it begins again, at a higher position.")

    @property
    def in_words(self) -> str:
        """Where it is."""
        return on_line(self.line or "", f"{kilometres(self.from_km)}-{kilometres(self.to_km)} km")

    @model_validator(mode="after")
    def _ends_beyond_its_beginning(self) -> Self:
        if self.to_km <= self.from_km:
            raise fault(
                f"the stretch ends at {self.to_km:g} km, and begins at {self.from_km:g} km",
                "give the lower position as from_km",
            )
        return self


class SectionBreak(Part):
    """A break of the contact line with a switch; open, it parts the line there, on all tracks."""

    name: Name = Field(description="Name, shown in the results.")
    line: Name | None = name_of_line()
    position_km: Position = Field(description="Position on its line.")
    closed: Flag = Field(default=True, description="Whether the contact line goes on.")
