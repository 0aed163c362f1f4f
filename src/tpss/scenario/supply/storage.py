"""Stores of energy at the line."""

from typing import Self

from pydantic import Field, model_validator

from tpss.scenario.fields import Real, fault
from tpss.scenario.storage import EnergyStore
from tpss.scenario.supply.placed import Placed


class Storage(EnergyStore, Placed):
    """A store of energy at the contact line, which follows the voltage there."""

    charges_above_kv: Real = Field(
        gt=0,
        le=100,
        description="Voltage above which it charges: above that of all stations without load, and "
        "below that from which the line takes less of what trains feed back.",
    )
    discharges_below_kv: Real = Field(
        gt=0,
        le=100,
        description="Voltage below which it discharges: below that of all stations without load.",
    )
    charge_kw_per_v: Real = Field(
        ge=0, le=100_000, description="Power over the voltage above the one, up to the highest."
    )
    discharge_kw_per_v: Real = Field(
        ge=0, le=100_000, description="Power over the voltage below the other, up to the highest."
    )

    @model_validator(mode="after")
    def _charges_above_what_it_discharges_below(self) -> Self:
        if self.charges_above_kv <= self.discharges_below_kv:
            raise fault(
                f"charges_above_kv ({self.charges_above_kv:g} kV) is not above discharges_below_kv "
                f"({self.discharges_below_kv:g} kV)",
                "give the higher voltage as charges_above_kv",
            )
        return self
