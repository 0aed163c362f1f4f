"""How equipment heats up, and what it bears: ratings of a scenario in SI units."""

import math
from dataclasses import dataclass

from tpss.physics.thermal import COOLING, Cooling, state_after, time_to_rated_s
from tpss.scenario.rating import CatenaryRating, MotorRating, Overload, Rating, TransformerRating
from tpss.units import si

S_PER_MIN = 60.0


@dataclass(frozen=True)
class Body:
    """How equipment heats up, and what it bears.

    Attributes
    ----------
    time_constant_s : float
        Of its temperature; of a transformer whose cooling is known, that of its top oil.
    cooling : Cooling or None
        Constants of a transformer, in place of one time constant.
    overloads : tuple of (float, float)
        Highest r.m.s. loads, and the windows over which they are allowed: ascending. [1], [s]
    allowed_state : float
        Highest thermal state. [1]
    preload : float
        Load before the run; NaN: the r.m.s. load of the run. [1]
    ambient_c, rise_k : float
        Temperature of the air, and rated rise over it; NaN where no temperature is known.
    """

    time_constant_s: float
    cooling: Cooling | None = None
    overloads: tuple[tuple[float, float], ...] = ()
    allowed_state: float = 1.0
    preload: float = math.nan
    ambient_c: float = math.nan
    rise_k: float = math.nan

    def allowed_load(self, window_s: float) -> float:
        """Highest r.m.s. load over the window of an overload; NaN over others, which none limits. [1]"""
        of_window = (
            load
            for load, lasts_s in self.overloads
            if math.isclose(lasts_s, window_s, rel_tol=1e-9)
        )
        return next(of_window, math.nan)


def body_of(rating: Rating | TransformerRating | MotorRating) -> Body:
    """Body of a rating of any kind."""
    preload = math.nan if rating.preload_percent is None else si(rating, "preload_percent")
    if isinstance(rating, MotorRating):
        load = rating.short_time_a / rating.continuous_a
        lasts_s = si(rating, "short_time_min")
        return Body(time_to_rated_s(load, lasts_s), overloads=((load, lasts_s),), preload=preload)
    overloads = tuple(_overload(each) for each in rating.overloads)
    if isinstance(rating, TransformerRating) and rating.cooling is not None:
        cooling = COOLING[rating.cooling]
        return Body(
            cooling.memory_s,
            cooling,
            overloads,
            allowed_state=(rating.hottest_c - rating.air_c) / cooling.rise_k,
            preload=preload,
            ambient_c=rating.air_c,
            rise_k=cooling.rise_k,
        )
    time_constant_s = si(rating, "time_constant_min")
    reached = [state_after(load, lasts_s, time_constant_s) for load, lasts_s in overloads]
    ambient_c = reference_c = math.nan
    if isinstance(rating, CatenaryRating) and rating.ambient_c is not None:
        ambient_c, reference_c = rating.ambient_c, float(rating.reference_c or 0.0)
    return Body(
        time_constant_s,
        overloads=overloads,
        allowed_state=max([1.0, *reached]),
        preload=preload,
        ambient_c=ambient_c,
        rise_k=reference_c - ambient_c,
    )


def _overload(given: Overload) -> tuple[float, float]:
    """Load and time of an overload. [1], [s]"""
    return si(given, "percent"), given.minutes * S_PER_MIN
