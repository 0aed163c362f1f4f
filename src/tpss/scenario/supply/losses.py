"""Losses of a frequency converter, which act on what its station takes from the 50 Hz grid only."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from tpss.scenario.fields import Part, Real, ascending, fault

COEFFICIENTS = ("idle_kw", "linear_percent", "quadratic_percent", "feedback_quadratic_percent")
"""Keys of which the others are given by a curve."""

Percent = Annotated[Real, Field(ge=0, le=100)]


class LossPoint(Part):
    """A point of a measured curve of losses, of one converter."""

    load_percent: Real = Field(
        ge=0, le=1_000, description="Apparent power on the railway's side, of the rated power."
    )
    loss_kw: Real = Field(ge=0, le=100_000, description="What the converter loses then.")


class ConverterLosses(Part):
    """What a converter loses: a + b S + c S² of its apparent power, or a measured curve.

    Losses do not act on the railway: they are found from what was recorded.
    """

    idle_kw: Real | None = Field(
        default=None, ge=0, le=100_000, description="Losses of a converter that runs without load."
    )
    linear_percent: Percent | None = Field(
        default=None,
        description="Losses in proportion to the apparent power, of that power; leave it out: 0.",
    )
    quadratic_percent: Percent | None = Field(
        default=None,
        description="Losses in proportion to its square, at rated power; leave it out: 0.",
    )
    feedback_quadratic_percent: Percent | None = Field(
        default=None,
        description="The same while the railway feeds back; leave it out: `quadratic_percent`.",
    )
    curve: Annotated[
        tuple[LossPoint, ...] | None, Field(min_length=2), ascending("load_percent")
    ] = Field(
        default=None,
        description="Measured losses in place of these, from 0 % on; straight lines between the "
        "points, the last one goes on.",
    )
    curve_file: str | None = Field(
        default=None,
        description="CSV file or workbook with the curve, of the columns load_percent and loss_kw.",
    )
    origin: Literal["estimate", "measurement"] | None = Field(
        default=None, description="Where the figures come from, told wherever results show losses."
    )

    @model_validator(mode="after")
    def _one_description(self) -> Self:
        given = [key for key in COEFFICIENTS if getattr(self, key) is not None]
        if self.curve is not None and given:
            raise fault(
                f"losses are given twice, by a curve and by {', '.join(given)}",
                "leave out the curve, or the others",
            )
        if self.curve is None and "idle_kw" not in given:
            raise fault(
                "the losses of a converter without load are missing",
                "add idle_kw, or give a curve or curve_file in place of all",
            )
        return self

    @model_validator(mode="after")
    def _rises_from_no_load(self) -> Self:
        points = self.curve or ()
        if points and points[0].load_percent != 0.0:
            raise fault(
                f"the curve begins at a load of {points[0].load_percent:g} %",
                "begin it at 0 %, with the losses without load",
            )
        for before, after in zip(points, points[1:], strict=False):
            if after.loss_kw < before.loss_kw:
                raise fault(
                    f"loss_kw falls from {before.loss_kw:g} to {after.loss_kw:g} kW between "
                    f"{before.load_percent:g} and {after.load_percent:g} % of load",
                    "give losses in kW, not an efficiency, which do not fall with the load",
                )
        return self
