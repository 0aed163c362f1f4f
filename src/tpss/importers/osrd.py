"""Infrastructure and train schedules of OSRD as lines that meet, and a timetable.

References
----------
https://osrd.fr: its railjson and its train schedules, which are public formats.
"""

from collections import Counter
from pathlib import Path

from tpss.importers.network import NO_LIMIT_KMH, ImportedNetwork, NetworkLine, plain_name
from tpss.importers.osrd_chains import Layout, chains_of, joins_of
from tpss.importers.osrd_infra import Infra, read_infra
from tpss.importers.osrd_lines import Profiles, lines_of
from tpss.importers.osrd_stations import PLACE, POINT, Stations, find_stations, station_names
from tpss.importers.osrd_trains import (
    PathItem,
    Places,
    TrainSchedule,
    as_timetable,
    known_trains,
    left_out_of_trains,
    read_trains,
)
from tpss.importers.ways import with_passes
from tpss.units import kilometres

SYSTEMS = {"25000V": "25kV-50Hz", "25kV": "25kV-50Hz", "15000V": "15kV-16.7Hz"}
"""Systems of the library, by the voltages of electrifications."""


def read(infra_path: Path, trains_path: Path | None = None) -> ImportedNetwork:
    """Lines, and trains if there is a file of them.

    Raises
    ------
    ScenarioError
        The files cannot be read, or have faults; all of a file are listed.
    """
    infra = read_infra(infra_path)
    given = read_trains(trains_path) if trains_path else []
    places = Places(infra)
    trains = known_trains(given, places)
    joins = joins_of(infra)
    layout = Layout(chains_of(infra, joins))
    on_tracks = [
        spot
        for train in trains
        for item in train.path
        if places.point(item) is None and (spot := places.on_track(item)) is not None
    ]
    stations = find_stations(infra, layout, joins, on_tracks)
    profiles = Profiles(infra, layout)
    lines, tracks = lines_of(layout, profiles, stations)
    network = ImportedNetwork(
        plain_name(infra_path.stem if infra_path.stem != "infra" else infra_path.parent.name),
        (infra_path, *([trains_path] if trains_path else [])),
        "OSRD",
        lines,
        tracks=tracks,
        system=_system(infra),
        taken=_taken(infra, lines, stations),
        left_out=_left_out(infra, profiles, stations),
        assumed=_assumed(lines),
    )
    _add_trains(network, trains, places, stations)
    if given:
        network.left_out.extend(left_out_of_trains(given, places))
    return network


def _add_trains(
    network: ImportedNetwork, trains: list[TrainSchedule], places: Places, stations: Stations
) -> None:
    names = station_names(stations)
    on_lines = {name for line in network.lines for name in line.stations}

    def station_of(item: PathItem) -> str | None:
        point, spot = places.point(item), places.on_track(item)
        if point is not None:
            label = (POINT, point.id)
        elif spot is not None:
            label = (PLACE, f"{spot[0]} at {spot[1] / 1e3:.3f} km")
        else:
            return None
        name = names[stations.root(label)] if label in stations.parent else None
        return name if name in on_lines else None

    timetable = as_timetable(trains, station_of)
    found, lost = with_passes(timetable, network.stations)
    network.trains.extend(found)
    if found:
        network.taken.append(f"trains: {len(found)}, with their times")
    short = len(trains) - len(timetable)
    if short or lost:
        network.left_out.append(
            f"trains between places that the imported lines do not connect: {short + lost}"
        )


def _electrified_m(infra: Infra) -> Counter[str]:
    """Lengths of track by the voltages of their contact lines. [m]"""
    lengths_m: Counter[str] = Counter()
    for each in infra.electrifications:
        lengths_m[each.voltage] += round(sum(part.end - part.begin for part in each.track_ranges))
    return lengths_m


def _system(infra: Infra) -> str:
    """The system of the library that most of the electrified tracks have."""
    voltages = [voltage for voltage, _ in _electrified_m(infra).most_common()]
    return next((SYSTEMS[each] for each in voltages if each in SYSTEMS), "")


def _taken(infra: Infra, lines: list[NetworkLine], stations: Stations) -> list[str]:
    length_km = kilometres(round(sum(line.length_km for line in lines), 3))
    points = len({name for line in lines for name in line.stations})
    told = [
        f"track sections: {len(infra.track_sections)}, as {len(lines)} lines of {length_km} km in all",
        f"stations: {points}, of {len(infra.operational_points)} operational points and the switches "
        "where lines meet",
    ]
    if stations.merged:
        told.append(
            f"{stations.merged} switches and points that are less than a metre from another, or at the "
            "other end of a track of less than 10 m, became one station with it"
        )
    return told


def _left_out(infra: Infra, profiles: Profiles, stations: Stations) -> list[str]:
    signalling = {
        "signals": infra.signals,
        "routes": infra.routes,
        "detectors": infra.detectors,
        "buffer stops": infra.buffer_stops,
    }
    counts = [f"{len(those)} {name}" for name, those in signalling.items() if those]
    voltages = [
        f"{voltage} on {kilometres(length_m / 1e3)} km of track"
        for voltage, length_m in _electrified_m(infra).items()
    ]
    ranges = profiles.counts
    told = {
        f"signalling: {', '.join(counts)}": bool(counts),
        f"neutral sections: {len(infra.neutral_sections)}": bool(infra.neutral_sections),
        f"electrifications, {', '.join(voltages)}: all lines have a contact line of one system": bool(
            voltages
        ),
        f"speed sections of single routes: {ranges['route']}": ranges["route"],
        f"speed sections of single kinds of train: {ranges['tag']}": ranges["tag"],
        f"speed sections below 1 km/h: {ranges['slow']}": ranges["slow"],
        "limits by kind of train, beside those of all trains": any(
            each.speed_limit_by_tag for each in infra.speed_sections if each.speed_limit
        ),
        f"curves below 100 m or beyond 100 km: {ranges['radius']}": ranges["radius"],
        f"parts of slopes, curves and limits beyond the ends of their tracks: {ranges['cut']}": ranges[
            "cut"
        ],
        f"tracks of less than 10 m, or from a switch to itself: {ranges['short']}": ranges["short"],
        f"further parts of operational points on one line: {stations.extra_parts}": (
            stations.extra_parts
        ),
        "which ways a switch connects: at a station every line leads to every other": bool(
            infra.switches
        ),
    }
    return [words for words, is_so in told.items() if is_so]


def _assumed(lines: list[NetworkLine]) -> list[str]:
    told = ["kilometres: they count from the beginning of each line; the file has none"]
    if any(speed == NO_LIMIT_KMH for line in lines for _, speed in line.limits):
        told.append(
            f"{NO_LIMIT_KMH:g} km/h where no speed section applies: the trains' own highest speeds count"
        )
    middles = sum(name.startswith("Middle of ") for line in lines for name in line.stations)
    if middles:
        told.append(
            f"stations in the middle of {middles} parallel tracks of one length: a service names in via "
            "which of them it takes"
        )
    return told
