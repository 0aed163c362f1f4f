"""Places where ends of tracks meet, from the ways between pairs of them."""

from collections.abc import Iterable
from dataclasses import dataclass

from tpss.importers.tracks import End, Joint


@dataclass(frozen=True)
class Way:
    """Two ends that meet."""

    id: str
    ends: tuple[End, End]
    name: str = ""
    """Name of the switch, if it is one."""
    rank: tuple[int, ...] = ()
    """Ways of lower ranks come first: of them chains are made."""
    is_open: bool = True
    """Whether trains may go from one to the other; else the ends only lie at one place."""


def joints_of(ways: Iterable[Way]) -> tuple[Joint, ...]:
    """Places where ends meet over each other, those of the first ways first."""
    places: list[tuple[set[End], list[Way]]] = []
    for way in ways:
        ends, here = set(way.ends), [way]
        apart = []
        for place in places:
            if place[0] & ends:
                ends |= place[0]
                here = [*place[1], *here]
            else:
                apart.append(place)
        places = [*apart, (ends, here)]
    joints = []
    for ends, here in places:
        usable = sorted((way for way in here if way.is_open), key=lambda way: way.rank)
        if usable:
            named = next((way for way in here if way.name), usable[0])
            name = named.name or named.id
            pairs = tuple(way.ends for way in usable)
            joints.append(Joint(usable[0].id, name, pairs, len(ends) == 2))
    return tuple(joints)
