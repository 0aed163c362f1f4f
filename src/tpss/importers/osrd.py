"""Infrastructure and train schedules of OSRD as lines that meet, and a timetable.

References
----------
https://osrd.fr: its railjson and its train schedules, which are public formats.
"""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from tpss.importers.network import ImportedNetwork, plain_name
from tpss.importers.osrd_infra import Infra, read_infra
from tpss.importers.osrd_stock import read_stock, systems_of, train_of
from tpss.importers.osrd_tracks import tracks_of
from tpss.importers.osrd_trains import (
    PathItem,
    Places,
    TrainSchedule,
    as_timetable,
    known_trains,
    left_out_of_trains,
    read_trains,
)
from tpss.importers.supplies import DEFAULT_SYSTEM, mixed_systems
from tpss.importers.track_network import TrackNetwork, network_of
from tpss.importers.track_stations import PLACE, POINT
from tpss.importers.ways import with_passes
from tpss.units import kilometres

SYSTEMS = {
    "25000V": "25kV-50Hz",
    "25kV": "25kV-50Hz",
    "15000V": "15kV-16.7Hz",
    "3000V": "DC-3kV",
    "1500V": "DC-1.5kV",
    "750V": "DC-0.75kV",
}
"""Systems of the library, by the voltages of electrifications."""


def read(
    infra_path: Path, trains_path: Path | None = None, stock_paths: Sequence[Path] = ()
) -> ImportedNetwork:
    """Lines, trains if there is a file of them, and what these are, of files of rolling stock.

    Raises
    ------
    ScenarioError
        The files cannot be read, or have faults; all of a file are listed.
    """
    infra = read_infra(infra_path)
    given = read_trains(trains_path) if trains_path else []
    places = Places(infra)
    trains = known_trains(given, places)
    on_tracks = [
        spot
        for train in trains
        for item in train.path
        if places.point(item) is None and (spot := places.on_track(item)) is not None
    ]
    made = network_of(tracks_of(infra), on_tracks)
    network = ImportedNetwork(
        plain_name(infra_path.stem if infra_path.stem != "infra" else infra_path.parent.name),
        (infra_path, *([trains_path] if trains_path else [])),
        "OSRD",
        made.lines,
        tracks=made.ranges,
        neutral_sections=made.neutral.found,
        system=_system(infra),
        taken=made.taken(),
        left_out=_left_out(infra, made),
        assumed=made.assumed(),
    )
    _add_trains(network, trains, places, made)
    _add_stock(network, stock_paths)
    if given:
        network.left_out.extend(left_out_of_trains(given, places))
    return network


def _add_trains(
    network: ImportedNetwork, trains: list[TrainSchedule], places: Places, made: TrackNetwork
) -> None:
    def station_of(item: PathItem) -> str | None:
        point, spot = places.point(item), places.on_track(item)
        if point is not None:
            return made.station_of((POINT, point.id))
        if spot is not None:
            return made.station_of((PLACE, f"{spot[0]} at {spot[1] / 1e3:.3f} km"))
        return None

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


def _add_stock(network: ImportedNetwork, paths: Sequence[Path]) -> None:
    """Trains of files of rolling stock, as they are under the network's system."""
    system = network.system or DEFAULT_SYSTEM
    for name, (stock, path) in read_stock(paths).items():
        curves = systems_of(stock, SYSTEMS)
        if system not in curves:
            modes = ", ".join(stock.effort_curves.modes)
            network.left_out.append(f"{name} of {path.name}, a train for {modes}, not for {system}")
            continue
        table = train_of(stock, curves, system)
        network.stock[plain_name(name, "train")] = {"source": f"OSRD, {path.name}", **table}
        network.taken.append(f"{name} of {path.name}: effort curves for {', '.join(curves)}")
    if network.stock:
        network.assumed.append(
            "of rolling stock: all of its mass on driven axles, an efficiency of 0.85 and auxiliaries "
            "of 100 kW"
        )


def _electrified_m(infra: Infra) -> Counter[str]:
    """Lengths of track by the voltages of their contact lines. [m]"""
    lengths_m: Counter[str] = Counter()
    for each in infra.electrifications:
        lengths_m[each.voltage] += round(sum(part.end - part.begin for part in each.track_ranges))
    return lengths_m


def _system(infra: Infra) -> str:
    """The system of the library that most of the electrified tracks have."""
    return next(iter(_systems(infra)), "")


def _systems(infra: Infra) -> list[str]:
    """Systems of the library that electrified tracks have, that of the most first."""
    voltages = [voltage for voltage, _ in _electrified_m(infra).most_common()]
    return [SYSTEMS[each] for each in voltages if each in SYSTEMS]


def _left_out(infra: Infra, made: TrackNetwork) -> list[str]:
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
    ranges = made.profiles.counts
    announced = sum(bool(each.announcement_track_ranges) for each in infra.neutral_sections)
    told = {
        f"signalling: {', '.join(counts)}": bool(counts),
        f"announcements of neutral sections: {announced}; trains switch off where the sections begin": (
            announced
        ),
        f"electrifications, {', '.join(voltages)}: all lines have a contact line of one system": bool(
            voltages
        ),
        f"speed sections of single routes: {ranges['route']}": ranges["route"],
        f"speed sections of single kinds of train: {ranges['tag']}": ranges["tag"],
        f"speed sections below 1 km/h: {ranges['slow']}": ranges["slow"],
        "limits by kind of train, beside those of all trains": any(
            each.speed_limit_by_tag for each in infra.speed_sections if each.speed_limit
        ),
    }
    mixed = mixed_systems(_systems(infra), bool(made.neutral.found))
    return [words for words, is_so in told.items() if is_so] + mixed + made.left_out()
