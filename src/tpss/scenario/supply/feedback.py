"""What a feeding station does with the power that it takes from the contact line."""

from typing import Any, Literal

from pydantic import Field

Feedback = Literal["grid", "resistor"]
"""Where the power goes that trains feed back to a station."""


def feedback() -> Any:
    """The field of a station."""
    return Field(
        default="grid",
        description="Where the power goes that it takes from the contact line: into the grid, or into a "
        "resistor of its own.",
    )


ConverterFeedback = Literal["grid", "resistor", "none"]
"""The same of a converter station, which may take no power."""


def converter_feedback() -> Any:
    """The field of a converter station."""
    return Field(
        default="grid",
        description="Where the power goes that it takes from the contact line: into the grid, or into a "
        "resistor of its own; `none`: it takes none, as its rectifier cannot turn round.",
    )
