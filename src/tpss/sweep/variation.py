"""Values of one parameter of a study: a list, or a range."""

import math
from collections.abc import Mapping
from functools import cached_property
from typing import Any, Self

import numpy as np
from pydantic import Field, model_validator

from tpss.scenario.fields import Flag, Part, Real, Whole, fault

RANGE_KEYS = {"low", "high", "steps", "whole", "scale"}


class Variation(Part):
    """Values of a parameter: a list in the file, a single value, or a table with a range.

    In a grid a range gives `steps` values, ends included; in a drawn design any between its ends.
    """

    values: tuple[Any, ...] | None = Field(default=None, description="Values, in place of a range.")
    low: Real | None = Field(default=None, description="Lower end of the range.")
    high: Real | None = Field(default=None, description="Upper end of the range.")
    steps: Whole | None = Field(
        default=None, ge=2, le=1_000_000, description="Number of values in a grid."
    )
    whole: Flag = Field(default=False, description="Whether only whole numbers are meant.")
    scale: str = Field(
        default="linear",
        pattern="^(linear|log)$",
        description="Whether numbers are drawn evenly, or their logarithms (log).",
    )

    @model_validator(mode="before")
    @classmethod
    def _read(cls, value: Any) -> Any:
        if isinstance(value, Mapping):
            return value
        return {"values": value if isinstance(value, list | tuple) else [value]}

    @model_validator(mode="after")
    def _is_not_empty(self) -> Self:
        if self.values is not None:
            if self.low is not None or self.high is not None:
                raise fault("both values and a range are given", "leave one of them out")
            if not self.values:
                raise fault("an empty list", "add values")
            return self
        if self.low is None or self.high is None:
            raise fault("a range without both ends", "write { low = 5.0, high = 30.0 }")
        if not self.low < self.high:
            problem = f"an empty range, {self.low:g} to {self.high:g}"
            raise fault(problem, "set low below high, or list the values")
        if self.scale == "log" and self.low <= 0.0:
            raise fault(
                "a logarithmic range from a number that is not positive",
                'set low above 0, or scale = "linear"',
            )
        if self.whole and not (self.low.is_integer() and self.high.is_integer()):
            raise fault("a range of whole numbers with other ends", "write whole numbers")
        return self

    @property
    def levels(self) -> list[Any]:
        """Values of a list, or those of a range in a grid."""
        if self.values is not None:
            return list(self.values)
        if self.whole and self.steps is None:
            return list(range(int(self._low), int(self._high) + 1))
        if self.steps is None:
            raise ValueError("a range in a grid needs its number of steps")
        shares = np.linspace(0.0, 1.0, self.steps)
        numbers = [self._number(float(share)) for share in shares]
        return list(dict.fromkeys(round(n) for n in numbers)) if self.whole else numbers

    @property
    def ends(self) -> list[Any]:
        """All values of a list, or the ends of a range."""
        if self.values is not None:
            return list(self.values)
        ends = [self._low, self._high]
        return [int(end) for end in ends] if self.whole else list(ends)

    @cached_property
    def is_text(self) -> bool:
        """Whether its values are text in a table: neither all numbers nor all flags."""
        if all(isinstance(value, bool) for value in self.ends):
            return False
        return any(
            isinstance(value, bool) or not isinstance(value, int | float) for value in self.ends
        )

    def at(self, share: float) -> Any:
        """Value at a share of the distance from the first to the last one, 0 <= share < 1."""
        if self.values is not None:
            return self.values[int(share * len(self.values))]
        if not self.whole:
            return self._number(share)
        if self.scale == "log":
            return min(int(self._high), max(int(self._low), round(self._number(share))))
        return int(self._low) + int(share * (self._high - self._low + 1.0))

    @property
    def _low(self) -> float:
        return 0.0 if self.low is None else self.low

    @property
    def _high(self) -> float:
        return 0.0 if self.high is None else self.high

    def _number(self, share: float) -> float:
        low, high = self._low, self._high
        if self.scale == "log":
            low, high = math.log(low), math.log(high)
            return min(self._high, max(self._low, math.exp(low + share * (high - low))))
        return min(high, low + share * (high - low))


def flattened(table: Mapping[str, Any], *, is_variation: bool, above: str = "") -> dict[str, Any]:
    """A table with key paths as keys: ``traffic.0.headway_min`` may be written with or without quotes.

    Parameters
    ----------
    is_variation : bool
        Whether a table with the keys of a range is a value.
    """
    flat: dict[str, Any] = {}
    for key, value in table.items():
        path = f"{above}.{key}" if above else key
        is_range = is_variation and isinstance(value, Mapping) and bool(RANGE_KEYS & set(value))
        if isinstance(value, Mapping) and value and not is_range:
            flat |= flattened(value, is_variation=is_variation, above=path)
        else:
            flat[path] = value
    return flat
