"""Prices and costs as a plan gives them: numbers of the plan's currency, with their year and source."""

from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import (
    Discriminator,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    Tag,
)
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from tpss.scenario.fields import Part, Real, Whole

Year = Annotated[Whole, Field(ge=1900, le=2300)]
"""A year of the calendar."""

Money = Annotated[Real, Field(ge=0)]
"""An amount in the plan's currency, at the plan's price year."""


class Price(Part):
    """A price of the plan's currency, with where it is from."""

    value: Money = Field(description="The price, in the plan's currency.")
    price_year: Year | None = Field(
        default=None, description="Year of the price; left out: that of the plan."
    )
    source: str = Field(default="", description="Where the price is from.")


@dataclass(frozen=True)
class OrNumber:
    """Accept a number in place of a price's table."""

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.no_info_before_validator_function(self._as_table, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        return {"anyOf": [{"type": "number", "minimum": 0}, handler(schema)]}

    def _as_table(self, value: Any) -> Any:
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        return {"value": value} if is_number else value


PriceOrNumber = Annotated[Price, OrNumber()]
"""A price as a table, or its value alone."""


class CostOfLength(Part):
    """A cost in proportion to a length."""

    per_km: Money = Field(description="Cost of a kilometre.")
    km: Real = Field(gt=0, le=100_000, description="Length.")

    @property
    def total(self) -> float:
        """The cost, in the plan's currency."""
        return self.per_km * self.km


def _kind_of(value: object) -> str:
    return "length" if isinstance(value, dict | Part) else "number"


OneCost = Annotated[
    Annotated[Money, Tag("number")] | Annotated[CostOfLength, Tag("length")],
    Discriminator(_kind_of),
]
"""A cost, given as it is or by length."""

Cost = Annotated[
    Annotated[OneCost, Tag("one")]
    | Annotated[tuple[OneCost, ...], Field(min_length=1), Tag("levels")],
    Discriminator(lambda value: "levels" if isinstance(value, list | tuple) else "one"),
]
"""A cost, or one for each level of a measure."""


def amounts(cost: Any) -> tuple[float, ...]:
    """Costs in the plan's currency: one, or one for each level."""
    each = cost if isinstance(cost, tuple) else (cost,)
    return tuple(one.total if isinstance(one, CostOfLength) else float(one) for one in each)
