"""How the simulation runs: its step, its end, and the choices of the models."""

from typing import Literal, Self

from pydantic import ConfigDict, Field, model_validator

from tpss.scenario.fields import Part, Real, either_or


class Simulation(Part):
    """Time step, end of the run, and choices between our models and those of the thesis."""

    model_config = ConfigDict(json_schema_extra={"not": {"required": ["until", "duration_min"]}})

    time_step_min: Real | None = Field(
        default=None,
        ge=0.001,
        le=10,
        description="Length of a time step; by default the longest of 1, 0.5, 0.2, 0.1, 0.05, 0.02 and "
        "0.01 min that keeps within 0.3 % of a run at half of it.",
    )
    until: Literal["first-departure-arrives"] | None = Field(
        default=None, description="End with the arrival of the studied train (the default)."
    )
    duration_min: Real | None = Field(
        default=None, ge=0.001, le=100_000, description="End after this time."
    )
    power_sampling: Literal["mean", "start"] = Field(
        default="mean",
        description="Speed from which motor power is computed: mean of the step, or at its start "
        "(the thesis).",
    )
    gradient_sampling: Literal["mean", "start"] = Field(
        default="mean",
        description="Gradient of a step: mean over its distance, or at its start (the thesis).",
    )
    adhesion_speed_unit: Literal["m/s", "km/h"] = Field(
        default="m/s",
        description="Unit of the speed in the adhesion law: m/s (physically right), or km/h as "
        "the thesis prints it.",
    )
    rail: Literal["dry", "wet"] = Field(default="dry", description="State of the rails.")
    load_flow: Literal["equations", "least-squares"] = Field(
        default="equations",
        description="Solve the load flow as a system of equations, or by least squares of the power "
        "mismatches, as the original program did; that takes a few hundred times as long.",
    )
    driver: Literal["regulated", "aggressive"] = Field(
        default="regulated",
        description="Driver who holds the speed limit, or that of the original program: full "
        "effort below the limit, coasting up to 5 km/h above it, braking beyond.",
    )

    braking: Literal["whole-steps", "within-step"] = Field(
        default="whole-steps",
        description="Braking to stops and lower limits in whole steps (the thesis), or from as late as "
        "possible, within a step, which may end in a stop: that makes long steps accurate.",
    )

    @model_validator(mode="after")
    def _has_one_end(self) -> Self:
        if self.until is not None and self.duration_min is not None:
            raise either_or("until", "duration_min")
        return self
