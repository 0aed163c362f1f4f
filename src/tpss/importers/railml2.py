"""Trains of railML 2 as rows of a timetable.

References
----------
https://wiki2.railml.org: the elements ``trainPart``, ``ocpTT``, ``times`` and ``train``.
"""

import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from xml.etree.ElementTree import Element

from tpss.errors import Finding, ScenarioError
from tpss.importers.network import own_name, plain_name
from tpss.importers.railml_file import RailmlFile
from tpss.importers.timetable import DAY_S, Call, Train, ends_told, seconds_of
from tpss.importers.xml_tree import REMEDY

SCOPES = ("scheduled", "published", "calculated", "expected", "actual")
"""Scopes of times, those that are preferred first."""

_CLOCK = re.compile(r"(\d{1,2}):(\d{2})(?::(\d{2})(?:\.\d+)?)?Z?")


@dataclass(frozen=True)
class ImportedTrains:
    """Trains of a file, and how it was used."""

    source: Path
    trains: list[Train]
    taken: list[str] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    assumed: list[str] = field(default_factory=list)


def trains_of(file: RailmlFile, with_tracks: bool = False) -> ImportedTrains:
    """Trains of a file of railML 2.

    Parameters
    ----------
    file : RailmlFile
    with_tracks : bool
        Whether the tracks of the file are imported as well.

    Raises
    ------
    ScenarioError
        There are none, or it has faults.
    """
    path = file.path
    reader = _Reader(path, file.root)
    trains = reader.trains()
    if not trains:
        problem = "there is no train with two places in it"
        raise ScenarioError([Finding(str(path), "timetable", "", problem, REMEDY)])
    stations = {call.station for train in trains for call in train.calls}
    return ImportedTrains(
        path,
        trains,
        [f"trains: {len(trains)}", f"their stations: {', '.join(sorted(stations))}"],
        reader.left_out(with_tracks),
        ["all trains run on the same day: operating periods are not read"],
    )


