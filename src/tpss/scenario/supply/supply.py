"""The power supply: its system, contact line, high-voltage line and feeding stations."""

from typing import Annotated, Any, Self

from pydantic import Field, ValidationInfo, field_validator, model_validator
from pydantic_core import PydanticKnownError

from tpss import library
from tpss.scenario.fields import (
    Flag,
    FromLibrary,
    Name,
    Part,
    Real,
    demand_unique,
    fault,
    unique,
)
from tpss.scenario.supply.catenary import Catenary, without_reactance
from tpss.scenario.supply.conductor_faults import demand_conductors
from tpss.scenario.supply.conductors import Autotransformers, Conductors
from tpss.scenario.supply.contact_line import (
    ContactLine,
    NeutralSection,
    Post,
    SectionBreak,
    Tied,
    WithoutContactLine,
)
from tpss.scenario.supply.converter_station import ConverterStation, ConverterType
from tpss.scenario.supply.high_voltage import HighVoltageLine
from tpss.scenario.supply.mixed_station import MixedStation
from tpss.scenario.supply.rectifier_station import RectifierStation, RectifierType
from tpss.scenario.supply.storage import Storage
from tpss.scenario.supply.system import DEFAULT_SYSTEM, System, SystemName, system_named
from tpss.scenario.supply.transformer_station import TransformerStation
from tpss.units import kilometres

Station = ConverterStation | TransformerStation | MixedStation | RectifierStation
"""A feeding station of any kind."""

STATIONS = ("converter_stations", "transformer_stations", "mixed_stations", "rectifier_stations")
"""Keys of the supply that list feeding stations, in the order of the results."""

STORAGE = "storage"
"""Key of the supply that lists stores of energy."""

LOWEST_HZ = 10.0
"""Lowest frequency of an alternating current. [Hz]"""

TYPES = {"converter_types": "converters", "rectifier_types": "rectifiers"}
"""Keys of the supply that name own types of stations, and the kind of the library's."""


def _frequency_of_the_system(data: dict[str, Any]) -> float:
    system = data.get("system", DEFAULT_SYSTEM)  # an unknown one has a fault of its own
    return system_named(system).frequency_hz


def _is_direct(data: dict[str, Any]) -> bool:
    """Whether a supply is one of direct current."""
    return system_named(data.get("system", DEFAULT_SYSTEM)).is_direct


def _with_own_types(tables: Any, own: dict[str, Any]) -> Any:
    """Tables of stations, or of their units, with own types in place of their names."""
    if not isinstance(tables, list | tuple):
        return tables
    return [_with_own_type(each, own) if isinstance(each, dict) else each for each in tables]


def _with_own_type(table: dict[str, Any], own: dict[str, Any]) -> dict[str, Any]:
    if isinstance(table.get("type"), str):
        return {**table, "type": own.get(table["type"], table["type"])}
    if "units" in table:
        return {**table, "units": _with_own_types(table["units"], own)}
    return table


