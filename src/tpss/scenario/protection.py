"""What is disconnected when it passes what it may carry."""

from pydantic import Field

from tpss.scenario.fields import Flag, Part


class Protection(Part):
    """Protection of the supply."""

    trip: Flag = Field(
        default=False,
        description="Whether a feeding station trips whose units pass an overload of their `rating`: "
        "the run goes on without it, and others have to carry its load.",
    )
