"""The contact line."""

import math
from typing import Annotated, Any, Self

from pydantic import Field, ValidationInfo, field_validator, model_validator
from pydantic_core import PydanticKnownError

from tpss.scenario.fields import FromLibrary, Part, Real, fault
from tpss.scenario.rating import CatenaryRating
from tpss.scenario.supply.conductors import LineMatrices
from tpss.scenario.supply.direct_conductors import (
    REFERENCE_C,
    DirectContactLine,
    RunningRails,
)

SMALLEST_OHM = 0.0001
"""Lumped impedances smaller than this are lost in the rounding of voltages. [Ω]"""


def without_reactance(given: Any) -> Any:
    """A table of a contact line for direct current, of which a reactance need not be given."""
    return {"x_ohm_per_km": 0.0, **given} if isinstance(given, dict) else given


OF_PARTS = ("contact_line", "rails")
"""Keys of the conductors of a direct current, from which the resistance follows."""

STATES = {
    "wear_percent": 0.0,
    "conductor_temperature_c": REFERENCE_C,
    "rails_temperature_c": REFERENCE_C,
}
"""Keys of the state of these conductors, and what it is unless they say otherwise."""


def _resistances(
    own: DirectContactLine, rails: RunningRails, states: dict[str, Any]
) -> tuple[float, float]:
    """Resistance of a contact line, and of rails, in their state. [Ω/km]"""
    wear_percent, conductor_c, rails_c = (
        usual if states[key] is None else float(states[key]) for key, usual in STATES.items()
    )
    return own.worn_ohm_per_km(wear_percent, conductor_c), rails.warm_ohm_per_km(rails_c)


class Catenary(Part):
    """A contact-line system, per kilometre; a connection impedance makes it an AT system."""

    contact_line: Annotated[DirectContactLine, FromLibrary("contact_lines")] | None = Field(
        default=None,
        description="Contact line or third rail of a direct current, with `rails` in place of "
        "`r_ohm_per_km`: a library name, or a table of your own.",
    )
    rails: Annotated[RunningRails, FromLibrary("rails")] | None = Field(
        default=None,
        description="The running rails of a track: a library name, or a table of your own.",
    )
    wear_percent: Real | None = Field(
        default=None,
        ge=0,
        le=60,
        description="Share of the contact wires' cross-section that is worn off, with `contact_line`; "
        "leave it out: 0.",
    )
    conductor_temperature_c: Real | None = Field(
        default=None,
        ge=-60,
        le=200,
        description="Temperature of the contact line, with `contact_line`; leave it out: 20 °C.",
    )
    rails_temperature_c: Real | None = Field(
        default=None,
        ge=-60,
        le=100,
        description="Temperature of the rails, with `rails`; leave it out: 20 °C.",
    )
    r_ohm_per_km: Real = Field(
        default=None,
        validate_default=True,
        ge=0.001,
        le=10,
        description="Resistance, there and back, of one track.",
    )
    x_ohm_per_km: Real = Field(ge=0, le=10, description="Reactance at the supply's frequency.")
    capacitance_nf_per_km: Real = Field(
        default=0.0, ge=0, le=1_000, description="Capacitance to earth."
    )
    mutual_r_ohm_per_km: Real = Field(
        default=0.0,
        ge=0,
        le=10,
        description="Resistance that the contact lines of two tracks have in common, tied or not.",
    )
    mutual_x_ohm_per_km: Real = Field(
        default=0.0,
        ge=0,
        le=10,
        description="Reactance that they have in common, by their mutual inductance.",
    )
    connection_r_ohm: Real = Field(
        default=0.0, ge=0, le=100, description="Resistance between a feeding point and the line."
    )
    connection_x_ohm: Real = Field(
        default=0.0, ge=0, le=100, description="Reactance between a feeding point and the line."
    )
    rating: CatenaryRating | None = Field(
        default=None,
        description="What it bears without getting too hot; leave it out: it is not judged.",
    )
    conductors: LineMatrices | None = Field(
        default=None,
        description="Its conductors, for `supply.conductors`; without that the impedance above counts.",
    )

    @field_validator("conductors", mode="before")
    @classmethod
    def _not_those_of_a_geometry(cls, given: Any) -> Any:
        if isinstance(given, list):
            raise fault(
                "conductors as a geometry lists them",
                "make a catenary of them: tpss line-constants FILE --out catenary.toml, then "
                'supply.catenary = "catenary.toml"',
            )
        return given

    @field_validator("r_ohm_per_km", mode="before")
    @classmethod
    def _resistance_of_the_conductors(cls, given: Any, info: ValidationInfo) -> Any:
        known = info.data
        if not {*OF_PARTS, *STATES} <= set(known):
            # One of them has a fault of its own, and any value allows the others to be checked.
            return 1.0 if given is None else given
        parts = [key for key in OF_PARTS if known[key] is not None]
        if len(parts) == len(OF_PARTS):
            found = sum(_resistances(known["contact_line"], known["rails"], known))
            if isinstance(given, int | float) and not math.isclose(given, found, rel_tol=1e-9):
                raise fault(
                    f"beside contact_line and rails, which have {found:.4g} ohm/km",
                    "leave out r_ohm_per_km, or the others",
                )
            return found
        if parts:
            raise fault(
                f"{parts[0]} alone, and the current flows there and back",
                "give contact_line and rails",
            )
        changed = [key for key in STATES if known[key] is not None]
        if changed:
            raise fault(
                f"{' and '.join(changed)} without contact_line and rails",
                "give these, or a resistance that is worn and warm already",
            )
        if given is None:
            raise PydanticKnownError("missing")
        return given

    @property
    def direct_conductors_ohm_per_km(self) -> tuple[float, float] | None:
        """Resistance of the contact line and of the rails, in their state; None: not given apart."""
        if self.contact_line is None or self.rails is None:
            return None
        states = {key: getattr(self, key) for key in STATES}
        return _resistances(self.contact_line, self.rails, states)

    @property
    def has_reactance(self) -> bool:
        """Whether anything of it is there for an alternating current only."""
        keys = ("x_ohm_per_km", "mutual_x_ohm_per_km", "connection_x_ohm", "capacitance_nf_per_km")
        return any(getattr(self, key) > 0.0 for key in keys)

    @model_validator(mode="after")
    def _tracks_have_impedances_of_their_own(self) -> Self:
        for axis in ("r", "x"):
            own, common = (getattr(self, f"{which}{axis}_ohm_per_km") for which in ("", "mutual_"))
            if common > 0.0 and common >= own:
                raise fault(
                    f"mutual_{axis}_ohm_per_km ({common:g}) is no less than {axis}_ohm_per_km ({own:g})",
                    "give what the contact lines of two tracks have in common",
                )
        return self

    @model_validator(mode="after")
    def _connection_impedance_is_resolved(self) -> Self:
        impedance_ohm = abs(complex(self.connection_r_ohm, self.connection_x_ohm))
        if 0.0 < impedance_ohm < SMALLEST_OHM:
            raise fault(
                f"the connection impedance ({impedance_ohm} ohm) is too small to be resolved",
                f"give at least {SMALLEST_OHM:g} ohm, or 0: no connection impedance",
            )
        return self