class _Reader:
    """The elements of a document by their ids."""

    def __init__(self, path: Path, root: Element) -> None:
        self.path = path
        self.root = root
        self.findings: list[Finding] = []
        self.stations = names_of(root.iter("ocp"))
        self.formations = names_of(root.iter("formation"))
        self.parts = {part.get("id", ""): part for part in root.iter("trainPart")}
        self.coupled = 0
        """Parts of trains that run coupled to others."""
        self.shortened, self.untimed = 0, 0
        """Trains that begin behind the first of their places, and trains without any time."""
        self.scopes: Counter[str] = Counter()

    def trains(self) -> list[Train]:
        """Operational trains, else those of any type, else single parts, each of a name of its own."""
        found: list[Train] = []
        for name, parts in self._named_parts():
            calls = self._from_first_time(self._calls(parts))
            if len(calls) >= 2:
                formation = next(
                    (each.get("formationRef", "") for each in parts[0].iter("formationTT")), ""
                )
                kind = plain_name(self.formations.get(formation, formation), "train")
                taken = [train.name for train in found]
                found.append(Train(own_name(name, taken), kind, ends_told(calls)))
        if self.findings:
            raise ScenarioError(self.findings)
        return found

    def left_out(self, with_tracks: bool) -> list[str]:
        """What was left out, with counts."""
        tracks = "tracks of the infrastructure: write the lines, with stations of these names"
        counts = {
            **({} if with_tracks else {tracks: "track"}),
            "vehicles": "vehicle",
            "reserves of running times": "runTimes",
            "operating periods": "operatingPeriod",
            "circulations of vehicles": "circulation",
        }
        told = [
            f"{words}: {number}"
            for words, tag in counts.items()
            if (number := sum(1 for _ in self.root.iter(tag)))
        ]
        if self.coupled:
            told.append(f"parts of trains that run coupled to others: {self.coupled}")
        if self.shortened:
            told.append(
                f"places before the first time of a train, where it begins: of {self.shortened} of the "
                "trains"
            )
        if self.untimed:
            told.append(f"trains without any time: {self.untimed}")
        unused = {scope: n for scope, n in self.scopes.items() if n}
        return told + [f"times of scope {scope}: {number}" for scope, number in unused.items()]

    def _named_parts(self) -> list[tuple[str, list[Element]]]:
        every = list(self.root.iter("train"))
        trains = [train for train in every if train.get("type") == "operational"] or every
        if not trains:
            return [(_name(part), [part]) for part in self.parts.values()]
        named = []
        for train in trains:
            parts = []
            for sequence in sorted(train.iter("trainPartSequence"), key=_sequence):
                references = sorted(sequence.iter("trainPartRef"), key=_position)
                self.coupled += len(references[1:])
                parts += [each for each in map(self._part, references[:1]) if each is not None]
            if parts:
                named.append((_name(train), parts))
        return named

    def _part(self, reference: Element) -> Element | None:
        ident = reference.get("ref", "")
        if ident not in self.parts:
            self._blame(f"trainPartRef {ident}", ident, "there is no such trainPart")
        return self.parts.get(ident)

    def _calls(self, parts: Iterable[Element]) -> list[Call]:
        calls: list[Call] = []
        last_s = 0.0
        for part in parts:
            for place in sorted(part.iter("ocpTT"), key=_sequence):
                call = self._call(place, part.get("id", ""), last_s)
                times = [time for time in (call.arrival_s, call.departure_s) if time is not None]
                last_s = max([last_s, *times])
                if calls and calls[-1].station == call.station:
                    call = _joined(calls.pop(), call)
                calls.append(call)
        return calls

    def _from_first_time(self, calls: list[Call]) -> list[Call]:
        """Calls from the first one with a time on, where the train departs; none without any time."""
        if not calls:
            return []
        times = (each.arrival_s if each.departure_s is None else each.departure_s for each in calls)
        found = next(((i, time) for i, time in enumerate(times) if time is not None), None)
        if found is None:
            self.untimed += 1
            return []
        first, departure_s = found  # a place that is passed has its time as that of arrival
        self.shortened += first > 0
        return [replace(calls[first], departure_s=departure_s), *calls[first + 1 :]]

    def _call(self, place: Element, part: str, after_s: float) -> Call:
        ident = place.get("ocpRef", "")
        if ident not in self.stations:
            self._blame(f"trainPart {part}, ocpTT", ident, "there is no such ocp")
        times = {each.get("scope", SCOPES[0]): each for each in place.iter("times")}
        chosen = next((scope for scope in SCOPES if scope in times), None)
        self.scopes.update(scope for scope in times if scope != chosen)
        given = times[chosen] if chosen else Element("times")
        arrival_s = self._time(given, "arrival", part, after_s)
        departure_s = self._time(given, "departure", part, max(after_s, arrival_s or 0.0))
        dwell_s = self._dwell(place, part)
        if place.get("ocpType") == "pass":
            return Call(self.stations.get(ident, ident), "pass", arrival_s or departure_s)
        return Call(self.stations.get(ident, ident), "stop", arrival_s, departure_s, dwell_s)

    def _time(self, times: Element, key: str, part: str, after_s: float) -> float | None:
        """A time after midnight; on the next day if it is before the last one, or if told so. [s]"""
        text = times.get(key)
        if text is None:
            return None
        match, day = _CLOCK.fullmatch(text), times.get(f"{key}Day")
        if match is None or not (day is None or (day.isascii() and day.isdigit())):
            self._blame(f"trainPart {part}, {key}", text, "not a time as HH:MM:SS, or not its day")
            return None
        hours, minutes, seconds = (int(group or 0) for group in match.groups())
        time_s = 3600.0 * hours + 60.0 * minutes + seconds
        if day is not None:
            return time_s + DAY_S * int(day)
        while time_s < after_s:
            time_s += DAY_S
        return time_s

    def _dwell(self, place: Element, part: str) -> float | None:
        text = next((each.get("minimalTime") for each in place.iter("stopTimes")), None)
        seconds = None if text is None else seconds_of(text)
        if isinstance(seconds, str):
            self._blame(f"trainPart {part}, minimalTime", seconds, "not a duration as PT1M30S")
            return None
        return seconds

    def _blame(self, key: str, value: str, problem: str) -> None:
        self.findings.append(Finding(str(self.path), key, value, problem, REMEDY))


def names_of(elements: Iterable[Element]) -> dict[str, str]:
    """Names by ids, each only once."""
    names: dict[str, str] = {}
    for element in elements:
        names[element.get("id", "")] = own_name(_name(element), names.values())
    return names


def _name(element: Element) -> str:
    keys = ("name", "trainNumber", "code", "id") if element.tag in ("ocp", "formation") else (
        "trainNumber", "name", "code", "id",
    )  # fmt: skip
    texts = (" ".join(element.get(key, "").split()) for key in keys)
    return next((text for text in texts if text), "unnamed")


def _sequence(element: Element) -> float:
    return _number(element.get("sequence"))


def _position(element: Element) -> float:
    return _number(element.get("position"))


def _number(text: str | None) -> float:
    return float(text) if text and text.isascii() and text.isdigit() else 0.0


def _joined(before: Call, after: Call) -> Call:
    """A place where one part of a train ends and the next begins."""
    dwells = [each for each in (before.min_dwell_s, after.min_dwell_s) if each is not None]
    return replace(
        after,
        arrival_s=before.arrival_s if before.arrival_s is not None else after.arrival_s,
        min_dwell_s=max(dwells, default=None),
    )
