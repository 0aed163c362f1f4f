"""What all kinds of feeding stations say of themselves: their name, their place, what they feed."""

from pydantic import Field

from tpss.scenario.fields import Real
from tpss.scenario.supply.feeds import Feeds, feeds
from tpss.scenario.supply.placed import Placed


class FeedingStation(Placed):
    """A station that feeds the contact line."""

    feeds: Feeds | None = feeds()
    rail_earthing_ohm: Real | None = Field(
        default=None,
        ge=0.001,
        le=1_000,
        description="Resistance between its return conductor, to which the rails lead, and the earth, "
        "with `supply.conductors`; leave it out: it is not earthed.",
    )