class Supply(Part):
    """Everything that feeds the trains."""

    system: SystemName = Field(
        default=DEFAULT_SYSTEM,
        description="Electrification system, a library entry; the result is judged by its limits.",
    )
    frequency_hz: Real = Field(
        default_factory=_frequency_of_the_system,
        ge=0,
        le=60,
        description="Frequency of the contact line; leave it out: that of the system.",
    )
    catenary: Annotated[Catenary, FromLibrary("catenaries")] = Field(
        description="Library name, or a table of your own."
    )
    tracks_tied: Tied | None = Field(
        default=None,
        description="Where the contact lines of several tracks are tied: `everywhere`, at `posts` "
        "(those below, feeding points, stations where lines meet), or `no` (there, but at no posts). "
        "Needed where a line has several tracks.",
    )
    conductors: Conductors | None = Field(
        default=None,
        description="Contact line, rails and feeder as conductors of their own; leave it out: they are "
        "one, with the impedance of the catenary, and rails have no voltage.",
    )
    autotransformers: tuple[Autotransformers, ...] = Field(
        default=(), description="Autotransformers, with `conductors`."
    )
    contact_lines: tuple[ContactLine, ...] = Field(
        default=(), description="Stretches of lines with another contact line, or other ties."
    )
    posts: Annotated[tuple[Post, ...], unique("name")] = Field(
        default=(), description="Coupling posts between tracks."
    )
    section_breaks: Annotated[tuple[SectionBreak, ...], unique("name")] = Field(
        default=(), description="Breaks of the contact line, each with a switch."
    )
    neutral_sections: tuple[NeutralSection, ...] = Field(
        default=(), description="Neutral sections, which part the contact line between phases."
    )
    without_contact_line: tuple[WithoutContactLine, ...] = Field(
        default=(), description="Stretches without contact line: trains run from their own stores."
    )
    junctions_tied: Flag = Field(
        default=True,
        description="Whether the contact lines of lines that meet at a station are tied there, where no "
        "feeding station does it.",
    )
    high_voltage_line: HighVoltageLine | None = Field(
        default=None, description="High-voltage line; leave it out if there is none."
    )
    transformer_stations: Annotated[
        tuple[TransformerStation, ...], unique("name"), unique("position_km", of="line")
    ] = Field(default=(), description="Transformer stations at a grid of the same frequency.")
    converter_types: dict[Name, Annotated[ConverterType, FromLibrary("converters")]] | None = Field(
        default=None, description="Own types of converters by name, for `type` of a station."
    )
    rectifier_types: dict[Name, Annotated[RectifierType, FromLibrary("rectifiers")]] | None = Field(
        default=None, description="Own types of rectifiers by name, for `type` of a station."
    )
    rectifier_stations: Annotated[
        tuple[RectifierStation, ...], unique("name"), unique("position_km", of="line")
    ] = Field(default=(), description="Rectifier stations of a direct-current line.")
    mixed_stations: Annotated[
        tuple[MixedStation, ...], unique("name"), unique("position_km", of="line")
    ] = Field(default=(), description="Converter stations with converters of several types.")
    converter_stations: Annotated[
        tuple[ConverterStation, ...], unique("name"), unique("position_km", of="line")
    ] = Field(
        default=(),
        validate_default=True,
        description="Converter stations; there is at least one feeding station.",
    )
    storage: Annotated[tuple[Storage, ...], unique("name")] = Field(
        default=(), description="Stores of energy at a direct-current line."
    )

    @field_validator("frequency_hz", mode="before")
    @classmethod
    def _of_an_alternating_current(cls, frequency_hz: Any, info: ValidationInfo) -> Any:
        if not isinstance(frequency_hz, int | float) or isinstance(frequency_hz, bool):
            return frequency_hz
        if _is_direct(info.data):
            if frequency_hz != 0:
                raise fault(f"the system {info.data['system']} has no frequency", "leave it out")
        elif frequency_hz == 0:
            raise fault(
                "direct current is a matter of the system",
                'choose a system of direct current, such as system = "DC-1.5kV", and leave it out',
            )
        elif frequency_hz < LOWEST_HZ:
            raise PydanticKnownError("greater_than_equal", {"ge": LOWEST_HZ})
        return frequency_hz

    @field_validator("catenary", mode="before")
    @classmethod
    def _without_reactance(cls, catenary: Any, info: ValidationInfo) -> Any:
        return without_reactance(catenary) if _is_direct(info.data) else catenary

    @field_validator("contact_lines", mode="before")
    @classmethod
    def _stretches_without_reactance(cls, stretches: Any, info: ValidationInfo) -> Any:
        if not _is_direct(info.data) or not isinstance(stretches, list | tuple):
            return stretches
        return [
            {**each, "catenary": without_reactance(each["catenary"])}
            if isinstance(each, dict) and "catenary" in each
            else each
            for each in stretches
        ]

    @field_validator("converter_types", "rectifier_types")
    @classmethod
    def _own_names(
        cls, types: dict[str, Any] | None, info: ValidationInfo
    ) -> dict[str, Any] | None:
        for name in types or ():
            if name in library.entries(TYPES[str(info.field_name)]):
                raise fault(f"{name} is an entry of the library", "give the own type another name")
        return types

    @field_validator("converter_stations", "mixed_stations", "rectifier_stations", mode="before")
    @classmethod
    def _own_types_by_name(cls, stations: Any, info: ValidationInfo) -> Any:
        rectifies = info.field_name == "rectifier_stations"
        own = info.data.get("rectifier_types" if rectifies else "converter_types")
        return _with_own_types(stations, own) if own else stations

    @field_validator("converter_stations")
    @classmethod
    def _at_least_one_station(
        cls, stations: tuple[ConverterStation, ...], info: ValidationInfo
    ) -> tuple[ConverterStation, ...]:
        others = [info.data.get(key) for key in STATIONS if key != info.field_name]
        if not stations and all(each == () for each in others):
            raise PydanticKnownError(
                "too_short", {"field_type": "Tuple", "min_length": 1, "actual_length": 0}
            )
        every = [*stations, *(station for each in others for station in each or ())]
        demand_unique(every, "name")
        demand_unique(every, "position_km", of="line")
        return stations

    def __hash__(self) -> int:
        """Of all but the own types, which the stations hold."""
        return hash(tuple(value for name, value in self if name not in TYPES))

    @property
    def is_direct(self) -> bool:
        """Whether it is one of direct current."""
        return system_named(self.system).is_direct

    @property
    def system_values(self) -> System:
        """Values of its system."""
        return system_named(self.system)

    @property
    def stations(self) -> tuple[Station, ...]:
        """All feeding stations, in the order of the results; one with a connection is two."""
        return tuple(
            part
            for key in STATIONS
            for station in getattr(self, key)
            for part in self._parts_of(station)
        )

    def _parts_of(self, station: Station) -> tuple[Station, ...]:
        """The stations that a station counts as."""
        if not isinstance(station, TransformerStation) or station.connection is None:
            return (station,)
        here = self._neutral_section_of(station)
        return (station,) if here is None else station.sides((here.from_km, here.to_km))

    def _neutral_section_of(self, station: TransformerStation) -> NeutralSection | None:
        """The neutral section at which a station stands."""
        for each in self.neutral_sections:
            on_its_line = None in (each.line, station.line) or each.line == station.line
            if on_its_line and each.from_km <= station.position_km <= each.to_km:
                return each
        return None

    @property
    def converters_in_use(self) -> tuple[ConverterType, ...]:
        """Types of converters of all stations, each as often as a station has it."""
        mixed = (each.type for station in self.mixed_stations for each in station.units)
        return (*(station.type for station in self.converter_stations), *mixed)

    @model_validator(mode="after")
    def _connections_have_a_neutral_section(self) -> Self:
        for station in self.transformer_stations:
            if station.connection and self._neutral_section_of(station) is None:
                raise fault(
                    f"{station.name} feeds two sections by its {station.connection} connection, and "
                    f"there is no neutral section at {kilometres(station.position_km)} km, where it "
                    "stands",
                    "add one to neutral_sections around that place, or place the station at one",
                )
        demand_unique(self.stations, "name")
        return self

    @model_validator(mode="after")
    def _parts_fit_the_current(self) -> Self:
        direct = self.is_direct
        for station in self.stations:
            if isinstance(station, RectifierStation) == direct:
                continue
            if direct:
                raise fault(
                    f"{station.name} is no rectifier station, and the system {self.system} is one of "
                    "direct current",
                    "list it among rectifier_stations, or choose another system",
                )
            raise fault(
                f"{station.name} is a rectifier station, and the system {self.system} is none of direct "
                "current",
                "choose a system of direct current, such as DC-1.5kV, or another kind of station",
            )
        if direct:
            self._demand_resistances_only()
        elif any(each.contact_line is not None for each in self._catenaries):
            raise fault(
                f"contact_line and rails beside the system {self.system}, none of direct current",
                "give r_ohm_per_km and x_ohm_per_km: tpss line-constants computes them from wires",
            )
        return self

    @property
    def _catenaries(self) -> list[Catenary]:
        """All contact lines that are given."""
        return [self.catenary, *(each.catenary for each in self.contact_lines if each.catenary)]

    def _demand_resistances_only(self) -> None:
        """Raise a fault for what only an alternating current has."""
        if self.high_voltage_line is not None:
            raise fault(
                f"a high-voltage line beside the system {self.system} of direct current",
                "leave high_voltage_line out",
            )
        if any(each.has_reactance for each in self._catenaries):
            raise fault(
                "the contact line has a reactance or a capacitance, of which the system "
                f"{self.system} knows none",
                "give resistances only",
            )

    @model_validator(mode="after")
    def _conductors_belong_together(self) -> Self:
        stretches = [each.catenary for each in self.contact_lines if each.catenary is not None]
        demand_conductors(
            self.conductors,
            [self.catenary, *stretches],
            self.stations,
            self.autotransformers,
            self.is_direct,
            self.high_voltage_line is not None,
        )
        return self

    @model_validator(mode="after")
    def _stations_feed_this_system(self) -> Self:
        values = system_named(self.system)
        low, high = values.lowest_pu * values.base_kv, values.highest_pu * values.base_kv
        for station in self.stations:
            if not low <= station.no_load_voltage_kv <= high:
                raise fault(
                    f"{station.name} feeds {station.no_load_voltage_kv:g} kV without load, outside of "
                    f"the {low:g} to {high:g} kV of the system {self.system}",
                    "choose the system or the no-load voltage that is meant",
                )
        return self
