"""The conductors of a line: what they are made of, and where they hang and lie."""

from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import Field, PrivateAttr, ValidationInfo, field_validator, model_validator

from tpss import library
from tpss.scenario.fields import FromLibrary, Name, Part, Real, Whole, fault, unique

WIRES = "wires"
"""Kind of the library that wires are entries of, and key of wires of one's own."""

REFERENCE_C = 20.0
"""Temperature at which wires have the resistance that is given. [°C]"""

Group = Literal["contact", "rails", "feeder", "positive", "earth"]
"""What a conductor is connected to."""

Method = Literal["carson", "clem", "deri"]
"""Formula of the earth return."""

Rails = Literal["earthed", "insulated"]
"""How well rails are insulated from the earth."""


class Wire(Part):
    """A wire, rail or tube: by its geometric mean radius, or as a round conductor with skin effect."""

    r_ohm_per_km: Real = Field(
        gt=0, le=1_000, description="Resistance of a new one at 20 °C, to direct current."
    )
    radius_mm: Real = Field(gt=0, le=1_000, description="Outer radius.")
    gmr_mm: Real | None = Field(
        default=None,
        gt=0,
        le=1_000,
        description="Geometric mean radius. With it the resistance is taken as that at the frequency; "
        "leave it out: a solid or tubular round conductor, with its skin effect.",
    )
    inner_radius_mm: Real = Field(
        default=0.0, ge=0, le=1_000, description="Inner radius of a tube, without `gmr_mm`."
    )
    relative_permeability: Real = Field(
        default=1.0,
        ge=1,
        le=10_000,
        description="Permeability over that of air, without `gmr_mm`; of steel rails at the current "
        "that they carry.",
    )
    temperature_coefficient_per_k: Real | None = Field(
        default=None, ge=0, le=0.01, description="Rise of the resistance at 20 °C."
    )

    @model_validator(mode="after")
    def _radii_in_order(self) -> Self:
        if self.gmr_mm is not None and self.gmr_mm > self.radius_mm:
            raise fault(
                f"gmr_mm ({self.gmr_mm:g}) is larger than radius_mm ({self.radius_mm:g})",
                "give both in millimetres; of a solid wire it is 0.7788 of the radius",
            )
        if self.inner_radius_mm >= self.radius_mm:
            raise fault(
                f"inner_radius_mm ({self.inner_radius_mm:g}) is no less than radius_mm "
                f"({self.radius_mm:g})",
                "give the inner radius of the tube, or leave it out",
            )
        if self.gmr_mm is not None and (self.inner_radius_mm or self.relative_permeability != 1.0):
            raise fault(
                "gmr_mm beside inner_radius_mm or relative_permeability",
                "leave out gmr_mm for a round conductor with its skin effect, or both others",
            )
        return self


class Conductor(Part):
    """A conductor along the line."""

    name: Name = Field(description="Name, shown in messages and tables.")
    wire: Annotated[Wire, FromLibrary(WIRES, own="wires")] = Field(
        description="Library name, name of one of `wires`, or a table of your own."
    )
    group: Group = Field(
        description="What it is connected to: conductors of a group, and of a track, have one voltage. "
        "`contact`: contact wire and messenger; `rails`: rails, and wires bonded to them; `feeder`: "
        "that of autotransformers; `positive`: a feeder at the voltage of the contact line; `earth`: "
        "a wire that lies at the voltage of the earth all along."
    )
    track: Whole = Field(
        default=1, ge=1, le=4, description="Track that it belongs to; `earth` belongs to none."
    )
    x_m: Real = Field(ge=-1_000, le=1_000, description="Place across the line.")
    height_m: Real = Field(
        gt=0, le=200, description="Height of its middle above ground, at the supports."
    )
    sag_m: Real = Field(
        default=0.0, ge=0, le=50, description="How far it hangs lower half-way between them."
    )
    wear_percent: Real = Field(
        default=0.0, ge=0, le=90, description="Share of its cross-section that is worn off."
    )
    temperature_c: Real = Field(default=REFERENCE_C, ge=-60, le=300, description="Temperature.")

    @model_validator(mode="after")
    def _resistance_at_its_temperature_is_known(self) -> Self:
        if self.temperature_c != REFERENCE_C and self.wire.temperature_coefficient_per_k is None:
            raise fault(
                f"temperature_c ({self.temperature_c:g}) of a wire without "
                "temperature_coefficient_per_k",
                "give it to the wire, such as 0.0038 of copper, or leave out temperature_c",
            )
        return self

    @property
    def mean_height_m(self) -> float:
        """Mean height of a wire that hangs in a parabola, two thirds of the sag lower. [m]"""
        return self.height_m - 2.0 / 3.0 * self.sag_m

    @property
    def r_ohm_per_km(self) -> float:
        """Resistance, of the worn wire at its temperature. [Ω/km]"""
        warmer = (self.wire.temperature_coefficient_per_k or 0.0) * (
            self.temperature_c - REFERENCE_C
        )
        return self.wire.r_ohm_per_km * (1.0 + warmer) / (1.0 - self.wear_percent / 100.0)


class Geometry(Part):
    """All conductors of a line, and the earth below them."""

    frequency_hz: Real | None = Field(
        default=None,
        ge=0,
        le=10_000,
        description="Frequency, 0 of direct current; leave it out: that of the command line.",
    )
    earth_resistivity_ohm_m: Real = Field(
        default=100.0, ge=0.001, le=1e6, description="Resistivity of the earth, at all depths."
    )
    method: Method = Field(
        default="carson",
        description="Formula of the earth return: `carson` in full, `clem` by the first terms of his "
        "series as in textbooks, `deri` by a complex depth.",
    )
    rails: Rails = Field(
        default="earthed",
        description="Which impedance stands for the line without autotransformers: that of rails at the "
        "voltage of the earth, or of `insulated` ones, which take all of the return, as they do that of "
        "direct current.",
    )
    wires: dict[Name, Wire] = Field(
        default={}, description="Wires of your own by name, for `wire` of conductors."
    )
    conductors: Annotated[tuple[Conductor, ...], Field(min_length=1), unique("name")] = Field(
        description="Conductors."
    )
    _source: Path = PrivateAttr(default=Path("geometry"))

    @property
    def source(self) -> Path:
        """The file that it was loaded from, which faults name."""
        return self._source

    @field_validator("wires")
    @classmethod
    def _own_names(cls, wires: dict[str, Wire]) -> dict[str, Wire]:
        for name in wires:
            if name in library.entries(WIRES):
                raise fault(f"{name} is an entry of the library", "give the own wire another name")
        return wires

    @field_validator("conductors", mode="before")
    @classmethod
    def _own_wires_by_name(cls, conductors: Any, info: ValidationInfo) -> Any:
        own = info.data.get(WIRES) or {}
        if not isinstance(conductors, list | tuple):
            return conductors
        return [
            {**each, "wire": own[each["wire"]]}
            if isinstance(each, dict) and isinstance(each.get("wire"), str) and each["wire"] in own
            else each
            for each in conductors
        ]

    @property
    def tracks(self) -> list[int]:
        """Numbers of the tracks that have a contact line, in order."""
        return sorted({each.track for each in self.conductors if each.group == "contact"})

    def has(self, group: Group, track: int | None = None) -> bool:
        """Whether there is a conductor of a group, of one track or of any."""
        return any(each.group == group and track in (None, each.track) for each in self.conductors)
