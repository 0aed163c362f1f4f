"""Stations of the lines that are made of tracks: places with names, and where lines meet.

A switch at which chains of track sections meet is a station of all of them, so that trains may change
from one to another.  What is closer together than stations may be is one station.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise

from tpss.importers.network import own_name
from tpss.importers.track_chains import Layout, Spot
from tpss.importers.tracks import End, Place, Tracks

CLOSEST_M = 1.0
"""Stations that are closer are one. [m]"""

SHORTEST_M = 10.0
"""No line is shorter: the ends of a shorter chain are one station. [m]"""

Label = tuple[int, str]
"""What a station is made of: its rank, lower ones give the name, and its own name or id."""

POINT, SWITCH, PLACE, END = range(4)
"""Ranks: places with names, switches, places of timetables, ends of tracks."""


@dataclass
class Stations:
    """Names of stations by chain, with their places, and what was made of them."""

    marks: dict[int, list[tuple[float, Label]]] = field(default_factory=dict)
    names: dict[Label, str] = field(default_factory=dict)
    parent: dict[Label, Label] = field(default_factory=dict)
    merged: int = 0
    """Places that became one with others."""
    extra_parts: int = 0
    """Further parts of places on one chain, which were left out."""

    def add(self, spot: Spot, label: Label, wanted: str) -> None:
        """Note a station at a place."""
        self.parent.setdefault(label, label)
        self.names.setdefault(label, " ".join(wanted.split()) or label[1])
        here = self.marks.setdefault(spot.chain, [])
        if (spot.place_m, label) not in here:
            here.append((spot.place_m, label))

    def root(self, label: Label) -> Label:
        """What a station was made one with."""
        while self.parent[label] != label:
            self.parent[label] = label = self.parent[self.parent[label]]
        return label

    def unite(self, labels: Iterable[Label]) -> None:
        """Make stations one; that of the lowest rank gives the name."""
        first, *others = sorted({self.root(label) for label in labels})
        for other in others:
            self.parent[other] = first
            self.merged += 1

    def at(self, chain: int) -> list[tuple[float, Label]]:
        """Stations of a chain in order, each of what was made one only once at a place."""
        found: list[tuple[float, Label]] = []
        for place_m, label in sorted(self.marks.get(chain, [])):
            root = self.root(label)
            near = bool(found) and found[-1][1] == root and place_m - found[-1][0] < CLOSEST_M
            if not near:
                found.append((place_m, root))
        return found


def find_stations(
    tracks: Tracks,
    layout: Layout,
    joins: Mapping[End, End],
    further: Iterable[tuple[str, float]] = (),
) -> Stations:
    """Stations of all the chains.

    Parameters
    ----------
    tracks : Tracks
    layout : Layout
    joins : mapping
        Ends that follow each other in a chain.
    further : iterable of tuple
        Further places, of timetables: track section and position. [m]
    """
    stations = Stations()
    for place in tracks.places:
        _add_place(stations, layout, place)
    for joint in tracks.joints:
        if any(joins.get(a) != b for a, b in joint.pairs):
            for end in {end for pair in joint.pairs for end in pair}:
                stations.add(layout.end(end), (SWITCH, joint.id), joint.name)
    for track, position_m in further:
        wanted = f"{track} at {position_m / 1e3:.3f} km"
        stations.add(layout.spot(track, position_m), (PLACE, wanted), wanted)
    for i, chain in enumerate(layout.chains):
        if (chain[0].section.id, "BEGIN" if chain[0].sign > 0 else "END") in joins:
            _close(stations, layout, i)
    _unite_close_ones(stations, layout)
    for i in range(len(layout.chains)):
        _add_ends(stations, layout, i, everywhere=not tracks.places)
    return stations


def _add_place(stations: Stations, layout: Layout, place: Place) -> None:
    """A place with a name: one station on each chain that it has parts on."""
    spots = sorted(layout.spot(*part) for part in place.parts)
    for i, spot in enumerate(spots):
        if i and spots[i - 1].chain == spot.chain:
            stations.extra_parts += 1
        else:
            stations.add(spot, (POINT, place.id), place.name)


def _close(stations: Stations, layout: Layout, chain: int) -> None:
    """The station where a chain that runs into itself begins and ends."""
    track = layout.chains[chain][0].section.id
    for place_m in (0.0, layout.length_m(chain)):
        stations.add(Spot(chain, place_m), (END, track), f"Begin of {track}")


def _add_ends(stations: Stations, layout: Layout, chain: int, everywhere: bool) -> None:
    """Stations at the ends of a chain, where there is none, if it has fewer than two or everywhere."""
    marks, length_m = stations.at(chain), layout.length_m(chain)
    enough = len({label for _, label in marks}) >= 2 and not everywhere
    if length_m < SHORTEST_M or enough:
        return
    links = layout.chains[chain]
    for place_m, word, link in ((0.0, "Begin", links[0]), (length_m, "End", links[-1])):
        if all(abs(place_m - each) >= CLOSEST_M for each, _ in marks):
            name = f"{word} of {link.section.id}"
            stations.add(Spot(chain, place_m), (END, name), name)


def _unite_close_ones(stations: Stations, layout: Layout) -> None:
    for chain, marks in stations.marks.items():
        marks.sort()
        if layout.length_m(chain) < SHORTEST_M:
            stations.unite(label for _, label in marks)
            continue
        for (before_m, one), (after_m, other) in pairwise(marks):
            if after_m - before_m < CLOSEST_M and stations.root(one) != stations.root(other):
                stations.unite((one, other))


def station_names(stations: Stations) -> dict[Label, str]:
    """Names of the stations, each only once, those of places with names first."""
    names: dict[Label, str] = {}
    taken: set[str] = set()
    for label in sorted(stations.names):
        root = stations.root(label)
        if root not in names:
            names[root] = own_name(stations.names[root], taken)
            taken.add(names[root])
    return names
