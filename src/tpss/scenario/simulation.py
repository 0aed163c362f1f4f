"""How the simulation runs: its step, its end, and the choices of the models."""

from collections.abc import Callable
from typing import Literal, Self

from pydantic import ConfigDict, Field, model_validator

from tpss.scenario.clock import ClockTime, seconds_of
from tpss.scenario.fields import Name, Part, Real, either_or, fault

OF_STEPPED_MOTION = (
    ("power_sampling", "start"),
    ("gradient_sampling", "start"),
    ("driver", "aggressive"),
    ("braking", "whole-steps"),
)
"""Choices of a simulation that go with stepped motion only."""


def made_of_stepped_motion(chosen: Callable[[str], object]) -> list[str]:
    """Those that were made, each as it would be written.

    Parameters
    ----------
    chosen : callable
        Gives the choice of a key.
    """
    return [f'{key} = "{value}"' for key, value in OF_STEPPED_MOTION if chosen(key) == value]


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
    starts_at: ClockTime | None = Field(
        default=None,
        description="What the clock shows at minute 0, HH:MM or HH:MM:SS; departures may then be given "
        "by the clock too, and times at stops are shown by it.",
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
        default="within-step",
        description="Braking to stops and lower limits from as late as possible, within a step, which "
        "may end in a stop, or in whole steps (the thesis).",
    )
    motion: Literal["continuous", "stepped"] | None = Field(
        default=None,
        description="Motion within a step: phase by phase, each with the forces of its mean speed, "
        "departures, limits and stops met at their instants; or one acceleration a step, from the "
        "forces at its start, with departures and dwells in whole steps (the thesis). Left out: "
        "continuous, unless another choice here is one of stepped motion.",
    )

    outage: Name | None = Field(
        default=None, description="Name of the outage that applies; leave it out: none does."
    )

    @property
    def start_s(self) -> float | None:
        """What the clock shows at minute 0, counted from midnight; None if it is not said. [s]"""
        return None if self.starts_at is None else seconds_of(self.starts_at)

    @property
    def choices_of_stepped_motion(self) -> list[str]:
        """Choices made here that belong to stepped motion, each as it would be written."""
        return made_of_stepped_motion(lambda key: getattr(self, key))

    @property
    def how_trains_move(self) -> Literal["continuous", "stepped"]:
        """The choice of motion, or what it is when it is left out."""
        return self.motion or ("stepped" if self.choices_of_stepped_motion else "continuous")

    @model_validator(mode="after")
    def _moves_as_it_chooses(self) -> Self:
        if self.motion == "continuous" and self.choices_of_stepped_motion:
            choices = " and ".join(self.choices_of_stepped_motion)
            remedy = 'write motion = "stepped", or leave them out'
            raise fault(f"continuous motion does not go with {choices}", remedy)
        return self

    @model_validator(mode="after")
    def _has_one_end(self) -> Self:
        if self.until is not None and self.duration_min is not None:
            raise either_or("until", "duration_min")
        return self
