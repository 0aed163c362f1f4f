"""Rectifier stations of a direct-current line."""

import math
from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import AfterValidator, Field, model_validator

from tpss.physics.rectifier_bridge import IDEAL, bridge_voltage, mode_ends
from tpss.scenario.fields import FromLibrary, Part, Real, Whole, either_or, fault, library_name
from tpss.scenario.rating import Rating
from tpss.scenario.supply.feeding_station import FeedingStation
from tpss.scenario.supply.losses import ConverterLosses

MOST_POINTS = 6
"""Points of a characteristic; as many as `sources.rectifier` has room for."""

WITHIN_SECOND_MODE = (0.45, 0.8)
"""Where the bent part of a characteristic has points between its ends, as shares of its currents. [1]"""

Points = tuple[tuple[float, float], ...]
"""Points of a characteristic. [A], [kV]"""


class CurvePoint(Part):
    """A point of the characteristic of a group."""

    current_a: Real = Field(ge=0, le=1_000_000, description="Current of one group.")
    voltage_kv: Real = Field(gt=0, le=100, description="Its voltage.")


def _falls(curve: tuple[CurvePoint, ...]) -> tuple[CurvePoint, ...]:
    if curve[0].current_a != 0.0:
        raise fault(
            f"the first point has {curve[0].current_a:g} A",
            "begin with the voltage without load, at current_a = 0",
        )
    for one, other in pairwise(curve):
        if other.current_a <= one.current_a or other.voltage_kv >= one.voltage_kv:
            raise fault(
                f"{other.voltage_kv:g} kV at {other.current_a:g} A follows {one.voltage_kv:g} kV at "
                f"{one.current_a:g} A",
                "let the current grow and the voltage fall from point to point",
            )
    return curve


class RectifierTransformer(Part):
    """The transformer and the bridges of a group, from which its voltage and resistance follow."""

    rated_kva: Real = Field(gt=0, le=1_000_000, description="Rated power of the transformer.")
    secondary_v: Real = Field(
        gt=0,
        le=100_000,
        description="Line-to-line voltage at the valves of one bridge, without load.",
    )
    short_circuit_percent: Real = Field(ge=0.1, le=50, description="Its short-circuit voltage.")
    load_loss_kw: Real = Field(
        default=0.0, ge=0, le=10_000, description="Its load losses, at rated power."
    )
    no_load_loss_kw: Real | None = Field(
        default=None,
        ge=0,
        le=10_000,
        description="Its losses without load; leave it out: what the group loses is not described.",
    )
    diode_loss_kw: Real | None = Field(
        default=None,
        ge=0,
        le=10_000,
        description="Losses of the diodes at the rated current, in proportion to it, with "
        "`no_load_loss_kw`; leave it out: 0.",
    )
    bridges: Literal["one", "series", "parallel"] = Field(
        default="one",
        description="One six-pulse bridge, or two for twelve pulses, in series or in parallel, each at "
        "a secondary winding of its own.",
    )

    @property
    def no_load_voltage_kv(self) -> float:
        """Mean voltage without load. [kV]"""
        in_series = 2.0 if self.bridges == "series" else 1.0
        return in_series * IDEAL * self.secondary_v / 1e3

    @model_validator(mode="after")
    def _diodes_beside_the_transformer(self) -> Self:
        if self.diode_loss_kw is not None and self.no_load_loss_kw is None:
            raise fault(
                "diode_loss_kw without no_load_loss_kw", "add no_load_loss_kw, or leave it out"
            )
        return self

    @property
    def reactance_ohm(self) -> float:
        """Reactance of a phase of one bridge; each of two has half the transformer's power. [Ω]"""
        bridges = 1.0 if self.bridges == "one" else 2.0
        z_ohm = bridges * self.short_circuit_percent / 100.0 * self.secondary_v**2
        return z_ohm / (self.rated_kva * 1e3)

    @property
    def rated_a(self) -> float:
        """Current at its rated power and its voltage without load. [A]"""
        return self.rated_kva / self.no_load_voltage_kv

    @property
    def copper_ohm(self) -> float:
        """Fall of the voltage per current by its load losses. [Ω]"""
        return self.load_loss_kw * 1e3 / self.rated_a**2

    @property
    def resistance_ohm(self) -> float:
        """Fall of the voltage per current, by commutation and copper, up to a commutation of 60°. [Ω]

        A bridge that commutates over the reactance X loses 3 X / π; two in series twice that, two in
        parallel half of it.  Each of two bridges has half the transformer's power, so X = 2 e U² / S.
        """
        by_bridges = {"one": 1.0, "series": 2.0, "parallel": 0.5}[self.bridges]
        return by_bridges * 3.0 * self.reactance_ohm / math.pi + self.copper_ohm

    def points(self, between: tuple[float, ...] = WITHIN_SECOND_MODE) -> Points:
        """Points of the characteristic up to the short circuit: the ends of its three modes, and some
        between those of the second, where it is bent.
        """
        volts, ampere = ((2.0 if self.bridges == kind else 1.0) for kind in ("series", "parallel"))
        first_a, second_a, third_a = mode_ends(self.secondary_v, self.reactance_ohm)
        inner_a = (first_a + share * (second_a - first_a) for share in between)
        found = [(0.0, self.no_load_voltage_kv)]
        for each_a in (first_a, *inner_a, second_a, third_a):
            bridge_v = bridge_voltage(each_a, self.secondary_v, self.reactance_ohm)
            current_a = ampere * each_a
            fall_v = self.copper_ohm * current_a
            found.append((current_a, (volts * bridge_v - fall_v) / 1e3))
        # The copper brings the short circuit a little closer.
        (second_a, second_kv), (third_a, third_kv) = found[-2:]
        found[-1] = (second_a + second_kv * (third_a - second_a) / (second_kv - third_kv), 0.0)
        return tuple(found)


