"""Infrastructure of railML 2 as lines that meet, with its trains if there are any.

References
----------
https://wiki2.railml.org: the subschema ``infrastructure`` of versions 2.0 to 2.5.
"""

from collections.abc import Mapping

from tpss.importers.network import ImportedNetwork, plain_name
from tpss.importers.railml2 import ImportedTrains, names_of, trains_of
from tpss.importers.railml2_tracks import Reader
from tpss.importers.railml_file import RailmlFile, counted, system_of
from tpss.importers.supplies import mixed_systems
from tpss.importers.track_network import TrackNetwork, level_track, network_of
from tpss.importers.track_stations import POINT
from tpss.importers.ways import with_passes
from tpss.units import kilometres

SIGNALLING = {
    "signals": ("signal",),
    "balises": ("balise",),
    "train detectors": ("trainDetector", "trackCircuitBorder"),
    "level crossings": ("levelCrossing",),
}
BESIDES = {"platforms": ("platformEdge",), "tunnels": ("tunnel",), "bridges": ("bridge",)}


def network_from(file: RailmlFile) -> ImportedNetwork:
    """Lines of a file of railML 2, and its trains.

    Raises
    ------
    ScenarioError
        It has faults.
    """
    names = names_of(file.root.iter("ocp"))
    reader = Reader(file, names)
    tracks = reader.tracks()
    file.refuse_faults()
    made = network_of(tracks)
    network = ImportedNetwork(
        plain_name(file.path.name.split(".")[0]),
        (file.path,),
        f"railML {file.version}",
        made.lines,
        tracks=made.ranges,
        system=next(filter(None, _systems(reader)), ""),
        taken=made.taken(),
        left_out=_left_out(reader, made),
        assumed=_assumed(made),
    )
    if file.count("trainPart"):
        stations = {name: made.station_of((POINT, ident)) for ident, name in names.items()}
        _add_trains(network, trains_of(file, with_tracks=True), stations)
    return network


def _add_trains(
    network: ImportedNetwork, given: ImportedTrains, stations: Mapping[str, str | None]
) -> None:
    """Add the trains all of whose places are on lines that hang together."""
    known = [
        train.renamed({name: there for name, there in stations.items() if there})
        for train in given.trains
        if all(stations.get(call.station) for call in train.calls)
    ]
    found, _ = with_passes(known, network.stations)
    network.trains.extend(found)
    network.taken.append(f"trains: {len(found)}, with their times")
    lost = len(given.trains) - len(found)
    if lost:
        network.left_out.append(
            f"trains between places that the imported lines do not connect: {lost}"
        )
    network.left_out.extend(given.left_out)
    network.assumed.extend(given.assumed)


def _systems(reader: Reader) -> list[str]:
    """Systems of the electrified tracks, that of the most first; empty ones are not known."""
    return [system_of(*each) for each, _ in reader.electrified_m.most_common()]


def _left_out(reader: Reader, made: TrackNetwork) -> list[str]:
    file, counts = reader.file, reader.counts
    signalling = counted({words: file.count(*tags) for words, tags in SIGNALLING.items()})
    besides = counted({words: file.count(*tags) for words, tags in BESIDES.items()})
    systems = [
        (f"{voltage_v / 1e3:g} kV {frequency_hz:g} Hz" if voltage_v > 0.0 else "of no voltage told")
        + f" on {kilometres(length_m / 1e3)} km of track"
        for (voltage_v, frequency_hz), length_m in reader.electrified_m.items()
    ]
    empty = file.count("track") - len(reader.topology.tracks)
    told = {
        f"signalling: {signalling}": signalling,
        f"{besides}": besides,
        f"electrifications, {', '.join(systems)}: all lines have a contact line of one system": systems,
        f"speed changes of other kinds of train: {counts['profile']}": counts["profile"],
        f"speed changes below 1 km/h: {counts['slow']}": counts["slow"],
        f"tracks without a beginning and an end: {empty}": empty > 0,
        f"connections to what the file does not have: {reader.topology.broken}": (
            reader.topology.broken
        ),
        f"operational points without a place on the tracks: {', '.join(reader.lost)}": reader.lost,
    }
    mixed = mixed_systems(_systems(reader), separated=False)
    return [words for words, is_so in told.items() if is_so] + mixed + made.left_out()


def _assumed(made: TrackNetwork) -> list[str]:
    told = [*made.assumed(), *level_track(made.tracks)]
    if not made.tracks.places:
        told.append(
            "stations at switches and at ends of tracks: the file has no operational points on tracks"
        )
    return told
