"""The trains: a model of the library or of a file, any of its fields overridden."""

from typing import Annotated, Any, Literal, Self

from pydantic import Field, ValidationInfo, field_validator, model_validator

from tpss import library
from tpss.scenario.completed import completed
from tpss.scenario.fields import Name, Part, Real, entry_of, fault
from tpss.scenario.machine import (
    AdhesionOverSpeed,
    CurrentLimitation,
    EffortLimits,
    EffortTable,
    RatioOverSpeed,
    RetardationOverSpeed,
    TractiveEffort,
)
from tpss.scenario.on_board import OnBoardStorage
from tpss.scenario.over_load import EfficiencyOverLoad
from tpss.scenario.own_laws import DriverLaw, ResistanceLaw, demand_resistance, demand_wishes
from tpss.scenario.rating import MotorRating
from tpss.scenario.regeneration import Regeneration
from tpss.scenario.supply.system import SystemName
from tpss.units import si

BY_SYSTEM = "by_system"
"""Key of what a train is under one system or another."""

LARGEST_SHARE = 0.5
"""Largest share of rotating parts in the mass of a train; 1 plus it is the largest factor."""


class Train(Part):
    """A train: the locomotive's machine and the whole train's mechanics."""

    model: Annotated[Name, entry_of("locomotives")] | None = Field(
        default=None,
        description="Library model, or the name of a file that ends in .toml, whose values the "
        "other keys override; leave it out, and give all of them.",
    )
    systems: tuple[SystemName, ...] | None = Field(
        default=None,
        min_length=1,
        description="Electrification systems that it is made for; leave it out: any.",
    )
    by_system: dict[SystemName, dict[str, Any]] | None = Field(
        default=None,
        description="What differs under a system, by its name: any keys of a train, in place of those "
        "here. Only that of the supply's system counts.",
    )
    tractive_effort: TractiveEffort = Field(
        description="Highest force of the motors: the name of a machine (Rc4), a table over speed "
        "(and voltage, and current limit), or a highest force and power."
    )
    mass_t: Real = Field(ge=1, le=20_000, description="Mass of the whole train.")
    adhesive_mass_t: Real = Field(ge=1, le=20_000, description="Mass on driven axles.")
    adhesion: AdhesionOverSpeed | None = Field(
        default=None,
        description="Adhesion coefficient between the driven wheels and the rails: a number, or a "
        "curve over speed; leave it out: by `simulation.rail`.",
    )
    length_m: Real = Field(
        default=0.0,
        ge=0,
        le=5_000,
        description="Length, behind the train's position: a speed limit rises once the tail has "
        "passed, and the gradient is the mean under the train; 0: a point.",
    )
    rotating_mass_factor: Real = Field(
        default=0.0,
        ge=0,
        le=1,
        description="Rotating parts of the hauled mass, H, as a share of it.",
    )
    rotating_mass_share: Real | None = Field(
        default=None,
        ge=0,
        le=LARGEST_SHARE,
        description="All rotating parts, those of driven axles and motors included, as a share of the "
        "mass of the whole train, such as 0.06; in place of `rotating_mass_factor` and "
        "`motor_inertia_kg`.",
    )
    motor_inertia_kg: Real = Field(
        default=0.0,
        ge=0,
        le=1_000_000,
        description="Inertia of the motors, 4 K_J, as a mass at the wheel rim.",
    )
    slip: Real = Field(default=0.0, ge=0, le=0.5, description="Slip ratio of the driven wheels, κ.")
    resistance_a_n: Real = Field(
        ge=0, le=10_000_000, description="Running resistance A + B v + C v²: A."
    )
    resistance_b_n_s_per_m: Real = Field(ge=0, le=1_000_000, description="B.")
    resistance_c_n_s2_per_m2: Real = Field(ge=0, le=100_000, description="C.")
    resistance_law: ResistanceLaw | None = Field(
        default=None,
        description="Running resistance by a law of another package, which is given A, B and C too; "
        "leave it out: A + B v + C v².",
    )
    driver: DriverLaw | None = Field(
        default=None,
        description="Driver by a law of another package, with continuous motion: the speed that he "
        "wants at each step; leave it out: as fast as limits allow.",
    )
    max_speed_kmh: Real = Field(ge=1, le=500, description="Highest speed of the train.")
    max_motor_current_a: Real | None = Field(
        default=None,
        validate_default=True,
        ge=1,
        le=5_000,
        description="Highest current of one motor, for the Rc4, whose curves end at 2080 A, and for "
        "tables with several current limits.",
    )
    max_acceleration_m_s2: Real | None = Field(
        default=None,
        ge=0.01,
        le=10,
        description="Highest acceleration; leave it out: no such limit.",
    )
    max_retardation_m_s2: RetardationOverSpeed = Field(
        description="Highest deceleration by braking: a number, or one for each band of speeds, "
        "with continuous motion."
    )
    efficiency: RatioOverSpeed = Field(
        description="From pantograph to motor shaft: a number, or a curve over speed."
    )
    efficiency_over_load: EfficiencyOverLoad | None = Field(
        default=None,
        description="Factor of it over the load, by which it falls at a part of the rated power; leave "
        "it out: the same at all loads.",
    )
    auxiliary_power_kw: Real = Field(
        ge=0, le=20_000, description="Active power of the auxiliaries."
    )
    auxiliary_power_factor: Real = Field(
        default=0.8, ge=0.1, le=1, description="Their power factor."
    )
    reactive_power: Literal["power-factor", "double-bridge"] = Field(
        default="power-factor",
        description="Reactive power of the motors by a power factor, or by the Rc4's bridges.",
    )
    power_factor: RatioOverSpeed | None = Field(
        default=None,
        validate_default=True,
        description="Power factor of the motors, inductive: a number, or a curve over speed; leave "
        "it out: that of the Rc4.",
    )
    base_speed_kmh: Real | None = Field(
        default=None,
        validate_default=True,
        ge=1,
        le=500,
        description="Speed of the highest motor voltage; leave it out, and the motors' current is "
        "not known.",
    )
    max_motor_voltage_v: Real | None = Field(
        default=None,
        validate_default=True,
        ge=10,
        le=10_000,
        description="Highest voltage of one motor.",
    )
    motor_voltage: Literal["new", "former"] = Field(
        default="new", description="Motor voltage over speed alone, or lowered below 14 kV too."
    )
    motor_current: Literal["new", "former"] = Field(
        default="new", description="Motor current of one motor, or the sum of all four."
    )
    transformer_primary_kv: Real = Field(
        default=15.0,
        ge=0.1,
        le=100,
        description="Line voltage at which the transformer has its secondary voltage.",
    )
    transformer_secondary_v: Real = Field(
        default=487.0,
        ge=10,
        le=10_000,
        description="Secondary voltage of the locomotive's transformer, for bridges and filter; that "
        "of an Rc4 by default.",
    )
    filter_reactance_ohm: Real | None = Field(
        default=None,
        ge=-1_000,
        le=-0.01,
        description="Reactance of the filter on the transformer's secondary side; -0.45 for an "
        "Rc4; leave it out: no filter.",
    )

    current_limitation: CurrentLimitation | None = Field(
        default=None,
        description="Current limitation at low voltage, as in EN 50388; leave it out: no such limit.",
    )

    regeneration: Regeneration | None = Field(
        default=None,
        description="Electric brakes that feed back, with continuous motion; leave it out: none.",
    )

    storage: OnBoardStorage | None = Field(
        default=None,
        description="Store of energy on board, with continuous motion; leave it out: none.",
    )

    motor_rating: MotorRating | None = Field(
        default=None,
        description="Currents that a motor bears without getting too hot; leave it out: it is not "
        "judged.",
    )

    @field_validator("rotating_mass_factor", "rotating_mass_share", mode="before")
    @classmethod
    def _share_not_factor(cls, value: Any) -> Any:
        if isinstance(value, int | float) and 1.0 < value <= 1.0 + LARGEST_SHARE:
            raise fault(
                "a factor of the mass of the whole train, where a share is asked for",
                f"write rotating_mass_share = {value - 1.0:.4g}, and leave out rotating_mass_factor",
            )
        return value

    @field_validator("length_m")
    @classmethod
    def _a_point_or_a_train(cls, length_m: float) -> float:
        if 0.0 < length_m < 1.0:
            raise fault("shorter than a metre", "give the length in m, or 0 for a point")
        return length_m

    @field_validator("max_motor_current_a")
    @classmethod
    def _current_of_the_machine(cls, current: float | None, info: ValidationInfo) -> float | None:
        effort = info.data.get("tractive_effort")
        known = effort.motor_current_a if isinstance(effort, EffortTable) else None
        if current is None and (effort == "Rc4" or known):
            raise fault("the tractive effort depends on it", "add it, such as 1250")
        if current is not None and known and not known[0] <= current <= known[-1]:
            raise fault(
                "outside the current limits of the table of tractive effort",
                f"choose between {known[0]:g} and {known[-1]:g} A, or extend the table",
            )
        return current

    @field_validator("efficiency_over_load")
    @classmethod
    def _load_of_the_machine(
        cls, curve: EfficiencyOverLoad | None, info: ValidationInfo
    ) -> EfficiencyOverLoad | None:
        if curve is None or curve.rated_power_kw is not None:
            return curve
        if "tractive_effort" in info.data and not isinstance(
            info.data["tractive_effort"], EffortLimits
        ):
            raise fault(
                "the load is a share of a rated power, which the tractive effort does not state",
                "add rated_power_kw to it, such as 3600",
            )
        return curve

    @field_validator("power_factor")
    @classmethod
    def _power_factor_of_the_machine(cls, factor: Any, info: ValidationInfo) -> Any:
        effort = info.data.get("tractive_effort", "Rc4")
        if factor is None and effort != "Rc4" and info.data.get("reactive_power") == "power-factor":
            raise fault(
                "the power factor of the Rc4 is not that of another machine",
                "add power_factor, a number or a curve { speed_kmh = [...], value = [...] }",
            )
        return factor

    @field_validator("base_speed_kmh", "max_motor_voltage_v")
    @classmethod
    def _voltage_of_the_motors(cls, value: float | None, info: ValidationInfo) -> float | None:
        if value is None and info.data.get("reactive_power") == "double-bridge":
            raise fault(
                "the bridges' reactive power depends on it",
                'add it, or choose reactive_power = "power-factor"',
            )
        return value

    @model_validator(mode="after")
    def _base_speed_and_motor_voltage_belong_together(self) -> Self:
        if (self.base_speed_kmh is None) != (self.max_motor_voltage_v is None):
            raise fault(
                "base_speed_kmh and max_motor_voltage_v belong together",
                "give both, or leave both out",
            )
        return self

    @model_validator(mode="after")
    def _current_of_rated_motors_is_known(self) -> Self:
        if self.motor_rating is None:
            return self
        if self.base_speed_kmh is None:
            raise fault(
                "motor_rating judges the motors' current, which is not known without their voltage",
                "give base_speed_kmh and max_motor_voltage_v, or leave out motor_rating",
            )
        if self.regeneration is not None:
            raise fault(
                "motor_rating judges the motors' current, which is not recorded while they brake",
                "leave out motor_rating, or regeneration",
            )
        if self.motor_rating.spared and self.motor_voltage == "former":
            raise fault(
                "a driver who spares the motors foresees their current, which the former model of their "
                "voltage lets depend on the line voltage",
                'choose motor_voltage = "new", or leave out spared',
            )
        return self

    @property
    def auxiliary_current_a(self) -> float:
        """Current of the auxiliaries at the voltage at which the limitation leaves nothing else. [A]"""
        limit = self.current_limitation
        if limit is None:
            return 0.0
        return self.auxiliary_kva / limit.umin2_kv

    @property
    def auxiliary_kva(self) -> float:
        """Apparent power of the auxiliaries. [kVA]"""
        return self.auxiliary_power_kw / self.auxiliary_power_factor

    @model_validator(mode="after")
    def _auxiliaries_draw_less_than_the_train_may(self) -> Self:
        limit, auxiliaries_a = self.current_limitation, self.auxiliary_current_a
        if limit is not None and auxiliaries_a >= limit.max_current_a:
            raise fault(
                f"the auxiliaries draw {auxiliaries_a:.4g} A at {limit.umin2_kv:g} kV, and "
                f"current_limitation.max_current_a allows {limit.max_current_a:g} A",
                "raise max_current_a, or lower auxiliary_power_kw",
            )
        return self

    @model_validator(mode="after")
    def _adhesive_mass_is_a_part_of_the_mass(self) -> Self:
        if self.adhesive_mass_t > self.mass_t:
            raise fault(
                f"adhesive_mass_t ({self.adhesive_mass_t} t) is more than mass_t ({self.mass_t} t)",
                "raise mass_t, which is of the whole train, or lower adhesive_mass_t",
            )
        return self

    @model_validator(mode="after")
    def _own_laws_find_numbers(self) -> Self:
        highest_m_s = si(self, "max_speed_kmh")
        if self.resistance_law is not None:
            davis = ("resistance_a_n", "resistance_b_n_s_per_m", "resistance_c_n_s2_per_m2")
            given = tuple(si(self, name) for name in ("mass_t", *davis))
            demand_resistance(self.resistance_law, highest_m_s, given)
        if self.driver is not None:
            demand_wishes(self.driver, highest_m_s)
        return self

    @model_validator(mode="after")
    def _rotating_parts_are_counted_once(self) -> Self:
        if self.rotating_mass_share is not None:
            for name in ("rotating_mass_factor", "motor_inertia_kg"):
                if getattr(self, name) > 0.0:
                    raise fault(
                        f"rotating_mass_share counts the rotating parts of {name} too",
                        f"leave out {name}, or rotating_mass_share",
                    )
        elif self.rotating_mass_factor > 0.0 and self.adhesive_mass_t == self.mass_t:
            share = min(self.rotating_mass_factor, LARGEST_SHARE)
            raise fault(
                "rotating_mass_factor is of the hauled mass, and the whole train is on driven axles",
                f"write rotating_mass_share = {share:.4g} in its place, which counts driven axles too, "
                "and leave out motor_inertia_kg",
            )
        return self

    @model_validator(mode="before")
    @classmethod
    def _start_from_the_library(cls, given: Any) -> Any:
        if not isinstance(given, dict) or not isinstance(given.get("model"), str):
            return given
        known = library.entries("locomotives")
        # An unknown model is reported by its own field; any values allow the others to be checked too.
        model = given["model"] if given["model"] in known else next(iter(known))
        values = library.values("locomotives", model)
        # What it is under the system of the supply has been put into its place already.
        return completed(given, {key: values[key] for key in values if key != BY_SYSTEM})
