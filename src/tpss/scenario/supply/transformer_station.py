"""Transformer stations that feed the railway from a grid of its own frequency."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from tpss.scenario.fields import (
    FromLibrary,
    Name,
    Part,
    Real,
    Whole,
    fault,
)
from tpss.scenario.rating import TransformerRating
from tpss.scenario.supply.feedback import Feedback, feedback
from tpss.scenario.supply.feeding_station import FeedingStation

Pair = Literal["RS", "ST", "TR", "SR", "TS", "RT"]
"""Two phases of the grid between which a transformer lies, from the first to the second."""

Winding = Literal[Pair, "R", "S", "T"]
"""A pair, or the phase of a teaser, which lies between that phase and the middle of the other two."""

Connection = Literal["V/V", "Scott"]
"""How two single-phase transformers of a station lie at the grid."""

UNBALANCE_LIMIT_PERCENT = 2.0
"""Negative-sequence voltage that grids usually bear, an estimate. [%]"""


class StationTransformer(Part):
    """A transformer between two phases of the grid and the contact line."""

    rated_mva: Real = Field(ge=0.1, le=1_000, description="Rated power of one transformer.")
    short_circuit_percent: Real = Field(
        ge=0, le=50, description="Short-circuit voltage; 0: no impedance."
    )
    load_loss_kw: Real = Field(
        default=0.0, ge=0, le=10_000, description="Losses at rated power, without those at no load."
    )
    no_load_loss_kw: Real = Field(
        default=0.0,
        ge=0,
        le=1_000,
        description="Losses without load, all the time; they act on what it takes from the grid only.",
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
    transformer: Annotated[StationTransformer, FromLibrary("station_transformers")] = Field(
        description="One of its transformers: library name, or a table of your own."
    )
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

    grid_kv: Real | None = Field(
        default=None,
        ge=1,
        le=1_000,
        description="Voltage of the grid between two phases; needed with `phases` or `connection`.",
    )
    phases: Pair | None = Field(
        default=None,
        description="Phases of the grid between which its transformers lie, which decide the angle of "
        "what it feeds; leave it out: not told.",
    )
    connection: Connection | None = Field(
        default=None,
        description="Two transformers at different phases, which feed either side of the neutral "
        "section at which the station stands, as two stations with a name of their own, such as "
        "`North RS`; leave it out: one.",
    )
    phases_before: Winding | None = Field(
        default=None,
        description="With `connection`: phases of what feeds the side of the lower kilometres. V/V: two "
        "phases; Scott: two phases, or the third one alone, that of the teaser.",
    )
    phases_behind: Winding | None = Field(
        default=None,
        description="With `connection`: phases of what feeds the side of the higher kilometres.",
    )
    busbar: Name | None = Field(
        default=None,
        description="Busbar of the grid at which it stands; stations at one busbar share the impedance "
        "of its grid. Leave it out: one of its own, with the station's name.",
    )
    unbalance_limit_percent: Real = Field(
        default=UNBALANCE_LIMIT_PERCENT,
        gt=0,
        le=100,
        description="Highest mean over 10 min of the negative-sequence voltage at the busbar, of the "
        "positive-sequence voltage; by default an estimate.",
    )

    @property
    def grid_busbar(self) -> str:
        """Busbar of the grid at which it stands."""
        return self.busbar or self.name

    def sides(self, ends_km: tuple[float, float]) -> tuple["TransformerStation", ...]:
        """The stations that one with a connection counts as, at either end of a neutral section. [km]"""
        sides = zip((self.phases_before, self.phases_behind), ends_km, strict=True)
        shared = {"connection": None, "phases_before": None, "phases_behind": None}
        return tuple(
            self.model_copy(
                update={
                    **shared,
                    "name": f"{self.name} {phases}",
                    "phases": phases,
                    "position_km": km,
                    "busbar": self.grid_busbar,
                }
            )
            for phases, km in sides
        )

    @model_validator(mode="after")
    def _connection_has_two_sides(self) -> Self:
        sides = self.phases_before, self.phases_behind
        if self.connection is None:
            if any(sides):
                raise fault(
                    "phases_before and phases_behind belong to a station with a connection",
                    'add connection = "V/V" or "Scott", or give phases in place of them',
                )
            return self
        if self.phases is not None:
            raise fault(
                f"phases ({self.phases}) belong to a station without a connection",
                "leave phases out, and give phases_before and phases_behind",
            )
        if self.feeds is not None:
            raise fault(
                "feeds are those of a station without a connection",
                "leave feeds out: it feeds both sides of its neutral section",
            )
        if not all(sides):
            raise fault(
                f"{self.connection} feeds two sections, of which phases_before or phases_behind is "
                "missing",
                "give both, those of the side of the lower kilometres first",
            )
        self._demand_windings(*(str(side) for side in sides))
        return self

    def _demand_windings(self, before: str, behind: str) -> None:
        """Raise a fault where two sides are no V/V, or no Scott connection."""
        if self.connection == "V/V":
            sound = len(before) == len(behind) == 2 and set(before) != set(behind)
            remedy = 'give two different pairs of phases, such as "RS" and "ST"'
        else:
            sound = len(before + behind) == 3 and len({*before, *behind}) == 3
            remedy = 'give a pair of phases and the third phase, such as "ST" and "R"'
        if not sound:
            raise fault(f"{before} and {behind} are no {self.connection} connection", remedy)

    @model_validator(mode="after")
    def _knows_its_grid(self) -> Self:
        if (self.phases or self.connection) and self.grid_kv is None:
            raise fault(
                "phases of the grid are given, and its voltage grid_kv is missing",
                "add grid_kv, by which the phase currents are told",
            )
        return self

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
        at = f" at {self.grid_kv:g} kV" if self.grid_kv is not None else ""
        phases = f", phases {self.phases}" if self.phases is not None else ""
        busbar = f", busbar {self.busbar}" if self.busbar is not None else ""
        return (
            f"{self.transformers} x {self.unit_mva:g} MVA, {percent:g} %, "
            f"{self.no_load_voltage_kv:g} kV without load, at {grid}{at}{phases}{busbar}"
        )
