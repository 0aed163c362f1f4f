"""What all kinds of feeding stations say of themselves: their name, their place, what they feed."""

from pydantic import Field

from tpss.scenario.fields import Name, Part, Position, Real, name_of_line, station_at
from tpss.scenario.supply.feeds import Feeds, feeds


class FeedingStation(Part):
    """A station that feeds the contact line."""

    name: Name = Field(description="Name, shown in the results.")
    line: Name | None = name_of_line()
    at: Name | None = station_at()
    position_km: Position = Field(description="Position on its line.")
    feeds: Feeds | None = feeds()
    rail_earthing_ohm: Real | None = Field(
        default=None,
        ge=0.001,
        le=1_000,
        description="Resistance between its return conductor, to which the rails lead, and the earth, "
        "with `supply.conductors`; leave it out: it is not earthed.",
    )
