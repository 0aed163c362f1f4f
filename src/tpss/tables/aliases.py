"""What headings of columns mean: names in English, German and Swedish, and units.

Names are compared without capitals, accents and whatever separates words: ``Höhe``, ``HÖHE`` and
``hohe`` are one.  A unit may stand in brackets, behind the name, or before it: ``Höhe [m]``,
``elevation_m``, ``km von``.
"""

import re
import unicodedata
from collections.abc import Iterable, Mapping
from functools import cache
from typing import NamedTuple

from tpss import units

KM = "km kilometer kilometern kilometre kilometres kilometrierung streckenkilometer bahnkilometer"
METRES = "m meter metern metre metres"

_LENGTHS = {KM: 1.0, METRES: 1e-3}
_HEIGHTS = {f"{METRES} masl muenn munn mnn mnhn mueadria moh": 1.0, "ft feet": 0.3048}
_SECONDS = {"s sec sek seconds sekunden sekunder": 1.0, "min minutes minuten minuter": 60.0}


class Quantity(NamedTuple):
    """What a column may hold.

    Attributes
    ----------
    key : str
        Its heading in files of TPSS, which ends in the unit.
    names : tuple of str
        Other names, without a unit.
    units : mapping of str to float
        Factors to the unit of the key, by the names of units with spaces between; none of texts.
    usual : str
        Unit where the heading gives none; empty: it has to.
    low, high : float
        Between which values it lies, in the unit of the key: by that two readings are told apart.
    """

    key: str
    names: tuple[str, ...]
    units: Mapping[str, float] = {}
    usual: str = ""
    low: float = -1e300
    high: float = 1e300

    @property
    def is_number(self) -> bool:
        """Whether it is a number with a unit."""
        return bool(self.units)

    @property
    def words(self) -> str:
        """What it is, without its unit."""
        return "end" if self.key == "to_km" else units.words(self.key)


def _of_position(key: str, *names: str) -> Quantity:
    return Quantity(key, names, _LENGTHS, "", -12_000.0, 12_000.0)


_SPEEDS = {"kmh kmt kmtim kph": 1.0, "ms": 3.6, "mph": 1.609344}

ALIASES: dict[str, Quantity] = {
    "position": _of_position(
        "position_km", "position", "pos", "chainage", "stationing", "location", "kilometrage",
        "lage", "ort km", "strecken km", "bahn km", "stationierung", "läge", "längdmätning",
        "from", "begin", "begins", "start", "von", "ab", "anfang", "beginn", "från", "börjar",
    ),
    "end": _of_position(
        "to_km", "to", "until", "end", "ends", "bis", "ende", "till", "slut", "slutar"
    ),
    "gradient": Quantity(
        "gradient_permille",
        ("gradient", "slope", "grade", "inclination", "neigung", "steigung", "längsneigung",
         "gradiente", "lutning", "stigning"),
        {"permille promille perthousand ‰ mmm mkm": 1.0, "percent percentage prozent procent %": 10.0},
        "permille", -100.0, 100.0,
    ),
    "altitude": Quantity(
        "altitude_m",
        ("altitude", "elevation", "height", "level", "höhe", "hoehe", "höhenlage", "seehöhe", "höjd",
         "nivå", "profilhöjd"),
        _HEIGHTS, "m", -500.0, 9_000.0,
    ),
    "speed_limit": Quantity(
        "speed_kmh",
        ("speed", "speed limit", "limit", "line speed", "max speed", "vmax", "v", "geschwindigkeit",
         "höchstgeschwindigkeit", "hoechstgeschwindigkeit", "vzul", "hastighet", "sth",
         "största tillåtna hastighet", "maxhastighet"),
        _SPEEDS, "kmh", 1.0, 500.0,
    ),
    "speed": Quantity(
        "speed_kmh", ("speed", "v", "geschwindigkeit", "hastighet"), _SPEEDS, "kmh", 0.0, 500.0
    ),
    "station": Quantity(
        "name",
        ("name", "station", "stop", "place", "bahnhof", "betriebsstelle", "haltestelle", "halt", "ort",
         "driftplats", "driftsplats", "hållplats", "trafikplats", "namn"),
    ),
    "tracks": Quantity(
        "tracks", ("tracks", "gleise", "gleiszahl", "spår", "antal spår"), {"1": 1.0}, "1", 1.0, 50.0
    ),
    "track_length": Quantity(
        "track_length_m", ("track length", "gleislänge", "gleislaenge", "nutzlänge", "spårlängd"),
        {METRES: 1.0}, "m", 10.0, 10_000.0,
    ),
    "force": Quantity(
        "force_kn",
        ("force", "tractive effort", "tractive force", "effort", "zugkraft", "dragkraft", "kraft", "f"),
        {"kn": 1.0, "n": 1e-3}, "kn", 0.0, 10_000.0,
    ),
    "voltage": Quantity(
        "voltage_kv",
        ("voltage", "line voltage", "spannung", "fahrdrahtspannung", "spänning", "u"),
        {"kv": 1.0, "v": 1e-3}, "kv", 0.001, 100.0,
    ),
    "retardation": Quantity(
        "retardation_m_s2",
        ("retardation", "deceleration", "braking", "bremsverzögerung", "verzögerung",
         "bromsretardation"),
        {"ms2 ms²": 1.0}, "ms2", 0.01, 5.0,
    ),
    "load": Quantity(
        "load_percent", ("load", "auslastung", "last", "belastning"),
        {"percent prozent procent %": 1.0}, "percent", 0.0, 1_000.0,
    ),
    "losses": Quantity(
        "loss_kw", ("loss", "losses", "verlust", "verluste", "verlustleistung", "förlust", "förluster"),
        {"kw": 1.0, "w": 1e-3, "mw": 1e3}, "kw", 0.0, 100_000.0,
    ),
    "train_name": Quantity(
        "name",
        ("name", "train number", "train no", "train id", "zug", "zugnummer", "zug nr", "tåg",
         "tågnummer", "tågnr"),
    ),
    "train_type": Quantity(
        "train", ("train", "train type", "type", "zugtyp", "baureihe", "tågtyp", "fordon")
    ),
    "called_at": Quantity(
        "station",
        ("station", "stop", "place", "bahnhof", "betriebsstelle", "haltestelle", "ort", "driftplats",
         "driftsplats", "hållplats", "trafikplats"),
    ),
    "arrival": Quantity("arrival", ("arrival", "arr", "ankunft", "an", "ankomst", "ank")),
    "departure": Quantity(
        "departure", ("departure", "dep", "abfahrt", "ab", "avgång", "avg", "avgångstid")
    ),
    "dwell": Quantity(
        "min_dwell_s", ("min dwell", "dwell", "least dwell", "haltezeit", "mindesthaltezeit", "uppehåll",
                        "uppehållstid"), _SECONDS, "s", 0.0, 6_000_000.0,
    ),
    "turn": Quantity(
        "turn_s", ("turn", "turn time", "wendezeit", "vändtid"), _SECONDS, "s", 0.0, 6_000_000.0
    ),
    "track": Quantity("track", ("track", "gleis", "spår")),
    "kind": Quantity("kind", ("kind", "art", "slag")),
}  # fmt: skip
"""Everything that a column may hold, by a name of our own."""