class Controlled(Part):
    """Thyristors that hold a voltage as long as their transformer gives it."""

    voltage_kv: Real = Field(gt=0, le=100, description="Voltage that they hold without load.")
    droop_ohm: Real = Field(
        ge=0.0001, le=10, description="Fall of the voltage that they hold per current of one group."
    )


class RectifierType(Part):
    """A group of rectifiers with their transformer, by one of three descriptions."""

    no_load_voltage_kv: Real | None = Field(
        default=None, gt=0, le=100, description="Voltage without load, with `resistance_ohm`."
    )
    resistance_ohm: Real | None = Field(
        default=None,
        ge=0.0001,
        le=100,
        description="Fall of the voltage per current of one group, with `no_load_voltage_kv`.",
    )
    curve: (
        Annotated[
            tuple[CurvePoint, ...],
            Field(min_length=2, max_length=MOST_POINTS),
            AfterValidator(_falls),
        ]
        | None
    ) = Field(
        default=None,
        description="Points of the characteristic instead, from no current on; the last piece goes on.",
    )
    transformer: RectifierTransformer | None = Field(
        default=None, description="Data of the transformer instead, from which both follow."
    )
    controlled: Controlled | None = Field(
        default=None,
        description="A voltage that thyristors hold below what the description above gives.",
    )
    rated_current_a: Real = Field(
        gt=0, le=1_000_000, description="Rated current of one group, to which loadings refer."
    )
    losses: ConverterLosses | None = Field(
        default=None,
        description="What one group loses with its transformer, its load being the current over the "
        "rated one; leave it out: by `no_load_loss_kw` of the transformer, or not described.",
    )
    rating: Rating | None = Field(
        default=None,
        description="What one group bears without getting too hot, of `rated_current_a`; leave it out: "
        "it is not judged.",
    )

    @model_validator(mode="after")
    def _described_once(self) -> Self:
        line = self.no_load_voltage_kv is not None or self.resistance_ohm is not None
        if [line, self.curve is not None, self.transformer is not None].count(True) != 1:
            raise either_or("no_load_voltage_kv with resistance_ohm", "curve", "transformer")
        if line and (self.no_load_voltage_kv is None or self.resistance_ohm is None):
            raise fault(
                "no_load_voltage_kv and resistance_ohm belong together",
                "add the one that is missing",
            )
        if (
            self.losses is not None
            and getattr(self.transformer, "no_load_loss_kw", None) is not None
        ):
            raise fault(
                "losses are given twice, by losses and by transformer.no_load_loss_kw",
                "leave out one of them",
            )
        if self.controlled is None:
            return self
        if self.curve is not None:
            raise fault(
                "controlled beside curve", "put the voltage that is held into the points of curve"
            )
        held, (_, natural_kv), (at_a, at_kv) = self.controlled, *self._natural[:2]
        if held.voltage_kv >= natural_kv:
            raise fault(
                f"controlled.voltage_kv ({held.voltage_kv:g} kV) is not below the voltage without load, "
                f"{natural_kv:g} kV",
                "hold a lower voltage, or leave controlled out",
            )
        natural_ohm = (natural_kv - at_kv) * 1e3 / at_a
        if held.droop_ohm >= natural_ohm:
            raise fault(
                f"controlled.droop_ohm ({held.droop_ohm:g} ohm) is no less than the fall of the group "
                f"itself, {natural_ohm:.4g} ohm",
                "let the voltage fall more slowly, or leave controlled out",
            )
        meets_a = (natural_kv - held.voltage_kv) * 1e3 / (natural_ohm - held.droop_ohm)
        if meets_a >= at_a:
            raise fault(
                f"controlled.voltage_kv ({held.voltage_kv:g} kV) is held up to {meets_a:.4g} A, and the "
                f"group's own voltage is known to fall in a straight line up to {at_a:.4g} A",
                "hold a higher voltage, or give the points of the characteristic as curve",
            )
        return self

    @property
    def _natural(self) -> Points:
        """Points of the characteristic without control."""
        if self.curve is not None:
            return tuple((each.current_a, each.voltage_kv) for each in self.curve)
        if self.transformer is not None:
            # One point is needed for where the voltage that is held ends.
            some = (
                WITHIN_SECOND_MODE if self.controlled is None else (sum(WITHIN_SECOND_MODE) / 2.0,)
            )
            return self.transformer.points(some)
        kv, ohm = float(self.no_load_voltage_kv or 0.0), float(self.resistance_ohm or 0.0)
        # Any second point of a straight line does: one at which a tenth of the voltage is left.
        return ((0.0, kv), (0.9e3 * kv / ohm, 0.1 * kv))

    @property
    def points(self) -> Points:
        """Points of the characteristic of one group."""
        natural, held = self._natural, self.controlled
        if held is None:
            return natural
        (_, kv), (at_a, at_kv) = natural[:2]
        ohm = (kv - at_kv) * 1e3 / at_a
        meets_a = (kv - held.voltage_kv) * 1e3 / (ohm - held.droop_ohm)
        return ((0.0, held.voltage_kv), (meets_a, kv - ohm * meets_a / 1e3), *natural[1:])

    @property
    def unloaded_kv(self) -> float:
        """Voltage without load. [kV]"""
        return self.points[0][1]


