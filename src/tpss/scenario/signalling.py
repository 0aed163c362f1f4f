"""What keeps trains apart that follow each other on a track, meet on a single one, or come together."""

from typing import Literal, Self

from pydantic import Field, model_validator

from tpss.scenario.fields import Part, Real, fault


class Signalling(Part):
    """What keeps trains apart."""

    separation: Literal["none", "moving-block", "fixed-block"] = Field(
        default="none",
        description="Whether a train may go as far as the rear of the train ahead, or as the block in "
        "which it is; or nothing keeps them apart.",
    )
    single_track: Literal["free", "timetable-order", "first-come"] = Field(
        default="free",
        description="Who goes first where trains meet on a single track, or on one of several that "
        "services give to both directions, between stations of several tracks, and where routes come "
        "together: those that are due first, or those that come first; or trains that meet do not see "
        "each other.",
    )
    reaction_s: Real = Field(
        default=5.0,
        ge=0,
        le=120,
        description="Time that a train goes on before it brakes for another; a time step at least.",
    )
    margin_m: Real = Field(
        default=50.0,
        ge=0,
        le=10_000,
        description="Distance that is kept from the train or block ahead.",
    )
    starts_apart_s: Real = Field(
        default=0.0,
        ge=0,
        le=3_600,
        description="Least time between two trains that begin at the same station: those that would "
        "begin sooner wait, so that their starts do not add up in the supply.",
    )
    block_m: Real | None = Field(
        default=None,
        ge=50,
        le=100_000,
        description="Length of fixed blocks, counted from kilometre 0 of each line.",
    )

    @property
    def has_gates(self) -> bool:
        """Whether trains wait where they meet on a single track, or come together."""
        return self.single_track != "free"

    @model_validator(mode="after")
    def _sees_trains_ahead_too(self) -> Self:
        if self.has_gates and self.separation == "none":
            raise fault(
                f'single_track = "{self.single_track}" goes with trains that see those ahead of them',
                'add separation = "moving-block" or "fixed-block"',
            )
        return self

    @model_validator(mode="after")
    def _fixed_blocks_have_a_length(self) -> Self:
        if (self.separation == "fixed-block") != (self.block_m is not None):
            raise fault(
                'block_m belongs to separation = "fixed-block"',
                "give both, or leave block_m out",
            )
        return self
