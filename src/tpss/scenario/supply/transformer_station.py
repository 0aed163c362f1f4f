"""Transformer stations that feed the railway from a grid of its own frequency."""

from typing import Literal, Self

from pydantic import Field, model_validator

from tpss.scenario.fields import (
    Part,
    Real,
    Whole,
    fault,
)
from tpss.scenario.rating import TransformerRating
from tpss.scenario.supply.feedback import Feedback, feedback
from tpss.scenario.supply.feeding_station import FeedingStation


class StationTransformer(Part):
    """A transformer between two phases of the grid and the contact line."""

    rated_mva: Real = Field(ge=0.1, le=1_000, description="Rated power of one transformer.")
    short_circuit_percent: Real = Field(
        ge=0, le=50, description="Short-circuit voltage; 0: no impedance."
    )
    load_loss_kw: Real = Field(
        default=0.0, ge=0, le=10_000, description="Losses at rated power, without those at no load."
    )
    rating: TransformerRating | None = Field(
        default=None,
        description="What it bears without getting too hot, of `rated_mva`; leave it out: it is not "
        "judged.",
    )

    @property
    def r_pu(self) -> float:
        """Resistance in per unit of the rating. [1]"""
        return self.load_loss_kw / 1e3 / self.rated_mva

    @property
    def z_pu(self) -> float:
        """Impedance in per unit of the rating. [1]"""
        return self.short_circuit_percent / 100.0

    @model_validator(mode="after")
    def _losses_fit_the_impedance(self) -> Self:
        if self.r_pu > self.z_pu:
            raise fault(
                f"load_loss_kw ({self.load_loss_kw:g} kW) needs more than the whole impedance of "
                f"short_circuit_percent ({self.short_circuit_percent:g} %)",
                "lower load_loss_kw, or raise short_circuit_percent",
            )
        return self


class TransformerStation(FeedingStation):
    """A transformer station that feeds the contact line."""

    feedback: Feedback = feedback()
    no_load_voltage_kv: Real = Field(
        ge=0.1, le=100, description="Voltage without load, on the railway's side."
    )
    transformer: StationTransformer = Field(description="One of its transformers.")
    transformers: Whole = Field(
        default=1, ge=1, le=100, description="Number of equal transformers in parallel."
    )
    secondary: Literal["1x", "2x"] = Field(
        default="1x",
        description="`2x`: two windings in series, between contact line, rails and feeder, each of "
        "`no_load_voltage_kv`; with `supply.conductors`.",
    )
    share_in_halves: Real = Field(
        default=0.3,
        ge=0.001,
        le=1,
        description="Share of a transformer's impedance that lies in the halves of such a secondary; "
        "rarely published, an estimate.",
    )
    grid_short_circuit_mva: Real | None = Field(
        default=None,
        gt=0,
        le=1_000_000,
        description="Three-phase short-circuit power of the grid; leave it out: infinite.",
    )
    grid_r_over_x: Real = Field(
        default=0.0, ge=0, le=10, description="Resistance over reactance of the grid."
    )

    @property
    def installed(self) -> int:
        """Number of transformers installed."""
        return self.transformers

    @property
    def unit_mva(self) -> float:
        """Rated power of one unit. [MVA]"""
        return self.transformer.rated_mva

    @property
    def in_words(self) -> str:
        """What stands there."""
        power, percent = self.grid_short_circuit_mva, self.transformer.short_circuit_percent
        grid = "an infinite grid" if power is None else f"a grid of {power:g} MVA"
        return (
            f"{self.transformers} x {self.unit_mva:g} MVA, {percent:g} %, "
            f"{self.no_load_voltage_kv:g} kV without load, at {grid}"
        )
