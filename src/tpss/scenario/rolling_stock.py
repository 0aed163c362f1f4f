"""The trains: a library model, any of its fields overridden."""

from typing import Annotated, Any, Literal, Self

from pydantic import AfterValidator, Field, model_validator
from pydantic_core import PydanticCustomError

from tpss import library
from tpss.scenario.fields import Name, Part, Real


def _is_a_library_model(name: str) -> str:
    known = library.entries("locomotives")
    if name not in known:
        raise PydanticCustomError(
            "unknown_name",
            "the library has no such entry in {kind}",
            {"kind": "locomotives", "known": sorted(known)},
        )
    return name


class Train(Part):
    """A train: the locomotive's machine and the whole train's mechanics."""

    model: Annotated[Name, AfterValidator(_is_a_library_model)] = Field(
        description="Library model; the other keys override its values."
    )
    machine: Literal["Rc4"] = Field(description="Machine whose networks give forces and currents.")
    mass_t: Real = Field(gt=0, le=20_000, description="Mass of the whole train.")
    adhesive_mass_t: Real = Field(gt=0, description="Mass on driven axles.")
    rotating_mass_factor: Real = Field(
        ge=0, le=1, description="Rotating parts of the hauled mass, H, as a share of it."
    )
    motor_inertia_kg: Real = Field(
        ge=0, description="Inertia of the motors, 4 K_J, as a mass at the wheel rim."
    )
    slip: Real = Field(ge=0, le=0.5, description="Slip ratio of the driven wheels, κ.")
    resistance_a_n: Real = Field(ge=0, description="Running resistance A + B v + C v²: A.")
    resistance_b_n_s_per_m: Real = Field(ge=0, description="B.")
    resistance_c_n_s2_per_m2: Real = Field(ge=0, description="C.")
    max_speed_kmh: Real = Field(gt=0, le=500, description="Highest speed of the train.")
    max_motor_current_a: Real = Field(
        gt=0,
        le=5_000,
        description="Highest current of one motor; the machine's curves end at 2080 A.",
    )
    max_retardation_m_s2: Real = Field(gt=0, le=5, description="Highest braking retardation.")
    efficiency: Real = Field(gt=0, le=1, description="From pantograph to motor shaft.")
    auxiliary_power_kw: Real = Field(ge=0, description="Active power of the auxiliaries.")
    auxiliary_power_factor: Real = Field(gt=0, le=1, description="Their power factor.")
    reactive_power: Literal["power-factor", "double-bridge"] = Field(
        description="Reactive power of the motors by the power factor curve or by the bridges."
    )
    base_speed_kmh: Real = Field(gt=0, description="Speed of the highest motor voltage.")
    max_motor_voltage_v: Real = Field(gt=0, description="Highest voltage of one motor.")
    motor_voltage: Literal["new", "former"] = Field(
        default="new", description="Motor voltage over speed alone, or lowered below 14 kV too."
    )
    motor_current: Literal["new", "former"] = Field(
        default="new", description="Motor current of one motor, or the sum of all four."
    )
    filter_reactance_ohm: Real | None = Field(
        default=None,
        lt=0,
        description="Reactance of the filter on the transformer's secondary side; -0.45 for an "
        "Rc4; leave it out: no filter.",
    )

    @model_validator(mode="after")
    def _adhesive_mass_is_a_part_of_the_mass(self) -> Self:
        if self.adhesive_mass_t > self.mass_t:
            raise PydanticCustomError(
                "conflict",
                "adhesive_mass_t ({adhesive} t) is more than mass_t ({mass} t)",
                {
                    "adhesive": self.adhesive_mass_t,
                    "mass": self.mass_t,
                    "remedy": "raise mass_t, which is of the whole train, or lower adhesive_mass_t",
                },
            )
        return self

    @model_validator(mode="before")
    @classmethod
    def _start_from_the_library(cls, given: Any) -> Any:
        if not isinstance(given, dict) or not isinstance(given.get("model"), str):
            return given
        known = library.entries("locomotives")
        # An unknown model is reported by its own field; any values let the others be judged too.
        model = given["model"] if given["model"] in known else next(iter(known))
        return {**library.values("locomotives", model), **given}
