"""The 50 Hz side of feeding stations: what they take from the grid for what they feed.

Sign: positive powers go from the grid to the railway.  A converter's losses follow its apparent power on
the railway's side, in either direction.  They do not act on the railway.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.model.sources import mixed_law
from tpss.physics.rectifier_bridge import current_at_power
from tpss.record import Records
from tpss.results.standards.windows import Floats
from tpss.scenario.scenario import Scenario
from tpss.scenario.supply import (
    ConverterLosses,
    ConverterStation,
    ConverterType,
    MixedStation,
    RectifierStation,
    RectifierType,
    Station,
    TransformerStation,
)
from tpss.sources.mixed import TYPES, MixedLaw, split_all
from tpss.units import si, si_factor

Complexes = npt.NDArray[np.complex128]


@dataclass(frozen=True)
class LossLaw:
    """Losses of one converter; of a curve, or of coefficients in per unit of the rated power."""

    rating_va: float
    """Rated power. [VA]"""
    idle_w: float
    """Losses without load. [W]"""
    linear: float = 0.0
    """Losses over the apparent power. [1]"""
    quadratic: float = 0.0
    """Losses in proportion to its square, over the rated power at rated power. [1]"""
    feedback_quadratic: float = 0.0
    """The same while the railway feeds back. [1]"""
    curve_load: tuple[float, ...] = ()
    """Loads of a curve, ascending from 0. [1]"""
    curve_w: tuple[float, ...] = ()
    """Losses at these. [W]"""

    def by_load_w(self, loading: Floats, feeds_back: npt.NDArray[np.bool_]) -> Floats:
        r"""Losses of one converter beyond those without load. [W]

        .. math:: P = b S_N l + c S_N l^2, \qquad l = S / S_N

        Parameters
        ----------
        loading : array
            Apparent power over the rated power, not negative. [1]
        feeds_back : array of bool, of the same shape
            Whether the railway feeds back.
        """
        if self.curve_load:
            return self._of_curve_w(loading) - self.idle_w
        quadratic = np.where(feeds_back, self.feedback_quadratic, self.quadratic)
        return np.asarray(self.rating_va * (self.linear * loading + quadratic * loading**2))

    def _of_curve_w(self, loading: Floats) -> Floats:
        """Losses on a curve, of which the last straight line goes on. [W]"""
        load, loss = np.array(self.curve_load), np.array(self.curve_w)
        piece = np.clip(np.searchsorted(load, loading, side="right") - 1, 0, len(load) - 2)
        slope = np.diff(loss) / np.diff(load)
        return np.asarray(loss[piece] + slope[piece] * (loading - load[piece]))


@dataclass(frozen=True)
class Characteristic:
    """Voltage of a group of rectifiers over its current."""

    current_a: tuple[float, ...]
    voltage_v: tuple[float, ...]
    rated_a: float
    """Current to which its loading refers. [A]"""

    def loading(self, power_w: Floats) -> Floats:
        """Current at a power, over the rated one; 0 where it gives none. [1]"""
        points = np.array(self.current_a), np.array(self.voltage_v)
        return current_at_power(power_w, *points) / self.rated_a


def characteristic_of(kind: RectifierType, rated_a: float) -> Characteristic:
    """Characteristic of a group, with the current to which its loading refers. [A]"""
    current_a, voltage_kv = zip(*kind.points, strict=True)
    return Characteristic(current_a, tuple(kv * 1e3 for kv in voltage_kv), rated_a)


@dataclass(frozen=True)
class Units:
    """Converters of one type in a station."""

    law: LossLaw | None
    """None: their losses are not described."""
    count: float | None = None
    """How many run in a station with several types; None: as many as are recorded."""
    origin: str | None = None
    """Where the figures of the losses come from."""
    rectifier: "Characteristic | None" = None
    """Of a group of rectifiers, whose losses follow its current."""

    def loading(self, power_va: Complexes, count: Floats) -> Floats:
        """Load of one of so many that run: apparent power, or current of rectifiers that feed. [1]"""
        rating_va = count * (self.law.rating_va if self.law is not None else 1.0)
        apparent = np.hypot(power_va.real, power_va.imag) / rating_va
        if self.rectifier is None:
            return np.asarray(apparent)
        feeds = power_va.real > 0.0
        return np.where(feeds, self.rectifier.loading(power_va.real / count), apparent)


@dataclass(frozen=True)
class StationSide:
    """What a station loses, and where what it takes from the railway goes.

    Attributes
    ----------
    name : str
    units : tuple of Units
        Its converters by their types; none of a transformer station.
    mixed : Records of MixedLaw or None
        One record, by which several types share the power.
    auxiliaries_w : float or None
        Power of its auxiliaries; None: not described. [W]
    burns : bool
        Whether a resistor takes what the railway feeds back beyond the losses, so that nothing reaches
        the grid; of one that takes nothing back too, whose law takes a trace for its angle.
    no_load_w : float
        Losses of one of its transformers without load. [W]
    """

    name: str
    units: tuple[Units, ...] = ()
    mixed: Records[MixedLaw] | None = None
    auxiliaries_w: float | None = None
    burns: bool = False
    blocks: bool = False
    no_load_w: float = 0.0

    @property
    def is_described(self) -> bool:
        """Whether it says anything about losses."""
        return self.auxiliaries_w is not None or any(each.law is not None for each in self.units)

    @property
    def origin(self) -> str:
        """Where the figures of the losses come from; empty if that is not told."""
        return ", ".join(dict.fromkeys(each.origin for each in self.units if each.origin))


class Powers(NamedTuple):
    """Powers of a station in every step. [W], shape (steps,)

    What comes from the grid, less what goes there, is what is fed, plus losses, plus what is burnt.  All
    but what is fed are not negative.
    """

    fed: Floats
    from_grid: Floats
    to_grid: Floats
    burnt: Floats
    idle: Floats
    by_load: Floats
    auxiliaries: Floats

    @property
    def losses(self) -> Floats:
        """All losses of converters and auxiliaries."""
        return np.asarray(self.idle + self.by_load + self.auxiliaries)


def powers_of(active_w: Floats, reactive_var: Floats, running: Floats, side: StationSide) -> Powers:
    r"""Powers on the 50 Hz side of a station.

    .. math:: P_{50} = P + n \, P_0 + b S + c \frac{S^2}{n S_N} + P_{aux}, \qquad S = \sqrt{P^2 + Q^2}

    The running converters share alike; those of several types by their own laws, each type with the
    losses of its part.  Below zero the station delivers to the grid; one with a resistor
    burns that instead.  A station of which no converter runs is out of service, and takes nothing.

    Parameters
    ----------
    active_w, reactive_var : array, shape (steps,)
        Powers fed into the railway. [W], [var]
    running : array, shape (steps,)
        Number of converters that run.
    side : StationSide
    """
    runs, zero = running > 0.0, np.zeros_like(active_w)
    idle = by_load = zero
    powers = active_w + 1j * reactive_var
    shares = [powers] if side.mixed is None else _shared(powers, side.mixed)
    for own, units in zip(shares, side.units, strict=False):
        if units.law is None:
            continue
        count = running if units.count is None else np.where(runs, units.count, 0.0)
        loading = np.where(runs, units.loading(own, np.where(runs, count, 1.0)), 0.0)
        idle = idle + count * units.law.idle_w
        by_load = by_load + count * units.law.by_load_w(loading, own.real < 0.0)
    auxiliaries = np.where(runs, side.auxiliaries_w or 0.0, 0.0)
    balance = active_w + idle + by_load + auxiliaries
    if side.no_load_w:
        balance = balance + np.where(runs, running, 0.0) * side.no_load_w
    surplus = np.maximum(-balance, 0.0)
    to_grid, burnt = (zero, surplus) if side.burns else (surplus, zero)
    from_grid = np.maximum(balance, 0.0)
    return Powers(active_w, from_grid, to_grid, burnt, idle, by_load, auxiliaries)


def powers_of_types(powers_va: Complexes, station: MixedStation) -> list[Complexes]:
    """Powers of each of the types of a station in all steps. [VA]

    Parameters
    ----------
    powers_va : array of complex, shape (steps,)
        P + jQ that the station feeds. [VA]
    station : MixedStation
    """
    return _shared(powers_va, MixedLaw.array([mixed_law(station.units)]))


def _shared(powers_va: Complexes, law: Records[MixedLaw]) -> list[Complexes]:
    """Powers of each of several types in all steps."""
    shared = np.zeros((powers_va.size, len(TYPES)), dtype=complex)
    split_all(powers_va, law[0], shared)
    return list(shared.T)


def sides_of(scenario: Scenario) -> tuple[StationSide, ...]:
    """The 50 Hz sides of all feeding stations, in the order of the results."""
    return tuple(_side_of(station) for station in scenario.supply.stations)


def _side_of(station: Station) -> StationSide:
    if isinstance(station, TransformerStation):
        no_load_w = si(station.transformer, "no_load_loss_kw")
        return StationSide(station.name, burns=station.feedback != "grid", no_load_w=no_load_w)
    if isinstance(station, RectifierStation):
        group = _group_of(station.type)
        if group.law is None:
            return StationSide(station.name)
        return StationSide(station.name, (group,), blocks=station.feedback == "none")
    if not isinstance(station, ConverterStation | MixedStation):
        return StationSide(station.name)
    mixed = None
    if isinstance(station, MixedStation):
        units = tuple(_units_of(each.type, each.converters) for each in station.units)
        mixed = MixedLaw.array([mixed_law(station.units)])
    else:
        units = (_units_of(station.type),)
    return StationSide(
        name=station.name,
        units=units,
        mixed=mixed,
        auxiliaries_w=None if station.station_kw is None else si(station, "station_kw"),
        burns=station.feedback != "grid",
        blocks=station.feedback == "none",
    )


def _units_of(kind: ConverterType, count: float | None = None) -> Units:
    if kind.losses is None:
        return Units(None, count)
    return Units(law_of(kind.losses, si(kind, "rating_mva")), count, kind.losses.origin)


def _group_of(kind: RectifierType) -> Units:
    """A group of rectifiers: its losses over the current, of a transformer at its own rated one."""
    unit, rated_a = kind.transformer, kind.rated_current_a
    rating_va = rated_a * kind.unloaded_kv * 1e3
    if kind.losses is not None:
        law, origin = law_of(kind.losses, rating_va), kind.losses.origin
        return Units(law, origin=origin, rectifier=characteristic_of(kind, rated_a))
    if unit is None or unit.no_load_loss_kw is None:
        return Units(None)
    diodes_w = (unit.diode_loss_kw or 0.0) * si_factor("_kw") * unit.rated_a / rated_a
    law = LossLaw(
        si(unit, "rated_kva"),
        si(unit, "no_load_loss_kw"),
        linear=diodes_w / si(unit, "rated_kva"),
        quadratic=unit.load_loss_kw / unit.rated_kva,
        feedback_quadratic=unit.load_loss_kw / unit.rated_kva,
    )
    return Units(law, rectifier=characteristic_of(kind, unit.rated_a))


def law_of(losses: ConverterLosses, rating_va: float) -> LossLaw:
    """Losses of a converter in SI units."""
    if losses.curve is not None:
        watts = tuple(si(point, "loss_kw") for point in losses.curve)
        loads = tuple(si(point, "load_percent") for point in losses.curve)
        return LossLaw(rating_va, watts[0], curve_load=loads, curve_w=watts)
    quadratic = losses.quadratic_percent or 0.0
    back, percent = losses.feedback_quadratic_percent, si_factor("_percent")
    return LossLaw(
        rating_va,
        (losses.idle_kw or 0.0) * si_factor("_kw"),
        linear=(losses.linear_percent or 0.0) * percent,
        quadratic=quadratic * percent,
        feedback_quadratic=(quadratic if back is None else back) * percent,
    )
