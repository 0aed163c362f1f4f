"""Electrification systems, which the library describes."""

from typing import Annotated

from pydantic import AfterValidator, Field
from pydantic_core import PydanticCustomError

from tpss import library
from tpss.scenario.fields import Part, Real

SYSTEMS = "systems"
DEFAULT_SYSTEM = "15kV-16.7Hz"


class System(Part):
    """An electrification system; no result depends on its bases but for the load flow's tolerance."""

    nominal_kv: Real = Field(gt=0, description="Nominal voltage of the contact line.")
    base_kv: Real = Field(gt=0, description="Base of voltages in per unit.")
    base_mva: Real = Field(gt=0, description="Base of powers in per unit.")
    frequency_hz: Real = Field(ge=0, description="Frequency of the contact line.")
    lowest_pu: Real = Field(gt=0, description="Voltages of a sound line are above this.")
    highest_pu: Real = Field(gt=0, description="And below this.")


def _is_a_system(name: str) -> str:
    known = library.entries(SYSTEMS)
    if name not in known:
        raise PydanticCustomError(
            "unknown_name",
            "the library has no such entry in {kind}",
            {"kind": SYSTEMS, "known": sorted(known)},
        )
    return name


SystemName = Annotated[str, AfterValidator(_is_a_system)]
"""Name of a system of the library."""


def system_named(name: str) -> System:
    """Values of a system of the library."""
    return System.model_validate(library.values(SYSTEMS, name))
