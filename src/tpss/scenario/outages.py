"""Outages: what of the supply is out of service, throughout a run or for a time.

They are kept in a scenario's file; one of them applies if `simulation.outage` names it.
"""

import re
from collections.abc import Iterator, Sequence
from typing import Annotated, Self

from pydantic import Field, model_validator

from tpss.errors import Finding, closest
from tpss.scenario.fields import Name, Part, Position, Real, Whole, fault, unique
from tpss.scenario.simulation import Simulation
from tpss.scenario.supply import Station, Supply
from tpss.scenario.supply.converter_station import ConverterStation
from tpss.scenario.supply.transformers import feeding_positions_km
from tpss.units import kilometres

SWITCHES = ("posts", "section_breaks")
"""Keys of the supply that list switches."""

SAME_PLACE_KM = 0.0004
"""A transformer no further away is the one that is meant; no two are closer than a metre. [km]"""


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
        default=(), description="Coupling posts and section breaks that are open, throughout a run."
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
        if not (self.stations or self.units or self.transformers_km or self.opens):
            raise fault("nothing is out", "give stations, units, transformers_km or opens")
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
    def _switches_stay(self) -> Self:
        if self.opens and not self.is_throughout:
            raise fault(
                "posts and section breaks open throughout a run only",
                "leave from_min and to_min out, or opens",
            )
        return self

    @model_validator(mode="after")
    def _ends_after_it_begins(self) -> Self:
        if self.to_min is not None and self.to_min <= self.from_min:
            raise fault(
                f"it ends at {self.to_min:g} min, and begins at {self.from_min:g} min",
                "give a to_min after from_min, or leave it out",
            )
        return self


Outages = Annotated[tuple[Outage, ...], unique("name")]


def outage_faults(
    outages: Sequence[Outage], simulation: Simulation, supply: Supply, file: str
) -> list[Finding]:
    """What outages name that the supply does not have, and a choice of one that there is not."""
    findings = [
        Finding(file, f"outages.{i}.{key}", value, problem, remedy)
        for i, outage in enumerate(outages)
        for key, value, problem, remedy in _faults(outage, supply)
    ]
    names, chosen = [outage.name for outage in outages], simulation.outage
    if chosen is not None and chosen not in names:
        problem, remedy = unknown("outage", chosen, names)
        findings.append(Finding(file, "simulation.outage", repr(chosen), problem, remedy))
    if chosen is not None and simulation.load_flow == "least-squares":
        problem = "the original program's load flow knows no outages"
        remedy = 'use load_flow = "equations", or leave simulation.outage out'
        value = repr(simulation.load_flow)
        findings.append(Finding(file, "simulation.load_flow", value, problem, remedy))
    return findings


def unknown(kind: str, name: str, known: Sequence[str]) -> tuple[str, str]:
    """Problem and remedy of a name that there is not."""
    hint = f"did you mean {close}? " if (close := closest(name, known)) else ""
    return f"there is no such {kind}", f"{hint}{kind}s: {', '.join(known) or 'none'}"


_Fault = tuple[str, str, str, str]


def _faults(outage: Outage, supply: Supply) -> Iterator[_Fault]:
    stations = {station.name: station for station in supply.stations}
    named = [(f"stations.{i}", name) for i, name in enumerate(outage.stations)]
    for key, name in [*named, *((f"units.{name}", name) for name in outage.units)]:
        if name not in stations:
            yield key, repr(name), *unknown("station", name, list(stations))
    switches = [each.name for kind in SWITCHES for each in getattr(supply, kind)]
    for i, name in enumerate(outage.opens):
        if name not in switches:
            yield f"opens.{i}", repr(name), *unknown("switch", name, switches)
    for name, count in outage.units.items():
        if name in stations:
            yield from _units(name, count, stations[name])
    known_km = feeding_positions_km(supply)
    for i, km in enumerate(outage.transformers_km):
        if not any(abs(km - each) <= SAME_PLACE_KM for each in known_km):
            listed = ", ".join(f"{kilometres(each)} km" for each in known_km) or "none"
            problem = "the high-voltage line has no transformer there"
            yield f"transformers_km.{i}", kilometres(km), problem, f"transformers: {listed}"


def _units(name: str, count: int, station: Station) -> Iterator[_Fault]:
    """More units out than there are, or so many that the others' motors have no voltage left."""
    key, left = f"units.{name}", station.installed - count
    if left < 0:
        problem = f"more than are installed there, {station.installed}"
        yield key, str(count), problem, f"give {station.installed} or less"
    elif left > 0 and isinstance(station, ConverterStation):
        reduced = station.model_copy(update={"converters": left})
        if station.grid_reactive_power_mvar <= reduced.least_reactive_mvar:
            problem = (
                f"with {left} converters, grid_reactive_power_mvar "
                f"({station.grid_reactive_power_mvar:g} Mvar) leaves the motors no voltage"
            )
            yield key, str(count), problem, "take less reactive power from the grid"
