"""Laws of other packages that a scenario names, in place of those of TPSS; see `tpss.laws`."""

import itertools
from typing import TYPE_CHECKING, Any, ClassVar, Self

from pydantic import Field, PrivateAttr, model_validator
from pydantic_core import PydanticCustomError

from tpss.laws.kinds import CONVERTER, DRIVER, RESISTANCE
from tpss.laws.law import LawError, LawKind
from tpss.laws.registry import Registered, find_law
from tpss.laws.trial import numbers_of, try_converter, try_law
from tpss.scenario.fields import Name, Part, Real, fault

if TYPE_CHECKING:
    from tpss.scenario.scenario import Scenario

SPEEDS_TRIED = 9
"""Speeds, from 0 to that of the train, at which its laws are tried."""


class OwnLaw(Part):
    """A law of another package, and its parameters."""

    of_kind: ClassVar[LawKind]
    law: Name = Field(description="Name of the law; `tpss laws` lists those there are.")
    parameters: dict[Name, Real] = Field(
        default_factory=dict,
        description="Its parameters, in its units; those left out have the values that it has.",
    )

    # As it was when the scenario was read: another one of its name may be registered later.
    _registered: Registered = PrivateAttr()

    def __hash__(self) -> int:
        return hash((self.law, *sorted(self.parameters.items())))

    @property
    def registered(self) -> Registered:
        """The law, and whose it is."""
        return self._registered

    @property
    def values(self) -> tuple[float, ...]:
        """Values of all its parameters, in their order."""
        return self.registered.law.values(self.parameters)

    @model_validator(mode="after")
    def _is_known(self) -> Self:
        try:
            self._registered = find_law(self.of_kind.name, self.law)
            self._registered.law.values(self.parameters)
        except LawError as error:
            raise as_fault(error) from error
        return self


class ResistanceLaw(OwnLaw):
    """A running resistance by another package."""

    of_kind = RESISTANCE


class DriverLaw(OwnLaw):
    """A driver by another package."""

    of_kind = DRIVER


class ConverterLaw(OwnLaw):
    """Voltage and angle of converters by another package."""

    of_kind = CONVERTER

    @property
    def unloaded_v(self) -> float:
        """Voltage without load. [V]"""
        return numbers_of(self.registered.law, self.values, (0.0, 0.0))[0]


def laws_of(scenario: "Scenario") -> list[str]:
    """The laws of other packages that a scenario uses, in words, each once."""
    trains = [scenario.trains[entry.train] for entry in scenario.traffic]
    stations = scenario.supply.converter_stations
    used: list[OwnLaw | None] = [
        *(law for train in trains for law in (train.resistance_law, train.driver)),
        *(station.law for station in stations),
    ]
    return list(dict.fromkeys(each.registered.in_words for each in used if each is not None))


def as_fault(error: LawError) -> PydanticCustomError:
    """What a scenario says of a law that cannot be used."""
    return fault(error.problem, error.remedy)


def demand_resistance(own: ResistanceLaw, highest_m_s: float, given: tuple[float, ...]) -> None:
    """Raise a fault if a law finds no resistance of a train at a speed that it may have.

    Parameters
    ----------
    own : ResistanceLaw
    highest_m_s : float
        Highest speed of the train. [m/s]
    given : tuple of float
        What the law is given beside the speed.
    """
    _try(own, [(speed, *given) for speed in _speeds(highest_m_s)])


def demand_wishes(own: DriverLaw, highest_m_s: float) -> None:
    """Raise a fault if a law finds no speed that a driver may want of a train up to its highest."""
    speeds, far_m = _speeds(highest_m_s), (0.0, 100.0, 10_000.0)
    _try(own, itertools.product(speeds, speeds[1:], (0.0, 50_000.0), far_m))


def demand_voltages(own: ConverterLaw, rated_va: float) -> None:
    """Raise a fault if a law finds no voltage of a converter within its rating, or wrong slopes."""
    try:
        try_converter(own.registered.law, own.values, rated_va)
    except LawError as error:
        raise as_fault(error) from error


def _speeds(highest_m_s: float) -> list[float]:
    return [highest_m_s * k / (SPEEDS_TRIED - 1) for k in range(SPEEDS_TRIED)]


def _try(own: OwnLaw, tried: Any) -> None:
    try:
        try_law(own.registered.law, own.values, tried)
    except LawError as error:
        raise as_fault(error) from error
