"""A network of lines from the tracks of a file, and what is told of it whatever the format."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

from tpss.importers.network import NO_LIMIT_KMH, NetworkLine, stairs
from tpss.importers.neutral_sections import RAISE_S, NeutralSections, neutral_sections_of
from tpss.importers.track_chains import Layout, chains_of, joins_of
from tpss.importers.track_kilometres import has_kilometres, jumps_of
from tpss.importers.track_lines import Profiles, lines_of
from tpss.importers.track_stations import Label, Stations, find_stations, station_names
from tpss.importers.tracks import Tracks
from tpss.results.osrd_tracks import OsrdTrack
from tpss.units import kilometres

MOST_JUMPS = 10
"""Jumps of the kilometres whose places are told."""


@dataclass(frozen=True)
class TrackNetwork:
    """Lines, where the sections lie on them, and how both came about."""

    tracks: Tracks
    layout: Layout
    stations: Stations
    profiles: Profiles
    lines: list[NetworkLine]
    ranges: list[OsrdTrack]
    neutral: NeutralSections

    def station_of(self, label: Label) -> str | None:
        """Name of the station that a place became; None if it is on no line."""
        if label not in self.stations.parent:
            return None
        name = self._names[self.stations.root(label)]
        return name if name in self._on_lines else None

    @cached_property
    def _names(self) -> dict[Label, str]:
        return station_names(self.stations)

    @cached_property
    def _on_lines(self) -> set[str]:
        return {name for line in self.lines for name in line.stations}

    def taken(self) -> list[str]:
        """What was taken."""
        length_km = kilometres(round(sum(line.length_km for line in self.lines), 3))
        points = len({name for line in self.lines for name in line.stations})
        told = [
            f"track sections: {len(self.tracks.sections)}, as {len(self.lines)} lines of {length_km} km "
            "in all",
            f"stations: {points}, of {len(self.tracks.places)} operational points and the switches "
            "where lines meet",
        ]
        if self.stations.merged:
            told.append(
                f"{self.stations.merged} switches and points that are less than a metre from another, "
                "or at the other end of a track of less than 10 m, became one station with it"
            )
        if self.neutral.found:
            told.append(
                f"neutral sections: {len(self.neutral.found)}, one for both directions where those of "
                "either overlap"
            )
        return told

    def left_out(self) -> list[str]:
        """What was left out, whatever the format."""
        counts = self.profiles.counts
        jumps = self._jumps()
        told = {
            f"curves below 100 m or beyond 100 km: {counts['radius']}": counts["radius"],
            f"parts of slopes, curves and limits beyond the ends of their tracks: {counts['cut']}": (
                counts["cut"]
            ),
            f"tracks of less than 10 m, or from a switch to itself: {counts['short']}": counts[
                "short"
            ],
            f"further parts of operational points on one line: {self.stations.extra_parts}": (
                self.stations.extra_parts
            ),
            f"jumps of the kilometres: {len(jumps)}, of up to {max(jumps, default=(0.0,))[0]:g} km; "
            "beyond them positions go on from the line's beginning: "
            + ", ".join(words for _, words in jumps[:MOST_JUMPS])
            + (f" and {len(jumps) - MOST_JUMPS} more" if len(jumps) > MOST_JUMPS else ""): jumps,
            f"neutral sections where lines meet or end: {self.neutral.lost}": self.neutral.lost,
            "which ways a switch connects: at a station every line leads to every other": (
                self.tracks.joints
            ),
        }
        return [words for words, is_so in told.items() if is_so]

    def _jumps(self) -> list[tuple[float, str]]:
        """Sizes of the jumps of kilometres [km], and where they are, in both kilometres."""
        ranges = {each.track: each for each in self.ranges}
        told = []
        for jump in (jump for chain in self.layout.chains for jump in jumps_of(chain)):
            lies = ranges.get(jump.section)
            if lies is not None:
                slope = (lies.to_km - lies.from_km) / (lies.end_m - lies.begin_m)
                own_km = kilometres(lies.from_km + slope * (jump.position_m - lies.begin_m))
                words = f"{lies.line} at {own_km} km ({kilometres(jump.after_km)} km in the file)"
                told.append((jump.size_km, words))
        return told

    def assumed(self) -> list[str]:
        """What the file does not say, whatever the format."""
        told = []
        without = sum(not has_kilometres(chain) for chain in self.layout.chains)
        if without == len(self.layout.chains):
            told.append("kilometres: they count from the beginning of each line; the file has none")
        elif without:
            told.append(
                f"kilometres that count from 0, as the file has none there: on {without} of the lines"
            )
        if any(speed == NO_LIMIT_KMH for line in self.lines for _, speed in line.limits):
            told.append(
                f"{NO_LIMIT_KMH:g} km/h where no speed section applies: the trains' own highest speeds "
                "count"
            )
        middles = sum(
            name.startswith("Middle of ") for line in self.lines for name in line.stations
        )
        if middles:
            told.append(
                f"stations in the middle of {middles} parallel tracks of one length: a service names in "
                "via which of them it takes"
            )
        if any(each.raise_s for each in self.neutral.found):
            told.append(
                f"{RAISE_S:g} s until power is back behind neutral sections where pantographs are "
                "lowered"
            )
        return told


def network_of(tracks: Tracks, further: Iterable[tuple[str, float]] = ()) -> TrackNetwork:
    """Lines of all the tracks.

    Parameters
    ----------
    tracks : Tracks
    further : iterable of tuple
        Places of timetables that become stations: section and position. [m]
    """
    joins = joins_of(tracks)
    layout = Layout(chains_of(tracks, joins))
    stations = find_stations(tracks, layout, joins, further)
    profiles = Profiles(tracks, layout)
    lines, ranges = lines_of(layout, profiles, stations)
    neutral = neutral_sections_of(tracks.neutral, ranges, lines)
    return TrackNetwork(tracks, layout, stations, profiles, lines, ranges, neutral)


def level_track(tracks: Tracks) -> list[str]:
    """What is assumed where a format that tells all gradients tells none."""
    given_m = whole_m = 0.0
    for section in tracks.sections.values():
        whole_m += section.length_m
        spans = [(begin, end, 1.0) for begin, end, _ in section.gradients]
        steps = [*stairs(0.0, section.length_m, spans, 0.0, max), (section.length_m, 0.0)]
        given_m += sum((b - a) * value for (a, value), (b, _) in pairwise(steps))
    lacking_km = round((whole_m - given_m) / 1e3, 3)
    if not given_m:
        return ["level track: the file has no gradients"]
    if lacking_km > 0.0:
        return [f"level track on {kilometres(lacking_km)} km: the file has no gradients there"]
    return []