_BETWEEN = ("in", "i")
"""Words between a name and its unit: Höhe in m, höjd i m."""


@cache
def folded(text: str) -> tuple[str, ...]:
    """Words of a text without capitals, accents and what separates them."""
    apart = unicodedata.normalize("NFKD", text.replace("²", "2").casefold())
    bare = "".join(each for each in apart if not unicodedata.combining(each))
    return tuple(re.findall(r"[a-z0-9]+|[‰%]", bare))


@cache
def _names(quantity: str) -> frozenset[str]:
    each = ALIASES[quantity]
    own = " ".join(folded(units.words(each.key)))
    return frozenset({own, *(" ".join(folded(name)) for name in each.names)})


@cache
def _units(quantity: str) -> dict[str, tuple[str, float]]:
    """Names and factors of the units of a quantity, by how they are written."""
    return {
        "".join(folded(written)): (names.split()[0], factor)
        for names, factor in ALIASES[quantity].units.items()
        for written in names.split()
    }


class Meaning(NamedTuple):
    """What a heading means: a quantity, its unit as it was written, and the factor to ours."""

    quantity: str
    unit: str
    factor: float
    is_given: bool
    """Whether the heading gives the unit."""


def meaning_of(heading: str, among: Iterable[str]) -> Meaning | None:
    """What a heading means among some quantities; None if it is none of theirs.

    A unit alone is the quantity that has it, if only one has.
    """
    quantities, words = list(among), tuple(w for w in folded(heading) if w not in _BETWEEN)
    for name in quantities:
        if " ".join(words) in _names(name):
            usual = ALIASES[name].usual
            return Meaning(name, usual, _units(name)[usual][1] if usual else 1.0, False)
        for unit, rest in _parted(words):
            if unit in (units := _units(name)) and rest in _names(name):
                return Meaning(name, *units[unit], True)
    bare = [name for name in quantities if "".join(words) in _units(name)]
    if "position" in bare and "end" in bare:
        bare.remove("end")
    return Meaning(bare[0], *_units(bare[0])["".join(words)], True) if len(bare) == 1 else None


def unit_named(text: str, quantity: str) -> Meaning | None:
    """Meaning of a quantity whose unit stands alone, as in a row of units; None: it is none of its."""
    found = _units(quantity).get("".join(folded(text)))
    return Meaning(quantity, *found, True) if found else None


def _parted(words: tuple[str, ...]) -> list[tuple[str, str]]:
    """Words parted into a unit behind or before, and the rest."""
    behind = [("".join(words[k:]), " ".join(words[:k])) for k in range(1, len(words))]
    before = [("".join(words[:k]), " ".join(words[k:])) for k in range(1, len(words))]
    return behind + before
