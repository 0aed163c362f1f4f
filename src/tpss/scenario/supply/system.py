"""Electrification systems, which the library describes."""

from functools import cache
from typing import Annotated

from pydantic import Field

from tpss import library
from tpss.scenario.fields import Part, Real, entry_of

SYSTEMS = "systems"
DEFAULT_SYSTEM = "15kV-16.7Hz"


class System(Part):
    """An electrification system; results depend on its bases only through the load flow's tolerance."""

    nominal_kv: Real = Field(gt=0, description="Nominal voltage of the contact line.")
    base_kv: Real = Field(gt=0, description="Base of voltages in per unit.")
    base_mva: Real = Field(gt=0, description="Base of powers in per unit.")
    frequency_hz: Real = Field(ge=0, description="Frequency of the contact line.")
    lowest_pu: Real = Field(gt=0, description="Voltages of a healthy line are above this.")
    highest_pu: Real = Field(gt=0, description="And below this.")
    knee_factor: Real = Field(
        gt=0,
        le=1,
        description="Share of the nominal voltage from which trains may draw their whole current.",
    )

    @property
    def is_direct(self) -> bool:
        """Whether its current is direct."""
        return self.frequency_hz == 0.0


SystemName = Annotated[str, entry_of(SYSTEMS)]
"""Name of a system of the library."""


@cache
def system_named(name: str) -> System:
    """Values of a system of the library."""
    return System.model_validate(library.values(SYSTEMS, name))
