"""Parts of a drawing: plain data, independent of a plotting library.

`tpss.report.render` makes figures of it, for print or for a page.  Colours and dashes are numbers, which
it looks up; labels end with their units in brackets; only what is printed may hold formulae.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from tpss.report.palette import GREY, STRONG_GREY
from tpss.report.sampling import Floats

TIME, POSITION = "time [min]", "position [km]"
"""Horizontal axes of most figures."""

SOLID, DASHED, DASH_DOTTED, DOTTED = range(4)
"""Line styles, so that curves differ in black and white too."""


DOT, RING, SQUARE, TRIANGLE, DIAMOND, CROSS, NO_SYMBOL = range(7)
"""Symbols of places; without one a place has only its label."""


@dataclass(frozen=True)
class Colours:
    """Values that are shown as colours, from a low one, dark, to a high one."""

    values: Floats
    label: str
    low: float
    high: float
    explained: bool = True
    """Whether a scale beside the panel says which colour is which value."""


@dataclass(frozen=True)
class Curve:
    """A line through points, which NaN interrupts, or points alone if they are not joined.

    Values that are held stay constant until the next instant, rather than change linearly.  Points may
    have words, which are shown on hovering; the width of coloured ones is that of the points.
    """

    x: Floats
    y: Floats
    name: str = ""
    colour: int = 0
    dash: int = SOLID
    width: float = 1.0
    held: bool = False
    joined: bool = True
    words: Sequence[str] = ()
    colours: Colours | None = None


@dataclass(frozen=True)
class Band:
    """What lies between a lowest and a highest curve, shaded."""

    x: Floats
    lowest: Floats
    highest: Floats
    colour: int = 0


@dataclass(frozen=True)
class Mark:
    """A line across the panel at a value of its vertical axis or, if upright, of the horizontal one."""

    value: float
    words: str = ""
    printed: str = ""
    dash: int = SOLID
    colour: str = GREY
    upright: bool = False


@dataclass(frozen=True)
class Map:
    """Values over both axes, a row of them for every y and a column for every x."""

    x: Floats
    y: Floats
    colours: Colours


@dataclass(frozen=True)
class Bar:
    """A part of the bar in a row, counted from 0 and from above; of height 1 it fills its row."""

    row: int
    start: float
    length: float
    name: str
    words: str
    colour: str
    height: float = 0.62


@dataclass(frozen=True)
class Places:
    """Places with a symbol, with words on hovering, and labels above, slanted, or below, level."""

    x: Floats
    y: Floats
    name: str
    symbol: int
    colour: str
    words: Sequence[str]
    labels: Sequence[str] = ()
    above: bool = True
    hollow: bool = False


LEFT, RIGHT, ABOVE, BELOW = range(4)
"""Sides of a place on which its words stand; above and below they begin at it."""


@dataclass(frozen=True)
class Words:
    """Words beside a place, level."""

    x: float
    y: float
    text: str
    side: int = RIGHT
    colour: str = STRONG_GREY
    bold: bool = False


Item = Curve | Band | Mark | Map | Bar | Places | Words


@dataclass(frozen=True)
class Panel:
    """What is drawn over one vertical axis, in that order.

    The axis has a span, or begins at 0, or fits what is drawn; its ticks may have a fixed step.  Of
    bars it carries the names of their rows; of a plan it is bare, as nothing is counted along it.
    """

    label: str
    items: Sequence[Item]
    printed: str = ""
    span: tuple[float, float] | None = None
    from_zero: bool = False
    tick: float | None = None
    rows: Sequence[str] = ()
    bare: bool = False


@dataclass(frozen=True)
class Drawing:
    """Panels above each other with one horizontal axis; the legend is that of the first panel.

    Where its axis counts columns, from 0, it carries their names, above.  Without a name and columns it
    is not drawn.
    """

    axis: str
    panels: Sequence[Panel]
    span: tuple[float, float] | None = None
    panel_inch: float = 1.25
    """Height of a panel in print."""
    columns: Sequence[str] = ()
    width_inch: float = 7.0
    """Width in print."""
    names_one: bool = False
    """Whether a curve has a name in the legend even if it is alone."""


def unit_of(label: str) -> str:
    """Unit in the brackets at the end of a label; empty without one."""
    return label.partition("[")[2].rstrip("]")
