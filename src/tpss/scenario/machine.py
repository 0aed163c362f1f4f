"""A train's machine: the effort of its motors, and curves over speed in place of numbers."""

from collections.abc import Sequence
from typing import Annotated, Any, Literal, Self

from pydantic import (
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    ValidationInfo,
    field_validator,
    model_validator,
)
from pydantic.json_schema import JsonSchemaValue

from tpss.scenario.fields import Part, Real, ascending, fault

MOST_VOLTAGES = 16
"""Rows that a table of tractive effort may have."""

MOST_BANDS = 8
"""Bands that a retardation over speed may have."""

Ratio = Annotated[Real, Field(ge=0.1, le=1)]
Coefficient = Annotated[Real, Field(ge=0.01, le=1)]
Retardation = Annotated[Real, Field(ge=0.01, le=5)]

Speeds = Annotated[
    tuple[Annotated[Real, Field(ge=0, le=500)], ...],
    Field(min_length=2),
    ascending("speed_kmh"),
]


def _demand_length(values: Sequence[object], name: str, count: int, axis: str) -> None:
    if len(values) != count:
        raise fault(
            f"{name} has {len(values)} values where {axis} has {count}",
            f"give as many values as {axis} has, in the same order",
        )


class Curve(Part):
    """A quantity over speed; between its points it is interpolated without overshoot."""

    speed_kmh: Speeds = Field(description="Speeds, ascending; beyond them the outer values hold.")
    value: tuple[Ratio, ...] = Field(description="Values at these speeds.")

    @field_validator("value")
    @classmethod
    def _one_value_per_speed(
        cls, value: tuple[float, ...], info: ValidationInfo
    ) -> tuple[float, ...]:
        if "speed_kmh" in info.data:
            _demand_length(value, "value", len(info.data["speed_kmh"]), "speed_kmh")
        return value


class AdhesionCurve(Curve):
    """An adhesion coefficient over speed; between its points it is interpolated without overshoot."""

    value: tuple[Coefficient, ...] = Field(description="Coefficients at these speeds.")


def _or_in_a_file(schema: JsonSchemaValue) -> None:
    """For the JSON Schema of a curve: its lists, or a file with them."""
    schema["anyOf"] = [{"required": schema.pop("required")}, {"required": ["curve_file"]}]


def _is_a_table(value: object) -> bool:
    return isinstance(value, dict | Part)


RatioOverSpeed = Annotated[
    Annotated[Ratio, Tag("number")] | Annotated[Curve, Tag("curve")],
    Discriminator(lambda value: "curve" if _is_a_table(value) else "number"),
]
"""A number, or a curve over speed."""


AdhesionOverSpeed = Annotated[
    Annotated[Coefficient, Tag("number")] | Annotated[AdhesionCurve, Tag("curve")],
    Discriminator(lambda value: "curve" if _is_a_table(value) else "number"),
]
"""A coefficient, or a curve over speed."""


class RetardationBands(Part):
    """A highest retardation by bands of speed, each from its speed up to that of the next one."""

    model_config = ConfigDict(json_schema_extra=_or_in_a_file)

    curve_file: str | None = Field(
        default=None,
        description="CSV file or workbook in place of the lists, with the columns speed_kmh and "
        "retardation_m_s2.",
    )
    from_speed_kmh: Annotated[
        tuple[Annotated[Real, Field(ge=0, le=500)], ...],
        Field(min_length=1, max_length=MOST_BANDS),
        ascending("from_speed_kmh"),
    ] = Field(description="Speeds from which the bands hold, ascending, the first 0.")
    retardation_m_s2: tuple[Retardation, ...] = Field(
        description="Highest deceleration by braking in each of these bands."
    )

    @field_validator("from_speed_kmh")
    @classmethod
    def _begins_at_a_stand(cls, value: tuple[float, ...]) -> tuple[float, ...]:
        if value[0] != 0.0:
            raise fault("the first band does not begin at 0", "begin it at 0")
        return value

    @field_validator("retardation_m_s2")
    @classmethod
    def _one_value_per_band(
        cls, value: tuple[float, ...], info: ValidationInfo
    ) -> tuple[float, ...]:
        if "from_speed_kmh" in info.data:
            speeds = info.data["from_speed_kmh"]
            _demand_length(value, "retardation_m_s2", len(speeds), "from_speed_kmh")
        return value


