"""Outages: what of the supply is out of service, throughout a run or for a time.

They are kept in a scenario's file; one of them applies if `simulation.outage` names it.
"""

import re
from typing import Annotated, Self

from pydantic import Field, model_validator

from tpss.scenario.fields import (
    Name,
    Part,
    Position,
    Real,
    Whole,
    fault,
    name_of_line,
    unique,
)
from tpss.scenario.line import TrackNumber
from tpss.scenario.supply import Station, Supply
from tpss.units import kilometres, on_line

SWITCHES = ("posts", "section_breaks")
"""Keys of the supply that list switches, feeds left out, which stations have."""

SAME_PLACE_KM = 0.0004
"""A transformer no further away is the one that is meant; no two are closer than a metre. [km]"""


class OutSection(Part):
    """A section of the contact line that is out: parted at its ends, and from what feeds or ties it."""

    line: Name | None = name_of_line()
    track: TrackNumber | None = Field(
        default=None,
        description="Number of its track, counted from the left as seen in rising kilometres; leave it "
        "out: all tracks.",
    )
    from_km: Position | None = Field(
        default=None, description="Where it begins; leave it out: where the line does."
    )
    to_km: Position | None = Field(
        default=None, description="Where it ends; leave it out: where the line does."
    )

    @property
    def in_words(self) -> str:
        """Which it is."""
        begin = None if self.from_km is None else kilometres(self.from_km)
        end = None if self.to_km is None else kilometres(self.to_km)
        place = f"{begin}-{end} km"
        if begin is None or end is None:
            place = f"from {begin} km on" if begin else f"up to {end} km" if end else "as a whole"
        track = "" if self.track is None else f" of track {self.track}"
        return f"contact line {on_line(self.line or '', place)}{track}"

    def ends_km(self, begins_at_km: float, end_km: float) -> tuple[float, float]:
        """Where it begins and ends, on a line from one place to another. [km]"""
        begin = begins_at_km if self.from_km is None else self.from_km
        return begin, end_km if self.to_km is None else self.to_km

    def covers(self, begin_km: float, end_km: float, track: int | None) -> bool:
        """Whether a track is out between two places of its line; or all of them, if it is None. [km]"""
        begins = self.from_km is None or self.from_km <= begin_km
        ends = self.to_km is None or end_km <= self.to_km
        return begins and ends and self.track in (None, track)

    @model_validator(mode="after")
    def _ends_beyond_its_beginning(self) -> Self:
        if self.from_km is not None and self.to_km is not None and self.to_km <= self.from_km:
            raise fault(
                f"the section ends at {self.to_km:g} km, and begins at {self.from_km:g} km",
                "give the lower position as from_km",
            )
        return self


class OutAutotransformer(Part):
    """An autotransformer that is out."""

    line: Name | None = name_of_line()
    position_km: Position = Field(description="Where it stands.")

    @property
    def in_words(self) -> str:
        """Which it is."""
        return f"autotransformer {on_line(self.line or '', f'{kilometres(self.position_km)} km')}"

    def is_at(self, line: str | None, position_km: float) -> bool:
        """Whether it is the one at a place of a line, or of the only one. [km]"""
        return self.line in (None, line) and abs(self.position_km - position_km) <= SAME_PLACE_KM


class Outage(Part):
    """Elements of the supply that are out of service."""

    name: Name = Field(description="Name, by which it is chosen and listed.")
    stations: tuple[Name, ...] = Field(
        default=(), description="Feeding stations that are out as a whole."
    )
    units: dict[Name, Annotated[Whole, Field(ge=1)]] = Field(
        default={},
        description="Units out of service by the name of their station: converters, or transformers "
        "of a transformer station.",
    )
    transformers_km: tuple[Position, ...] = Field(
        default=(), description="Positions of transformers of the high-voltage line that are out."
    )
    opens: tuple[Name, ...] = Field(
        default=(),
        description="Coupling posts, section breaks and feeds that are open; a feed is named by its "
        "station and its line, as in `West>main`.",
    )
    sections: tuple[OutSection, ...] = Field(
        default=(), description="Sections of the contact line that are out."
    )
    autotransformers: tuple[OutAutotransformer, ...] = Field(
        default=(), description="Autotransformers that are out."
    )
    storage: tuple[Name, ...] = Field(
        default=(),
        description="Stores of energy at the line that are out: parted from it, with what they hold.",
    )
    from_min: Real = Field(
        default=0.0, ge=0, le=100_000, description="When it begins, from the start of the run."
    )
    to_min: Real | None = Field(
        default=None, ge=0, le=100_000, description="When it ends; leave it out: with the run."
    )

    @property
    def in_words(self) -> str:
        """What is out, and when."""
        parts = [f"{name} out" for name in self.stations]
        parts += [f"{count} of {name}'s units out" for name, count in self.units.items()]
        parts += [f"transformer at {kilometres(km)} km out" for km in self.transformers_km]
        parts += [f"{name} open" for name in self.opens]
        parts += [f"{each.in_words} out" for each in self.sections]
        parts += [f"{each.in_words} out" for each in self.autotransformers]
        parts += [f"store {name} out" for name in self.storage]
        end = "the end" if self.to_min is None else f"{self.to_min:g} min"
        when = "" if self.is_throughout else f", from {self.from_min:g} min to {end}"
        return ", ".join(parts) + when

    @property
    def is_throughout(self) -> bool:
        """Whether it holds for a whole run, however long."""
        return self.from_min == 0.0 and self.to_min is None

    @property
    def slug(self) -> str:
        """Its name as part of the name of a scenario, and so of a folder."""
        return re.sub(r"[^A-Za-z0-9._]+", "-", self.name).strip("-.") or "outage"

    def units_of(self, station: Station) -> int:
        """Number of a station's units that are out."""
        return (
            station.installed if station.name in self.stations else self.units.get(station.name, 0)
        )

    @model_validator(mode="after")
    def _takes_something_out(self) -> Self:
        named = self.stations or self.units or self.transformers_km or self.opens or self.storage
        if not (named or self.sections or self.autotransformers):
            raise fault(
                "nothing is out",
                "give stations, units, transformers_km, opens, sections, autotransformers or storage",
            )
        if both := [name for name in self.stations if name in self.units]:
            raise fault(
                f"{both[0]} is out as a whole, and some of its units besides",
                "leave it out of stations or of units",
            )
        return self

    def switched(self, supply: Supply) -> Supply:
        """The supply with what it opens open."""
        if not self.opens:
            return supply
        switches = {
            kind: tuple(
                each.model_copy(update={"closed": False}) if each.name in self.opens else each
                for each in getattr(supply, kind)
            )
            for kind in SWITCHES
        }
        return supply.model_copy(update=switches)

    @model_validator(mode="after")
    def _ends_after_it_begins(self) -> Self:
        if self.to_min is not None and self.to_min <= self.from_min:
            raise fault(
                f"it ends at {self.to_min:g} min, and begins at {self.from_min:g} min",
                "give a to_min after from_min, or leave it out",
            )
        return self


Outages = Annotated[tuple[Outage, ...], unique("name")]
