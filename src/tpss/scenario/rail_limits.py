"""Criteria for the voltage of rails to earth, and for stray current."""

from pydantic import Field

from tpss import library
from tpss.scenario.fields import Part, Real

KIND = "rail_limits"


class RailLimits(Part):
    """Limits of rails as conductors of their own; those left out are the library's."""

    permanent_v: Real | None = Field(
        default=None, gt=0, description="Highest mean over five minutes of their voltage to earth."
    )
    short_v: Real | None = Field(
        default=None, gt=0, description="Highest mean over a second, or over a longer time step."
    )
    stray_ma_per_m: Real | None = Field(
        default=None,
        gt=0,
        description="Highest mean current that leaves the rails of a track of a direct current for the "
        "earth, per length.",
    )

    def completed(self, is_direct: bool) -> "RailLimits":
        """These limits, with those of the library for a direct or an alternating current."""
        usual = library.values(KIND, "direct" if is_direct else "alternating")
        own = {key: value for key, value in self if value is not None}
        return RailLimits(**{**usual, **own})
