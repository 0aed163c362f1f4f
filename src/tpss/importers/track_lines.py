"""Lines from chains of track sections: their gradients, curves, limits and stations."""

from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from tpss.importers.network import (
    NO_LIMIT_KMH,
    NetworkLine,
    Range,
    own_name,
    plain_name,
    stairs,
)
from tpss.importers.quantities import DIGITS
from tpss.importers.track_chains import Chain, Layout, Link
from tpss.importers.track_kilometres import kilometre_at
from tpss.importers.track_stations import SHORTEST_M, Stations, station_names
from tpss.importers.tracks import Tracks
from tpss.results.osrd_tracks import OsrdTrack
from tpss.scenario.routes import EQUAL_KM

RADII_M = (100.0, 100_000.0)
LEAST_LIMIT_KMH = 1.0
"""What a scenario accepts."""

Mark = tuple[float, str]
"""Position of a station in a chain [m], and its name."""


class Profiles:
    """What applies along chains, in their kilometres, and what of it was left out."""

    def __init__(self, tracks: Tracks, layout: Layout) -> None:
        self.counts: Counter[str] = Counter(tracks.counts)
        """Ranges by why they were left out."""
        self.gradients: dict[int, list[Range]] = defaultdict(list)
        self.curves: dict[int, list[Range]] = defaultdict(list)
        self.limits: dict[tuple[int, int], list[Range]] = defaultdict(list)
        """By chain, and 1 for trains towards its end, -1 towards its beginning."""
        for i, chain in enumerate(layout.chains):
            for link in chain:
                self._add_slopes_and_curves(i, link)
        self._add_limits(tracks, layout)

    def _range(self, link: Link, begin_m: float, end_m: float, value: float) -> Range:
        """A range of a section in its chain; what lies beyond the section is cut off, and counted."""
        low, high = max(begin_m, 0.0), min(end_m, link.section.length_m)
        if (low, high) != (begin_m, end_m):
            self.counts["cut"] += 1
        ends = sorted(round(link.place_m(each) / 1e3, DIGITS) for each in (low, max(high, low)))
        return ends[0], ends[1], value

    def _add_slopes_and_curves(self, chain: int, link: Link) -> None:
        for begin_m, end_m, gradient in link.section.gradients:
            self.gradients[chain].append(self._range(link, begin_m, end_m, gradient * link.sign))
        for begin_m, end_m, radius in link.section.curves:
            radius_m = abs(radius)
            if RADII_M[0] <= radius_m <= RADII_M[1]:
                self.curves[chain].append(self._range(link, begin_m, end_m, radius_m))
            elif radius_m:
                self.counts["radius"] += 1

    def _add_limits(self, tracks: Tracks, layout: Layout) -> None:
        for limit in tracks.limits:
            chain, link = layout.link(limit.section)
            part = self._range(link, limit.begin_m, limit.end_m, limit.speed_kmh)
            for sign in limit.signs:
                self.limits[chain, sign * link.sign].append(part)


def lines_of(
    layout: Layout, profiles: Profiles, stations: Stations
) -> tuple[list[NetworkLine], list[OsrdTrack]]:
    """Lines of all chains, and where the track sections are on them.

    A chain is cut where it comes to a station for the second time.
    """
    names = station_names(stations)
    taken = set(names.values())
    lines: list[NetworkLine] = []
    tracks: list[OsrdTrack] = []
    for i, chain in enumerate(layout.chains):
        if layout.length_m(i) < SHORTEST_M:
            continue
        marks = [(place_m, names[label]) for place_m, label in stations.at(i)]
        for begin_m, end_m, places in _pieces(marks, layout.length_m(i), taken):
            if len(places) < 2 or end_m - begin_m < SHORTEST_M:
                profiles.counts["short"] += 1
                continue
            name = own_name(_wanted_name(chain), [line.name for line in lines])
            begins_at_km = kilometre_at(chain, begin_m)
            line = _line(name, i, (begin_m, end_m), places, profiles)
            lines.append(replace(line, begins_at_km=begins_at_km))
            tracks += _track_ranges(name, chain, (begin_m, end_m), begins_at_km)
    return _told_apart(lines), tracks


