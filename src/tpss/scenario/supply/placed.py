"""What everything that is joined to the contact line says of itself: its name and its place."""

from pydantic import Field

from tpss.scenario.fields import Name, Part, Position, name_of_line, station_at


class Placed(Part):
    """Something at a place of a line."""

    name: Name = Field(description="Name, shown in the results.")
    line: Name | None = name_of_line()
    at: Name | None = station_at()
    position_km: Position = Field(description="Position on its line.")
