"""Infrastructure of railML 3 as lines that meet.

References
----------
https://wiki3.railml.org: the subschemas ``common`` and ``infrastructure`` of versions 3.1 to 3.3.
"""

from collections import Counter

from tpss.errors import Finding, ScenarioError
from tpss.importers.network import ImportedNetwork, plain_name
from tpss.importers.railml3_tracks import Reader
from tpss.importers.railml_file import RailmlFile, counted, system_of
from tpss.importers.supplies import mixed_systems
from tpss.importers.track_network import TrackNetwork, level_track, network_of
from tpss.units import kilometres

EMPTY = "export the infrastructure with its topology (netElements, netRelations)"

SIGNALLING = {
    "signals": ("signalIS", "signal"),
    "balises": ("balise",),
    "train detection elements": ("trainDetectionElement",),
    "level crossings": ("levelCrossingIS", "levelCrossing"),
    "routes": ("route",),
}
"""Elements of signalling by their names in different versions."""

BESIDES = {
    "platforms": ("platform", "platformEdge"),
    "buffer stops": ("bufferStop",),
    "loading gauges": ("loadingGauge",),
    "bridges and tunnels": ("overCrossing", "underCrossing"),
}


def network_from(file: RailmlFile) -> ImportedNetwork:
    """Lines of a file of railML 3.

    Raises
    ------
    ScenarioError
        There are no net elements in it, or it has faults.
    """
    if not file.count("netElement"):
        problem = "the infrastructure is empty: there is no netElement"
        raise ScenarioError([Finding(str(file.path), "topology, netElements", "", problem, EMPTY)])
    reader = Reader(file)
    tracks = reader.tracks()
    electrified_m = _electrified_m(reader)
    file.refuse_faults()
    made = network_of(tracks)
    return ImportedNetwork(
        plain_name(file.path.stem),
        (file.path,),
        f"railML {file.version}",
        made.lines,
        tracks=made.ranges,
        neutral_sections=made.neutral.found,
        system=next(filter(None, _systems(electrified_m)), ""),
        taken=made.taken(),
        left_out=_left_out(reader, made, electrified_m),
        assumed=_assumed(reader, made),
    )


def _systems(electrified_m: Counter[tuple[float, float]]) -> list[str]:
    """Systems of the electrified tracks, that of the most first; empty ones are not known."""
    return [system_of(*each) for each, _ in electrified_m.most_common()]


def _electrified_m(reader: Reader) -> Counter[tuple[float, float]]:
    """Lengths of track by the voltage [V] and the frequency [Hz] of their contact lines. [m]"""
    file = reader.file
    systems = {
        each.get("id", ""): (
            file.number(each, "voltage") or 0.0,
            file.number(each, "frequency") or 0.0,
        )
        for each in file.root.iter("electrificationSystem")
    }
    lengths_m: Counter[tuple[float, float]] = Counter()
    for section in file.root.iter("electrificationSection"):
        refs = [each.get("ref", "") for each in section.iter("electrificationSystemRef")]
        system = next((systems[ref] for ref in refs if ref in systems), None)
        if system is not None:
            for span in reader.places.spans(section):
                lengths_m[system] += round(span.end_m - span.begin_m)
    return lengths_m


def _left_out(
    reader: Reader, made: TrackNetwork, electrified_m: Counter[tuple[float, float]]
) -> list[str]:
    file, counts = reader.file, reader.counts
    signalling = counted({words: file.count(*tags) for words, tags in SIGNALLING.items()})
    besides = counted({words: file.count(*tags) for words, tags in BESIDES.items()})
    systems = [
        f"{voltage_v / 1e3:g} kV {frequency_hz:g} Hz on {kilometres(length_m / 1e3)} km of track"
        for (voltage_v, frequency_hz), length_m in electrified_m.items()
    ]
    sections = file.count("electrificationSection")
    lost = ", ".join(reader.lost)
    told = {
        f"signalling: {signalling}": signalling,
        f"{besides}": besides,
        f"electrification sections: {sections}"
        + (f", {', '.join(systems)}" if systems else "")
        + ": all lines have a contact line of one system": sections,
        f"neutral sections without a place of their own: {counts['neutral']}": counts["neutral"],
        f"temporary speed sections: {counts['temporary']}": counts["temporary"],
        f"speed sections of single kinds of train: {counts['profile']}": counts["profile"],
        f"speed sections below 1 km/h: {counts['slow']}": counts["slow"],
        f"vertical curves without a gradient beside them: {counts['arc']}": counts["arc"],
        f"operational points without a place on the tracks: {lost}": reader.lost,
        f"directions of {reader.topology.one_way} relations that lead one way only": (
            reader.topology.one_way
        ),
        "the timetable: trains are read from railML 2 only": file.count("timetable"),
    }
    mixed = mixed_systems(_systems(electrified_m), bool(made.neutral.found))
    return [words for words, is_so in told.items() if is_so] + mixed + made.left_out()


def _assumed(reader: Reader, made: TrackNetwork) -> list[str]:
    told = [*made.assumed(), *level_track(made.tracks)]
    if reader.topology.shared:
        told.append(
            f"lengths of {reader.topology.shared} sections: shares of their track's length, as they are "
            "drawn"
        )
    if reader.places.whole:
        told.append(
            f"{reader.places.whole} stretches apply to whole tracks: they are told by kilometres, which "
            "these tracks have none of"
        )
    if not reader.file.count("operationalPoint"):
        told.append(
            "stations at switches and at ends of tracks: the file has no operational points"
        )
    return told
