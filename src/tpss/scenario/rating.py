"""What equipment bears without getting too hot: a run is judged by it, and drivers may act on it."""

from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import AfterValidator, Field, model_validator

from tpss.scenario.fields import Part, Real, fault

AIR_C, HOT_SPOT_C = 20.0, 120.0
"""Temperature of the air, and highest one of a transformer's hot spot, if they are not given. [°C]"""

LONGEST_MIN = 10_000.0
"""Longest time constant, and longest time of an overload. [min]"""


class Overload(Part):
    """A load above the rated one that equipment bears for a while."""

    percent: Real = Field(gt=100, le=1_000, description="Highest r.m.s. load, of the rated one.")
    minutes: Real = Field(
        gt=0, le=LONGEST_MIN, description="Length of the time over which that is the mean. In min."
    )


def _shorter_as_they_grow(overloads: tuple[Overload, ...]) -> tuple[Overload, ...]:
    for one, other in pairwise(overloads):
        if other.percent <= one.percent or other.minutes >= one.minutes:
            raise fault(
                f"{other.percent:g} % for {other.minutes:g} min follows {one.percent:g} % for "
                f"{one.minutes:g} min",
                "give the lowest overload first: each one that follows is higher, and shorter",
            )
    return overloads


Overloads = Annotated[tuple[Overload, ...], AfterValidator(_shorter_as_they_grow)]


class Initial(Part):
    """How warm equipment is when the run begins."""

    preload_percent: Real | None = Field(
        default=None,
        ge=0,
        le=200,
        description="Load before the run, held for ever; leave it out: the r.m.s. load of the run.",
    )


class Rating(Initial):
    """What equipment of one time constant bears."""

    time_constant_min: Real = Field(
        gt=0, le=LONGEST_MIN, description="Time constant of its temperature."
    )
    overloads: Overloads = Field(
        default=(), description="Overloads that are allowed, the lowest and longest first."
    )


class CatenaryRating(Rating):
    """What the contact line of a track bears; with two temperatures, how warm it gets is told too."""

    continuous_a: Real = Field(
        gt=0, le=100_000, description="Current of one track that it bears for ever."
    )
    reference_c: Real | None = Field(
        default=None, ge=-50, le=300, description="Its temperature at that current, at `ambient_c`."
    )
    ambient_c: Real | None = Field(
        default=None, ge=-60, le=80, description="Temperature of the air."
    )

    @model_validator(mode="after")
    def _both_temperatures_in_order(self) -> Self:
        if (self.reference_c is None) != (self.ambient_c is None):
            raise fault("reference_c and ambient_c belong together", "give both, or leave both out")
        reference_c, ambient_c = self.reference_c, self.ambient_c
        if reference_c is not None and ambient_c is not None and ambient_c >= reference_c:
            raise fault(
                f"ambient_c ({ambient_c:g} °C) is not below reference_c ({reference_c:g} °C)",
                "give the temperature of the air at which the continuous current heats the line to "
                "reference_c",
            )
        return self


class TransformerRating(Initial):
    """What a transformer bears: by IEC 60076-7 if its cooling is given, otherwise by a time constant."""

    cooling: Literal["ONAF", "ONAN"] | None = Field(
        default=None,
        description="Its cooling, which chooses the constants of IEC 60076-7: a large transformer with "
        "fans, or a distribution transformer without; in place of `time_constant_min`.",
    )
    time_constant_min: Real | None = Field(
        default=None,
        gt=0,
        le=LONGEST_MIN,
        description="Time constant of its temperature, in place of `cooling`.",
    )
    ambient_c: Real | None = Field(
        default=None,
        ge=-60,
        le=80,
        description="Temperature of the air, with `cooling`; leave it out: 20 °C.",
    )
    highest_hot_spot_c: Real | None = Field(
        default=None,
        ge=50,
        le=250,
        description="Highest temperature of the hot spot, with `cooling`; leave it out: 120 °C, that of "
        "normal cyclic loading in IEC 60076-7, check your edition.",
    )
    overloads: Overloads = Field(
        default=(), description="Overloads that are allowed, the lowest and longest first."
    )

    @model_validator(mode="after")
    def _heated_in_one_way(self) -> Self:
        if (self.cooling is None) == (self.time_constant_min is None):
            raise fault(
                "give either cooling or time_constant_min",
                "leave one of them out, or add the one that is missing",
            )
        own = [key for key in ("ambient_c", "highest_hot_spot_c") if getattr(self, key) is not None]
        if self.cooling is None and own:
            raise fault(
                f"{' and '.join(own)} without cooling: a time constant alone gives no temperature",
                'leave it out, or give cooling = "ONAF" or "ONAN"',
            )
        if self.cooling is not None and self.air_c >= self.hottest_c:
            raise fault(
                f"ambient_c ({self.air_c:g} °C) is not below highest_hot_spot_c ({self.hottest_c:g} °C)",
                "give the temperature of the air as ambient_c",
            )
        return self

    @property
    def air_c(self) -> float:
        """Temperature of the air. [°C]"""
        return AIR_C if self.ambient_c is None else self.ambient_c

    @property
    def hottest_c(self) -> float:
        """Highest temperature of the hot spot. [°C]"""
        return HOT_SPOT_C if self.highest_hot_spot_c is None else self.highest_hot_spot_c


class LineTransformerRating(TransformerRating):
    """What a transformer of the high-voltage line bears, and its rated power."""

    rating_mva: Real = Field(ge=0.1, le=1_000, description="Rated power.")


class MotorRating(Initial):
    """Currents that one motor of a train bears: for ever, and for a while."""

    continuous_a: Real = Field(gt=0, le=5_000, description="Current that it bears for ever.")
    short_time_a: Real = Field(
        gt=0, le=10_000, description="Higher current, which a cold motor bears for a while."
    )
    short_time_min: Real = Field(
        gt=0,
        le=LONGEST_MIN,
        description="For how long: in that time it heats a cold motor as far as the continuous current "
        "does for ever, which gives the motor's time constant.",
    )
    spared: bool = Field(
        default=False,
        description="Whether the driver spares hot motors: never more than `short_time_a`, and never so "
        "much that they get hotter than `continuous_a` makes them; `preload_percent` says how warm "
        "they are when a train departs, and when the run begins.",
    )

    @model_validator(mode="after")
    def _bears_more_for_a_while(self) -> Self:
        if self.short_time_a <= self.continuous_a:
            raise fault(
                f"short_time_a ({self.short_time_a:g} A) is not above continuous_a "
                f"({self.continuous_a:g} A)",
                "give the higher current as short_time_a",
            )
        if self.spared and self.preload_percent is None:
            raise fault(
                "a driver who spares the motors has to know how warm they are at first",
                "add preload_percent, such as 0 for cold motors",
            )
        if self.spared and self.preload_percent is not None and self.preload_percent > 100:
            raise fault(
                f"a preload of {self.preload_percent:g} % leaves motors hotter than they bear, which no "
                "driver can spare any more",
                "give preload_percent up to 100, or leave out spared",
            )
        return self
