"""The plan file: what may be built, what it costs, which traffic may come, and what is required."""

from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from tpss.planning.price_fields import Cost, Money, PriceOrNumber, Year, amounts
from tpss.scenario.fields import Flag, Name, Part, Real, Version, Whole, ascending, fault
from tpss.scenario.variants import Value, Values

PlainName = Annotated[Name, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$")]
"""A name without spaces, from which others are made."""

SIMULATION, BOUNDS, APPROXIMATOR = "simulation", "bounds", "approximator"
"""Ways in which a plan is proved: every case is simulated, or what the proof takes."""

PROOF_KEYS = {
    "by", "bound_margin_percent", "training_cases", "audit_cases", "audit_seed", "most_cases",
    "finer_step_min",
}  # fmt: skip
"""Keys of the evaluation that say which cases are simulated, not what comes of one."""

LEVEL = "{level}"
"""Stands for the value of a measure's level, in its changes."""


class Stages(Part):
    """The years in which decisions are taken, and until when costs count."""

    start: Annotated[tuple[Year, ...], Field(min_length=1, max_length=20), ascending("start")] = (
        Field(description="Years at whose beginning decisions are taken, ascending.")
    )
    end: Year = Field(description="Year at whose beginning the costs cease to count.")

    @model_validator(mode="after")
    def _ends_after_it_begins(self) -> Self:
        if self.end <= self.start[-1]:
            raise fault(
                f"it ends in {self.end}, and the last stage begins in {self.start[-1]}",
                "give an end after the last start",
            )
        return self

    @property
    def years(self) -> tuple[int, ...]:
        """Years of each stage."""
        return tuple(b - a for a, b in zip(self.start, (*self.start[1:], self.end), strict=True))


class Economics(Part):
    """Prices and values, all real, of one year and in one currency."""

    price_year: Year = Field(description="Year of all prices.")
    currency: Annotated[Name, Field(max_length=12)] = Field(
        description="Currency of all prices, such as MSEK."
    )
    discount_rate: Real = Field(
        ge=0, le=1, description="Real rate at which costs are discounted, a year."
    )
    running_hours_per_year: Real = Field(
        gt=0, le=8_784, description="Hours of a year in which the traffic runs."
    )
    energy_per_kwh: PriceOrNumber = Field(
        description="Price of energy that the supply takes from the grid, its losses with it."
    )
    fed_back_per_kwh: PriceOrNumber | None = Field(
        default=None, description="Payment for energy that the supply gives back to the grid."
    )
    lost_minute: dict[Name, PriceOrNumber] = Field(
        default={},
        description="Value of a minute that a train loses to the voltage, by type of train; of "
        "services without scheduled arrivals.",
    )
    late_minute: dict[Name, PriceOrNumber] = Field(
        default={},
        description="Value of a minute by which a train is late at its destination, by type of train; "
        "of services with scheduled arrivals.",
    )
    train_not_run: dict[Name, PriceOrNumber] = Field(
        description="Value of a train that the supply cannot carry, by type of train."
    )


class Requirements(Part):
    """What must hold for a supply to carry a traffic."""

    lowest_voltage_kv: Real | None = Field(
        default=None, ge=0, le=100, description="Least voltage at a pantograph."
    )
    mean_useful_voltage_kv: Real | None = Field(
        default=None, ge=0, le=100, description="Least mean useful voltage of a zone, EN 50388."
    )
    peak_loading: Real | None = Field(
        default=None, gt=0, le=10, description="Highest loading of a station's running units."
    )
    unbalance_percent: Real | None = Field(
        default=None,
        gt=0,
        le=100,
        description="Highest unbalance of a busbar of the grid, as a mean over 10 min, where stations "
        "tell their phases.",
    )
    rail_permanent_v: Real | None = Field(
        default=None,
        gt=0,
        le=10_000,
        description="Highest voltage of rails to earth, as a mean over 300 s, where they are conductors "
        "of their own.",
    )
    rail_short_v: Real | None = Field(
        default=None,
        gt=0,
        le=10_000,
        description="Highest voltage of rails to earth in a second or a step.",
    )
    stray_ma_per_m: Real | None = Field(
        default=None,
        gt=0,
        le=1_000,
        description="Highest mean of the current that strays from the rails of a line, over the length "
        "of its tracks; of direct current.",
    )
    also_with: tuple[Name, ...] = Field(
        default=(), description="Outages of the scenario with which it must hold too."
    )


class PlannedMeasure(Part):
    """What may be built: changes of the scenario, as a variant makes them, with cost and dates."""

    title: str = Field(default="", description="What it is.")
    like: Name | None = Field(
        default=None, description="Measure whose keys it has where it gives none of its own."
    )
    changes: Values = Field(
        default={}, alias="set", description="Values by key path, as in a variant."
    )
    additions: Values = Field(
        default={},
        alias="add",
        description="Items by the key path of the list behind which they come.",
    )
    removals: tuple[str, ...] = Field(
        default=(), alias="remove", description="Key paths of what is taken out."
    )
    levels: Annotated[tuple[Value, ...], Field(min_length=1, max_length=50)] | None = Field(
        default=None,
        description=f"Values of which one is built, and may be raised to a later one; in set and add "
        f'"{LEVEL}" stands for it.',
    )
    cost: Cost = Field(
        description="Cost of building; of levels one each, from nothing: a step up costs the "
        "difference."
    )
    fixed_per_year: Annotated[Real, Field(ge=0)] = Field(
        default=0.0, description="Cost of a year in service, besides that of operation."
    )
    price_year: Year | None = Field(
        default=None, description="Year of its prices; another than the plan's is a fault."
    )
    source: str = Field(default="", description="Where its prices are from.")
    lifetime_years: Real = Field(
        gt=0, le=500, description="Life in service, after which it is renewed like for like."
    )
    lead_time_years: Real = Field(
        default=0.0, ge=0, le=50, description="Time from its order until it is in service."
    )
    earliest: Year | None = Field(
        default=None, description="Year before which it cannot be in service."
    )
    latest: Year | None = Field(
        default=None, description="Year after which it is not put into service any more."
    )
    excludes: tuple[Name, ...] = Field(
        default=(), description="Measures that are not built besides it."
    )
    needs: tuple[Name, ...] = Field(
        default=(), description="Measures without which it is not built."
    )

    @model_validator(mode="after")
    def _changes_something(self) -> Self:
        if not (self.changes or self.additions or self.removals):
            raise fault("it changes nothing", "give set, add or remove")
        return self

    @model_validator(mode="after")
    def _has_a_cost_a_level(self) -> Self:
        costs, levels = len(self.costs), 1 if self.levels is None else len(self.levels)
        if costs != levels:
            raise fault(
                f"{costs} costs where {levels} may be built",
                "give one cost for each of the levels, in their order",
            )
        if any(after < before for before, after in zip(self.costs, self.costs[1:], strict=False)):
            raise fault(
                "a later level costs less than one before it",
                "put the levels in the order of their costs",
            )
        return self

    @model_validator(mode="after")
    def _uses_its_level(self) -> Self:
        uses = LEVEL in str((self.changes, self.additions))
        if self.levels is not None and not uses:
            raise fault("nothing depends on its level", f'write "{LEVEL}" where its value belongs')
        if self.levels is None and uses:
            raise fault(f"{LEVEL} stands for nothing", "add levels, or write the value")
        return self

    @property
    def costs(self) -> tuple[float, ...]:
        """Cost of building each level, or of building it, in the plan's currency."""
        return amounts(self.cost)


class PlannedRenewal(Part):
    """What it costs to renew equipment of today, if it is still there then."""

    title: str = Field(default="", description="What is renewed.")
    year: Year = Field(description="Year in which it is due.")
    cost: Cost = Field(description="Cost of the renewal.")
    lifetime_years: Real = Field(gt=0, le=500, description="Life of what takes its place.")
    unless: tuple[Name, ...] = Field(
        default=(), description="Measures of which one in service makes it unnecessary."
    )
    in_budget: Flag = Field(
        default=False, description="Whether its cost counts towards the budget of its stage."
    )
    price_year: Year | None = Field(
        default=None, description="Year of its price; another than the plan's is a fault."
    )
    source: str = Field(default="", description="Where its price is from.")

    @property
    def amount(self) -> float:
        """Its cost, in the plan's currency."""
        return sum(amounts(self.cost))


class Budget(Part):
    """What may be spent on building, over all areas."""

    per_stage: tuple[Money, ...] = Field(description="Most that is spent in each stage.")


class Future(Part):
    """A scenario of what may come: traffic and prices by stage."""

    title: str = Field(default="", description="What it is.")
    probability: Real = Field(gt=0, le=1, description="Probability; those of all add up to 1.")
    values: dict[str, Any] = Field(
        default={},
        description="Values by key path, one for each stage in a list, or one for all; of the "
        "scenario, or prices behind `economics`.",
    )


class Area(Part):
    """A line that is simulated as a whole; areas meet in money only."""

    title: str = Field(default="", description="What it is.")
    scenario: str = Field(description="Scenario file of the area as it is today.")


class Evaluation(Part):
    """How the operation of a year is found by simulation."""

    by: Literal["simulation", "bounds", "approximator"] = Field(
        default="simulation",
        description="Whether every case is simulated, or only what proves a plan to be the best if no "
        "case costs less than a bound. By bounds: what the strongest supplies use, less a margin. By an "
        "approximator: the lower end of what it predicts of the case, less a margin.",
    )
    bound_margin_percent: Real = Field(
        default=5.0,
        ge=0,
        lt=100,
        description="How much less energy a case may take than with the strongest supplies, or than the "
        "approximator's lower end.",
    )
    training_cases: Whole = Field(
        default=300,
        ge=30,
        le=1_000_000,
        description="Configurations with a traffic of each area that are drawn at random and simulated "
        "first, to train the approximator on.",
    )
    audit_cases: Whole | None = Field(
        default=None,
        ge=0,
        le=10_000_000,
        description="Configurations with a traffic that are drawn at random and simulated to test the "
        "bounds; left out: none by bounds, 60 by an approximator.",
    )
    audit_seed: Whole = Field(default=0, ge=0, description="Seed of these draws.")
    time_step_min: Real | None = Field(
        default=None,
        ge=0.001,
        le=10,
        description="Time step of all cases; left out: that of the scenario.",
    )
    finer_step_min: Real | None = Field(
        default=None,
        ge=0.001,
        le=10,
        description="Time step at which what the best first decisions use is simulated once more, to "
        "see whether the step decides between them; left out: it is not.",
    )
    measured_min: Real = Field(
        default=60.0,
        gt=0,
        le=10_000,
        description="Least time over which means are taken, once the first trains have arrived; it "
        "is extended to whole periods of the timetable.",
    )
    period_min: Real | None = Field(
        default=None,
        gt=0,
        le=100_000,
        description="Period after which the timetable repeats; needed where departures are listed.",
    )
    most_cases: Whole = Field(
        default=200_000, ge=1, le=10_000_000, description="Most cases that are simulated."
    )


class PlanFile(Part):
    """A plan file of format 1."""

    format: Version = Field(description="Version of the file format.")
    name: PlainName = Field(description="Short name.")
    description: str = Field(default="", description="What the plan is about.")
    scenario: str | None = Field(
        default=None, description="Scenario file of the line as it is today, next to the plan."
    )
    areas: dict[PlainName, Area] = Field(
        default={}, description="Several lines by name, in place of one scenario."
    )
    stages: Stages = Field(description="When decisions are taken.")
    economics: Economics = Field(description="Prices and values.")
    require: Requirements = Field(
        default={}, validate_default=True, description="What a supply must keep to carry a traffic."
    )
    measures: Annotated[dict[PlainName, PlannedMeasure], Field(min_length=1)] = Field(
        description="What may be built, by name."
    )
    renewals: dict[PlainName, PlannedRenewal] = Field(
        default={}, description="Renewals of today's equipment that are due, by name."
    )
    budget: Budget | None = Field(
        default=None, description="What may be spent; left out: no limit."
    )
    scenarios: dict[PlainName, Future] = Field(
        default={}, description="What may come, by name; left out: today's traffic and prices stay."
    )
    evaluate: Evaluation = Field(
        default={}, validate_default=True, description="How operation is found."
    )

    @model_validator(mode="after")
    def _has_a_line(self) -> Self:
        if (self.scenario is None) == (not self.areas):
            raise fault(
                "give either scenario or areas", "name one scenario, or areas with one each"
            )
        return self
