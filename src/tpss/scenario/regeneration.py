"""Regenerative braking of a train: its limits, and the voltages at which the line stops taking it."""

from typing import Literal, Self

from pydantic import Field, model_validator

from tpss.scenario.fields import Part, Real, fault
from tpss.scenario.machine import Ratio, RatioOverSpeed
from tpss.scenario.over_load import EfficiencyOverLoad


class Regeneration(Part):
    """Electric brakes that feed back what the motors brake; other brakes give the rest."""

    max_force_kn: Real = Field(
        gt=0, le=5_000, description="Highest braking force of all motors at the wheel rim."
    )
    max_power_kw: Real = Field(
        gt=0, le=100_000, description="Highest mechanical power at the wheel rim."
    )
    fade_from_kmh: Real = Field(
        default=10.0,
        gt=0,
        le=500,
        description="Speed down to which they brake with all their force.",
    )
    fade_to_kmh: Real = Field(
        default=5.0, ge=0, le=500, description="Speed below which they do not brake."
    )
    efficiency: RatioOverSpeed | None = Field(
        default=None,
        description="From motor shaft to pantograph: a number, or a curve over speed; leave it out: "
        "that of traction.",
    )
    efficiency_over_load: EfficiencyOverLoad | None = Field(
        default=None,
        description="Factor of it over the load; leave it out: that of traction, if it has one.",
    )
    power_factor: Ratio = Field(
        default=1.0,
        description="Power factor of what is fed back; the reactive power is inductive.",
    )
    full_until_kv: Real | None = Field(
        default=None,
        gt=0,
        le=100,
        description="Voltage up to which the line takes all of it; leave it out: the highest permanent "
        "voltage of the system, Umax1.",
    )
    zero_from_kv: Real | None = Field(
        default=None,
        gt=0,
        le=100,
        description="Voltage from which it takes none; leave it out: the highest voltage of the system, "
        "Umax2.",
    )
    rest: Literal["friction", "rheostat"] = Field(
        default="friction",
        description="What takes the part that the line does not take: friction brakes, or a rheostat on "
        "the train, which burns it. The motion is the same.",
    )

    @model_validator(mode="after")
    def _fades_downwards(self) -> Self:
        if self.fade_to_kmh >= self.fade_from_kmh:
            raise fault(
                f"fade_to_kmh ({self.fade_to_kmh:g} km/h) is not below fade_from_kmh "
                f"({self.fade_from_kmh:g} km/h)",
                "electric brakes fade as the train slows down: give the lower speed as fade_to_kmh",
            )
        return self

    @model_validator(mode="after")
    def _voltages_in_order(self) -> Self:
        full, zero = self.full_until_kv, self.zero_from_kv
        if full is not None and zero is not None and zero <= full:
            raise fault(
                f"zero_from_kv ({zero:g} kV) is not above full_until_kv ({full:g} kV)",
                "what is fed back falls as the voltage rises: give the higher one as zero_from_kv",
            )
        return self
