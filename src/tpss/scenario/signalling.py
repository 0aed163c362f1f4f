"""What keeps trains apart that follow each other on a track."""

from typing import Literal, Self

from pydantic import Field, model_validator

from tpss.scenario.fields import Part, Real, fault


class Signalling(Part):
    """What keeps trains apart that follow each other; those that meet do not see each other."""

    separation: Literal["none", "moving-block", "fixed-block"] = Field(
        default="none",
        description="Whether a train may go as far as the rear of the train ahead, or as the block in "
        "which it is; or nothing keeps them apart.",
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
    block_m: Real | None = Field(
        default=None,
        ge=50,
        le=100_000,
        description="Length of fixed blocks, counted from kilometre 0 of each line.",
    )

    @model_validator(mode="after")
    def _fixed_blocks_have_a_length(self) -> Self:
        if (self.separation == "fixed-block") != (self.block_m is not None):
            raise fault(
                'block_m belongs to separation = "fixed-block"',
                "give both, or leave block_m out",
            )
        return self
