"""Efficiency of a train's drive over its load."""

from typing import Annotated

from pydantic import Field, ValidationInfo, field_validator

from tpss.scenario.fields import Part, Real, ascending, fault
from tpss.scenario.machine import Ratio

MOST_LOADS = 8
"""Points that a curve may have: as many as a train's record has places, `vehicle.part_load`."""

RATED_PERCENT = 100.0
"""Load that a curve has to reach. [%]"""

_FALLS = {
    1.0: "rises so steeply that the motors would take less power, the more they give",
    -1.0: "falls so steeply that electric brakes would give less power, the more they take",
}


class EfficiencyOverLoad(Part):
    """A factor of the efficiency over the load; between its points it is interpolated smoothly."""

    load_percent: Annotated[
        tuple[Annotated[Real, Field(gt=0, le=1_000)], ...],
        Field(min_length=2, max_length=MOST_LOADS),
        ascending("load_percent"),
    ] = Field(
        description="Mechanical power of the motors over the rated one, ascending, up to 100 % at "
        "least; beyond them the outer values hold."
    )
    value: tuple[Ratio, ...] = Field(
        description="Factors of `efficiency` at these loads: the whole efficiency beside "
        "`efficiency = 1.0`."
    )
    rated_power_kw: Real | None = Field(
        default=None,
        gt=0,
        le=1_000_000,
        description="Mechanical power that is 100 %; leave it out: `max_power_kw` of the tractive "
        "effort, or of electric brakes with a curve of their own.",
    )

    @field_validator("load_percent")
    @classmethod
    def _reaches_rated_power(cls, load: tuple[float, ...]) -> tuple[float, ...]:
        if load[-1] < RATED_PERCENT:
            raise fault(
                f"the last load is {load[-1]:g} %, and the rated power is 100 %",
                "add the value at 100 %",
            )
        return load

    @field_validator("value")
    @classmethod
    def _one_value_per_load(
        cls, value: tuple[float, ...], info: ValidationInfo
    ) -> tuple[float, ...]:
        load = info.data.get("load_percent")
        if load is not None and len(value) != len(load):
            raise fault(
                f"value has {len(value)} values where load_percent has {len(load)}",
                "give as many values as load_percent has, in the same order",
            )
        return value

    @field_validator("value")
    @classmethod
    def _more_power_for_more(
        cls, value: tuple[float, ...], info: ValidationInfo
    ) -> tuple[float, ...]:
        load = info.data.get("load_percent")
        if load is None or len(value) != len(load):
            return value
        from tpss.vehicle.part_load import falls_with_power  # numba, which few scenarios need

        for sign, what in _FALLS.items():
            k = falls_with_power(list(load), list(value), sign)
            if k is not None:
                raise fault(
                    f"between {load[k]:g} % ({value[k]:g}) and {load[k + 1]:g} % ({value[k + 1]:g}) "
                    f"the efficiency {what}",
                    "bring these two values closer together, or their loads further apart",
                )
        return value
