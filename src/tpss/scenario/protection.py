"""What is disconnected when it passes what it may carry."""

from pydantic import Field

from tpss.scenario.fields import Flag, Part


class Protection(Part):
    """Protection of the supply."""

    trip: Flag = Field(
        default=False,
        description="Whether feeding stations, transformers of the high-voltage line and sections of "
        "contact line trip that pass an overload of their `rating`: the run goes on without them, and "
        "others have to carry their load.",
    )