RetardationOverSpeed = Annotated[
    Annotated[Retardation, Tag("number")] | Annotated[RetardationBands, Tag("bands")],
    Discriminator(lambda value: "bands" if _is_a_table(value) else "number"),
]
"""A number, or one for each band of speeds."""


def _depth(value: object) -> str:
    """Whether forces are a row over speed, rows over voltage, or blocks over current."""
    names = ["row", "rows", "blocks"]
    while isinstance(value, list | tuple) and value and isinstance(value[0], list | tuple):
        value = value[0]
        names = names[1:] or ["blocks"]
    return names[0]


Voltages = Annotated[
    tuple[Annotated[Real, Field(gt=0, le=100)], ...],
    Field(min_length=2, max_length=MOST_VOLTAGES),
    ascending("voltage_kv"),
]
Currents = Annotated[
    tuple[Annotated[Real, Field(gt=0, le=5_000)], ...],
    Field(min_length=2),
    ascending("motor_current_a"),
]
Force = Annotated[Real, Field(ge=0, le=10_000)]
Row = tuple[Force, ...]
Rows = tuple[Row, ...]
Blocks = tuple[Rows, ...]


class EffortTable(Part):
    """Highest force of all motors over speed, and perhaps over line voltage and current limit.

    It is interpolated without overshoot and with a continuous derivative; beyond its speeds and
    voltages the outer values hold, and the steps in which they did are counted in the result.
    """

    model_config = ConfigDict(json_schema_extra=_or_in_a_file)

    curve_file: str | None = Field(
        default=None,
        description="CSV file or workbook in place of the lists, with the columns speed_kmh and "
        "force_kn, and perhaps voltage_kv.",
    )
    speed_kmh: Speeds = Field(description="Speeds, ascending.")
    voltage_kv: Voltages | None = Field(
        default=None, description="Voltages at the pantograph; `force_kn` has a row for each."
    )
    motor_current_a: Currents | None = Field(
        default=None,
        description="Current limits of a motor; `force_kn` has a block (rows over voltage, or a row) "
        "for each, and the train's `max_motor_current_a` chooses between them.",
    )
    force_kn: Annotated[
        Annotated[Row, Tag("row")]
        | Annotated[Rows, Tag("rows")]
        | Annotated[Blocks, Tag("blocks")],
        Discriminator(_depth),
    ] = Field(description="Force of all motors, one value per speed.")

    @field_validator("force_kn")
    @classmethod
    def _one_value_per_point(cls, force: Any, info: ValidationInfo) -> Any:
        axes = ("motor_current_a", "voltage_kv", "speed_kmh")
        if not set(axes) <= set(info.data):
            return force  # an axis has a fault of its own
        level = [force]
        name = "force_kn"
        for axis in axes:
            if info.data[axis] is None:
                continue
            for part in level:
                if not isinstance(part, tuple):
                    raise fault(
                        "force_kn is nested less deeply than there are axes",
                        "nest the lists: a row over speed, for each voltage, for each current",
                    )
                _demand_length(part, name, len(info.data[axis]), axis)
            level = [item for part in level for item in part]
            name = "a list of force_kn"
        if any(isinstance(item, tuple) for item in level):
            raise fault(
                "force_kn is nested more deeply than there are axes",
                "add voltage_kv or motor_current_a, or give a plain row over speed",
            )
        return force


