"""The kinds of tables that a scenario takes from files: which columns they have."""

from typing import NamedTuple

from tpss.tables.aliases import ALIASES


class Kind(NamedTuple):
    """A kind of table.

    Attributes
    ----------
    name : str
    needed : tuple of tuple of str
        Quantities that it cannot be without; of those in one tuple, one is enough.
    further : tuple of str
        Quantities that it may have.
    row : str
        What a row is, in words.
    used : str
        How a scenario names its file.
    alone : tuple of (str, str)
        Further quantities, and what they are in a table where no other column is that.
    """

    name: str
    needed: tuple[tuple[str, ...], ...]
    further: tuple[str, ...]
    row: str
    used: str
    alone: tuple[tuple[str, str], ...] = ()

    @property
    def quantities(self) -> tuple[str, ...]:
        """All quantities of its columns."""
        return (*(each for either in self.needed for each in either), *self.further)

    @property
    def header(self) -> str:
        """Our own header, of what is needed."""
        return ",".join(ALIASES[either[0]].key for either in self.needed)


GRADIENTS = Kind(
    "gradients",
    (("position",), ("gradient", "altitude")),
    (),
    "a position and a gradient, or an altitude",
    'gradients_file = "{file}" of the line',
)
SPEED_LIMITS = Kind(
    "speed-limits",
    (("position",), ("speed_limit",)),
    ("end",),
    "a position, perhaps an end, and a speed",
    'speed_limits_file = "{file}" of the line',
)
STATIONS = Kind(
    "stations",
    (("station",), ("position",)),
    ("tracks", "track_length"),
    "a name and a position",
    'stations_file = "{file}" of the line',
)
EFFORT = Kind(
    "effort",
    (("speed",), ("force",)),
    ("voltage",),
    "a speed and a force, perhaps at a voltage",
    'tractive_effort = {{ curve_file = "{file}" }} of a train',
)
BRAKING = Kind(
    "braking",
    (("speed",), ("retardation",)),
    (),
    "a speed and the retardation from there on",
    'max_retardation_m_s2 = {{ curve_file = "{file}" }} of a train',
)
LOSSES = Kind(
    "losses",
    (("load",), ("losses",)),
    (),
    "a load and the losses at it",
    'losses = {{ curve_file = "{file}" }} of a converter type',
)
TIMETABLE = Kind(
    "timetable",
    (("train_name",), ("called_at",), ("departure",)),
    ("train_type", "arrival", "dwell", "turn", "track", "kind"),
    "a train, a station and times",
    '[[timetables]] with file = "{file}"',
    alone=(("train_type", "train_name"),),
)

KINDS = {
    each.name: each
    for each in (GRADIENTS, SPEED_LIMITS, STATIONS, EFFORT, BRAKING, LOSSES, TIMETABLE)
}
