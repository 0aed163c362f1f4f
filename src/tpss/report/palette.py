"""Colours of static and interactive figures."""

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#000000")
"""Colours that colour-blind people can distinguish (Okabe and Ito)."""

BLACK = 5
"""Number of that colour."""

STRONG_GREY, GREY = "#444444", "#999999"
"""Of limits and their names, and of places on the line."""

Stops = tuple[tuple[float, str], ...]
"""A scale of colours by its stops, from 0 to 1."""

AREA_SCALE: Stops = ((0.0, "#A84300"), (0.35, "#E08214"), (0.7, "#F7CF8B"), (1.0, "#FFFDF5"))
"""From a low voltage, dark, to a high one: in black and white too."""

LINE_SCALE: Stops = (
    (0.0, "#07051B"), (0.125, "#290B55"), (0.25, "#540F6D"), (0.375, "#7A1D6D"), (0.5, "#A22B62"),
    (0.625, "#C73E4C"), (0.75, "#E45A31"), (0.875, "#F78212"), (1.0, "#FCAE12"),
)  # fmt: skip
"""The same for lines and points: inferno without its palest colours, which are not visible on white."""


def colour(k: int) -> str:
    """Colour of the k-th curve."""
    return COLOURS[k % len(COLOURS)]


def tint(pure: str, strength: float) -> str:
    """A colour mixed with white; of strength 1 it is pure, of strength 0 white."""
    parts = (int(pure[k : k + 2], 16) for k in (1, 3, 5))
    return "#" + "".join(f"{round(255 - strength * (255 - part)):02X}" for part in parts)


def translucent(pure: str, opacity: float) -> str:
    """A colour that lets shine through what is behind it, in the notation that every plotly reads."""
    red, green, blue = (int(pure[k : k + 2], 16) for k in (1, 3, 5))
    return f"rgba({red},{green},{blue},{opacity:g})"