class Inverter(Part):
    """An inverter beside the rectifiers, which feeds back into the grid."""

    starts_at_kv: Real = Field(
        gt=0, le=100, description="Voltage from which it takes current, above that without load."
    )
    resistance_ohm: Real = Field(ge=0.0001, le=100, description="Rise of the voltage per current.")
    max_power_kw: Real | None = Field(
        default=None, gt=0, le=1_000_000, description="Highest power; leave it out: no limit."
    )


class RectifierStation(FeedingStation):
    """A rectifier station that feeds the contact line."""

    type: Annotated[RectifierType, FromLibrary("rectifiers", own="supply.rectifier_types")] = Field(
        description="Library name, a name of `supply.rectifier_types`, or a table of your own."
    )
    groups: Whole = Field(
        default=1, ge=1, le=100, description="Number of equal groups in parallel."
    )
    inverter: Inverter | None = Field(
        default=None, description="What takes power from the line; leave it out: nothing does."
    )

    @model_validator(mode="after")
    def _inverts_above_the_voltage_without_load(self) -> Self:
        if self.inverter is not None and self.inverter.starts_at_kv < self.no_load_voltage_kv:
            raise fault(
                f"inverter.starts_at_kv ({self.inverter.starts_at_kv:g} kV) is below the voltage "
                f"without load, {self.no_load_voltage_kv:g} kV, so that current would circulate",
                "let the inverter start above it",
            )
        return self

    @property
    def feedback(self) -> Literal["grid", "none"]:
        """Where the power goes that it takes from the contact line."""
        return "none" if self.inverter is None else "grid"

    @property
    def installed(self) -> int:
        """Number of groups installed."""
        return self.groups

    @property
    def no_load_voltage_kv(self) -> float:
        """Voltage without load. [kV]"""
        return self.type.unloaded_kv

    @property
    def unit_mva(self) -> float:
        """Rated power of one group: rated current at the voltage without load. [MVA]"""
        return self.type.rated_current_a * self.no_load_voltage_kv / 1e3

    @property
    def in_words(self) -> str:
        """What stands there."""
        group = library_name("rectifiers", self.type)
        back = "" if self.inverter is None else ", with an inverter"
        return (
            f"{self.groups} x {group} of {self.type.rated_current_a:g} A, "
            f"{self.no_load_voltage_kv:g} kV without load{back}"
        )
