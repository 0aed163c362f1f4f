"""What all kinds of feeding stations say of themselves: their name, their place, what they feed."""

from tpss.scenario.supply.feeds import Feeds, feeds
from tpss.scenario.supply.placed import Placed


class FeedingStation(Placed):
    """A station that feeds the contact line."""

    feeds: Feeds | None = feeds()