class EffortLimits(Part):
    """Constant force, then constant power; from `limit_speed_kmh` on the force falls as 1/v²."""

    max_force_kn: Real = Field(gt=0, le=10_000, description="Highest force of all motors.")
    max_power_kw: Real = Field(
        gt=0, le=1_000_000, description="Highest mechanical power of all motors, F v."
    )
    limit_speed_kmh: Real | None = Field(
        default=None,
        gt=0,
        le=500,
        description="Speed beyond which the motors' pull-out force limits, as 1/v², in the range of "
        "constant power; leave it out: constant power to the end.",
    )
    full_voltage_kv: Real | None = Field(
        default=None,
        gt=0,
        le=100,
        description="Line voltage from which force and power are full; leave both voltages out: "
        "at any voltage.",
    )
    zero_voltage_kv: Real | None = Field(
        default=None,
        ge=0,
        description="Line voltage below which they are zero; in between they fall linearly.",
    )

    @model_validator(mode="after")
    def _pull_out_limits_in_the_range_of_constant_power(self) -> Self:
        begin_kmh = 3.6 * self.max_power_kw / self.max_force_kn
        if self.limit_speed_kmh is not None and self.limit_speed_kmh < begin_kmh * (1.0 - 1e-9):
            raise fault(
                f"limit_speed_kmh ({self.limit_speed_kmh:g} km/h) lies below the speed from which power "
                f"limits, max_power_kw / max_force_kn = {begin_kmh:.4g} km/h",
                f"raise it to {begin_kmh:.4g} km/h at least, or leave it out; or lower max_power_kw",
            )
        return self

    @model_validator(mode="after")
    def _two_voltages_in_order(self) -> Self:
        full, zero = self.full_voltage_kv, self.zero_voltage_kv
        if (full is None) != (zero is None):
            raise fault(
                "full_voltage_kv and zero_voltage_kv belong together",
                "give both, or leave both out",
            )
        if full is not None and zero is not None and zero >= full:
            raise fault(
                f"zero_voltage_kv ({zero:g} kV) is not below full_voltage_kv ({full:g} kV)",
                "lower zero_voltage_kv, or raise full_voltage_kv",
            )
        return self


class CurrentLimitation(Part):
    """Highest current of a train: full from a · Un on, only that of its auxiliaries at Umin2."""

    max_current_a: Real = Field(
        gt=0,
        le=10_000,
        description="Highest current at the pantograph, motors and auxiliaries together.",
    )
    knee_factor: Real = Field(
        default=0.95,
        gt=0,
        le=1,
        description="a, the share of Un from which the full current is allowed; without `un_kv` this "
        "and the next ones are those of the supply's system.",
    )
    un_kv: Real = Field(default=15.0, gt=0, le=100, description="Nominal voltage, Un.")
    umin2_kv: Real = Field(
        default=11.0,
        gt=0,
        le=100,
        description="Lowest non-permanent voltage, Umin2, at which there is no traction; in between "
        "the current falls linearly.",
    )
    auxiliaries: Literal["current", "power"] = Field(
        default="current",
        description="Where the current falls to: to that of the auxiliaries at Umin2, along a straight "
        "line, or at each voltage to what their `power` takes there.",
    )

    @model_validator(mode="after")
    def _knee_lies_above_the_end(self) -> Self:
        knee_kv = self.knee_factor * self.un_kv
        if self.umin2_kv >= knee_kv:
            raise fault(
                f"umin2_kv ({self.umin2_kv:g} kV) is not below knee_factor · un_kv ({knee_kv:g} kV)",
                "lower umin2_kv, or raise knee_factor or un_kv",
            )
        return self


_OF_A_TABLE = {"speed_kmh", "force_kn", "voltage_kv", "motor_current_a", "curve_file"}


def _type_of_effort(value: object) -> str | None:
    if isinstance(value, EffortTable) or (isinstance(value, dict) and _OF_A_TABLE & set(value)):
        return "table"
    if _is_a_table(value):
        return "limits"
    return "name" if value == "Rc4" else None


TractiveEffort = Annotated[
    Annotated[Literal["Rc4"], Tag("name")]
    | Annotated[EffortTable, Tag("table")]
    | Annotated[EffortLimits, Tag("limits")],
    Discriminator(
        _type_of_effort,
        custom_error_type="fault",
        custom_error_message="neither the name of a machine nor a table",
        custom_error_context={
            "remedy": 'write "Rc4", or a table with speed_kmh and force_kn, or one with max_force_kn '
            "and max_power_kw"
        },
    ),
]
"""The name of a machine, a table, or limits."""
