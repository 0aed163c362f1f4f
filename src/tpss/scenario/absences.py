"""What scenarios cannot describe, so that an unknown key is told what it asks for in vain."""

import re
from typing import NamedTuple


class Absence(NamedTuple):
    """Something that is not modelled.

    Attributes
    ----------
    keys : str
        Regular expression of the keys that ask for it, matched from a word's beginning.
    words : str
        What is not modelled.
    instead : str
        What to do.
    parts : tuple of str
        Where it is asked for: a table or list, such as ``speed_limits``; empty: anywhere.
    """

    keys: str
    words: str
    instead: str = "leave it out"
    parts: tuple[str, ...] = ()


_ENDS = r"(to|end|until|upto)(_km|_m)?$|length_k?m$"

ABSENCES = (
    Absence(
        r"regen|recuperat|feed_?back",
        "regeneration at this place",
        "write [trains.NAME.regeneration] with max_force_kn and max_power_kw",
    ),
    Absence(
        r"neutral|phase_(break|separation)|separation_section|dead_section|gaps?$",
        "neutral sections and gaps of the contact line at this place",
        "write [[supply.neutral_sections]] with from_km, to_km and raise_s",
    ),
    Absence(
        _ENDS,
        "an end of a speed limit",
        "a limit holds until the next one begins; where limits overlap, give the lowest at each "
        "place, with an entry wherever it changes",
        ("speed_limits",),
    ),
    Absence(
        _ENDS,
        "an end of a gradient",
        "a gradient holds until the next one begins; add an entry with 0 where it ends",
        ("gradients",),
    ),
    Absence(
        r"direction|reverse|return_trip|bidirectional",
        "a direction of its own: trains run from `from` to `to`",
        "leave it out, and name the stations in the order of travel",
    ),
    Absence(
        r"time_?table|schedule|arrivals?(_min|_s)?$|arrive",
        "a timetable at this place",
        'write [[timetables]] with a file, such as file = "timetable.csv"; or give arrive_after_min and '
        "depart_after_min of the stops of a service",
    ),
    Absence(
        r"supplement|(time_)?margin|recovery|allowance|buffer",
        "a supplement to running times at this place",
        "give supplement_percent or supplement_min_per_100km of a service",
    ),
    Absence(
        r"elevation|altitude|height|heights$",
        "altitudes of the line",
        "give gradients: the difference of two altitudes over their distance, in per mille",
    ),
    Absence(
        r"curvature|radius$|radii|curve_|cant$",
        "curvature and cant of the line as profiles",
        "line.curves takes from_km, to_km and radius_m of each curve",
        ("line",),
    ),
    Absence(r"tunnel", "tunnels"),
    Absence(r"signal|block|interlocking", "signals and blocks"),
    Absence(
        r"adhesion(?!_speed)|friction",
        "an adhesion of the whole line",
        "choose simulation.rail, or give adhesion of a train: a number or a curve over speed",
        ("simulation", "line"),
    ),
    Absence(
        r"(limits|speed_limits|stations|timetable)_file",
        "CSV files of anything but gradients and timetables",
        'write the list here, or name a file that ends in .toml, such as line = "line.toml"',
    ),
    Absence(
        r"out_of_service|outage|disabled|failed",
        "a key for it here",
        "list what is out of service in [[outages]]",
    ),
    Absence(
        r"thermal|ampacity",
        "a thermal limit at this place",
        "write rating of a catenary, a converter type or a transformer, or motor_rating of a train",
    ),
    Absence(
        r"conductors?$|wires?$|line_geometry",
        "conductors of a line at this place",
        "make a catenary of them: tpss line-constants FILE --out catenary.toml, then supply.catenary = "
        '"catenary.toml"',
    ),
    Absence(
        r"storage|battery|accumulator",
        "stores of energy at this place",
        "list them in [[supply.storage]], or write storage of a train",
    ),
    Absence(
        r"earth|rail_(potential|voltage|leakage)|return_(current|line)|leakage|stray",
        "the return circuit at this place",
        "write [supply.conductors], and rail_earthing_ohm of a station",
    ),
    Absence(r"harmonics?", "harmonics"),
)
"""Everything that unknown keys are held against, the first that matches first."""


def absence_of(location: tuple[int | str, ...]) -> Absence | None:
    """What the key of a location asks for that is known not to be modelled, if anything."""
    key = str(location[-1]).lower().replace("-", "_")
    above = {str(name) for name in location[:-1]}
    for each in ABSENCES:
        here = not each.parts or bool(above & set(each.parts))
        if here and re.search(rf"(^|_)({each.keys})", key):
            return each
    return None
