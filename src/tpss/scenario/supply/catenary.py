"""The contact line."""

from typing import Any, Self

from pydantic import Field, model_validator

from tpss.scenario.fields import Part, Real, fault
from tpss.scenario.rating import CatenaryRating

SMALLEST_OHM = 0.0001
"""Lumped impedances smaller than this are lost in the rounding of voltages. [Ω]"""


def without_reactance(given: Any) -> Any:
    """A table of a contact line for direct current, of which a reactance need not be given."""
    return {"x_ohm_per_km": 0.0, **given} if isinstance(given, dict) else given


class Catenary(Part):
    """A contact-line system, per kilometre; a connection impedance makes it an AT system."""

    r_ohm_per_km: Real = Field(ge=0.001, le=10, description="Resistance.")
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