def _wanted_name(chain: Chain) -> str:
    return plain_name(max((link.section for link in chain), key=lambda each: each.length_m).name)


def _pieces(
    marks: Sequence[Mark], length_m: float, taken: set[str]
) -> list[tuple[float, float, dict[str, float]]]:
    """Beginning, end and stations of the pieces of a chain on which each station is only once."""
    pieces = []
    begin_m, here = 0.0, dict[str, float]()
    for place_m, name in marks:
        if name in here:
            last, last_m = list(here.items())[-1]
            if last == name and place_m - last_m < 2.0 * SHORTEST_M:
                continue
            if last == name:
                last, last_m = own_name(f"Loop at {name}", taken), (last_m + place_m) / 2.0
                taken.add(last)
                here[last] = last_m
            pieces.append((begin_m, last_m, here))
            begin_m, here = last_m, {last: last_m}
        here[name] = place_m
    return [*pieces, (begin_m, length_m, here)]


def _line(
    name: str, chain: int, ends_m: tuple[float, float], places: dict[str, float], profiles: Profiles
) -> NetworkLine:
    begin_km, end_km = (round(each / 1e3, DIGITS) for each in ends_m)
    limits, down = (
        stairs(begin_km, end_km, profiles.limits[chain, sign], NO_LIMIT_KMH, min)
        for sign in (1, -1)
    )
    radii = stairs(begin_km, end_km, profiles.curves[chain], 0.0, min)
    length_km = round(end_km - begin_km, DIGITS)
    curve_ends = [*(km for km, _ in radii[1:]), length_km]
    return NetworkLine(
        name,
        length_km,
        {each: round(place_m / 1e3 - begin_km, DIGITS) for each, place_m in places.items()},
        stairs(begin_km, end_km, profiles.gradients[chain], 0.0, lambda values: values[0]),
        limits,
        down if down != limits else [],
        [(a, b, radius) for (a, radius), b in zip(radii, curve_ends, strict=True) if radius],
    )


def _track_ranges(
    name: str, chain: Chain, ends_m: tuple[float, float], begins_at_km: float
) -> list[OsrdTrack]:
    ranges = []
    begin_m, end_m = ends_m
    for link in chain:
        low, high = max(link.start_m, begin_m), min(link.end_m, end_m)
        if high > low:
            zero_m = link.place_m(0.0)
            from_km, to_km = (
                round(begins_at_km + (each - begin_m) / 1e3, DIGITS) for each in (low, high)
            )
            on_track = (round(abs(each - zero_m), 6) for each in (low, high))
            ranges.append(OsrdTrack(name, from_km, to_km, link.section.id, *on_track))
    return ranges


def _told_apart(lines: list[NetworkLine]) -> list[NetworkLine]:
    """Lines with a station in the middle of each hop that is as long as another between its stations.

    A service can then name the one that it takes.
    """
    hops: dict[tuple[str, ...], list[tuple[float, int, str]]] = defaultdict(list)
    for i, line in enumerate(lines):
        for (one, a_km), (other, b_km) in pairwise(line.stations.items()):
            hops[tuple(sorted((one, other)))].append((b_km - a_km, i, one))
    for alike in hops.values():
        for length_km, i, one in alike:
            others = [km for km, k, _ in alike if k != i and abs(km - length_km) <= EQUAL_KM]
            if others and length_km >= 2e-3 * SHORTEST_M:
                places = lines[i].stations
                middle = {f"Middle of {lines[i].name}, from {one}": places[one] + length_km / 2.0}
                ordered = sorted({**places, **middle}.items(), key=lambda item: item[1])
                rounded = {name: round(km, DIGITS) for name, km in ordered}
                lines[i] = replace(lines[i], stations=rounded)
    return lines
