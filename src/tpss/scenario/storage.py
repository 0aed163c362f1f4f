"""What every store of energy says of itself, at the line or on board."""

from typing import Literal, Self

from pydantic import Field, model_validator

from tpss.scenario.fields import Part, Real, either_or, fault
from tpss.scenario.machine import Ratio
from tpss.units import si

CAPACITOR = ("capacitance_f", "max_voltage_v", "min_voltage_v", "max_current_a")
"""Keys of a supercapacitor, all of which it needs; others have `capacity_kwh` in their place."""


class EnergyStore(Part):
    """A supercapacitor, a battery or a flywheel."""

    kind: Literal["supercapacitor", "battery", "flywheel"] = Field(description="What it is.")
    capacitance_f: Real | None = Field(
        default=None, gt=0, le=1_000_000, description="Capacitance of a supercapacitor."
    )
    max_voltage_v: Real | None = Field(
        default=None, gt=0, le=100_000, description="Voltage of a supercapacitor that is full."
    )
    min_voltage_v: Real | None = Field(
        default=None, gt=0, le=100_000, description="Voltage of a supercapacitor that is empty."
    )
    max_current_a: Real | None = Field(
        default=None, gt=0, le=1_000_000, description="Highest current of a supercapacitor."
    )
    capacity_kwh: Real | None = Field(
        default=None,
        gt=0,
        le=1_000_000,
        description="Usable energy of a battery or a flywheel, from empty to full.",
    )
    power_kw: Real = Field(
        gt=0, le=1_000_000, description="Highest power at its terminals, either way."
    )
    efficiency: Ratio | None = Field(
        default=None, description="Efficiency each way; or the two that follow."
    )
    charge_efficiency: Ratio | None = Field(
        default=None, description="What is kept of the power that it takes."
    )
    discharge_efficiency: Ratio | None = Field(
        default=None, description="What it gives of the power that its energy loses."
    )
    standby_kw: Real = Field(
        default=0.0,
        ge=0,
        le=10_000,
        description="What it loses all the time, unless it is empty, as a flywheel by friction.",
    )
    soc_start: Real = Field(
        default=0.5,
        ge=0,
        le=1,
        description="State of charge at the beginning: energy over the usable energy.",
    )

    @model_validator(mode="after")
    def _described_by_its_kind(self) -> Self:
        own = CAPACITOR if self.kind == "supercapacitor" else ("capacity_kwh",)
        missing = [key for key in own if getattr(self, key) is None]
        others = [*CAPACITOR, "capacity_kwh"]
        foreign = [key for key in others if key not in own and getattr(self, key) is not None]
        if missing:
            raise fault(f"a {self.kind} without {', '.join(missing)}", "add it")
        if foreign:
            raise fault(f"{', '.join(foreign)} of a {self.kind}, which has none", "leave it out")
        return self

    @model_validator(mode="after")
    def _voltages_in_order(self) -> Self:
        low_v, high_v = self.min_voltage_v, self.max_voltage_v
        if low_v is not None and high_v is not None and low_v >= high_v:
            raise fault(
                f"min_voltage_v ({low_v:g} V) is not below max_voltage_v ({high_v:g} V)",
                "give the voltage of the empty supercapacitor as min_voltage_v",
            )
        return self

    @model_validator(mode="after")
    def _efficient_each_way(self) -> Self:
        both = self.charge_efficiency is not None, self.discharge_efficiency is not None
        if (self.efficiency is not None) == any(both):
            raise either_or("efficiency", "charge_efficiency and discharge_efficiency")
        if any(both) and not all(both):
            raise fault(
                "charge_efficiency and discharge_efficiency belong together",
                "add the one that is missing, or give efficiency for both",
            )
        return self

    @property
    def efficiencies(self) -> tuple[float, float]:
        """Efficiency of charging and of discharging. [1]"""
        one = self.efficiency or 1.0
        return self.charge_efficiency or one, self.discharge_efficiency or one

    @property
    def capacity_j(self) -> float:
        """Usable energy, from empty to full. [J]"""
        if self.capacity_kwh is not None:
            return si(self, "capacity_kwh")
        full_v, empty_v = float(self.max_voltage_v or 0.0), float(self.min_voltage_v or 0.0)
        return float(self.capacitance_f or 0.0) / 2.0 * (full_v**2 - empty_v**2)

    @property
    def in_words(self) -> str:
        """What it is, how much it holds, and its power."""
        return f"{self.kind}, {self.capacity_j / 3.6e6:.3g} kWh, {self.power_kw:g} kW"
