"""Train schedules of OSRD as trains of a timetable."""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from tpss.errors import Finding, ScenarioError
from tpss.importers.documents import Item, as_model, read_json
from tpss.importers.network import own_name, plain_name
from tpss.importers.osrd_infra import Infra, OperationalPoint
from tpss.importers.timetable import Call, Train, ends_told, seconds_of

REMEDY = "export the train schedules from OSRD anew"

Duration = Annotated[float, BeforeValidator(seconds_of), Field(ge=0)]


class PathItem(Item):
    """A place on a train's way, by one of several names."""

    id: str
    deleted: bool = False
    track: str | None = None
    offset: float = 0.0
    """Position on the track. [mm]"""
    operational_point: str | None = None
    uic: int | None = None
    trigram: str | None = None
    secondary_code: str | None = None


class ScheduleItem(Item):
    """Times at a place; a train stops where a duration is given, also one of 0."""

    at: str
    arrival: Duration | None = None
    stop_for: Duration | None = None


class Margins(Item):
    """Additions to running times."""

    values: tuple[str, ...] = ()


class TrainSchedule(Item):
    """A train."""

    train_name: Annotated[str, Field(min_length=1)]
    rolling_stock_name: str = ""
    start_time: datetime
    path: Annotated[list[PathItem], Field(min_length=2)]
    schedule: tuple[ScheduleItem, ...] = ()
    margins: Margins | None = None
    initial_speed: float = 0.0
    speed_limit_tag: str | None = None
    power_restrictions: tuple[Any, ...] = ()


def read_trains(path: Path) -> list[TrainSchedule]:
    """Train schedules of a file: a list of them, or one.

    Raises
    ------
    ScenarioError
        The file cannot be read, or has faults.
    """
    document = read_json(path)
    if isinstance(document, dict):
        document = document.get("train_schedules", document)
    rows = document if isinstance(document, list) else [document]
    trains: list[TrainSchedule] = as_model(list[TrainSchedule], rows, path, REMEDY)
    if not trains:
        raise ScenarioError([Finding(str(path), "", "[]", "there are no trains in it", REMEDY)])
    return trains


@dataclass
class Places:
    """Where path items are: names of operational points, or places on tracks."""

    infra: Infra
    unknown: Counter[str] = field(default_factory=Counter)
    """Trains that were left out, by the reason."""

    def __post_init__(self) -> None:
        self._tracks = {section.id: section.length for section in self.infra.track_sections}
        points = [point for point in self.infra.operational_points if point.parts]
        self._by_id = {point.id: point for point in points}
        self._by_uic: dict[int, list[OperationalPoint]] = {}
        self._by_trigram: dict[str, list[OperationalPoint]] = {}
        for point in points:
            identifier, code = point.extensions.identifier, point.extensions.sncf
            if identifier and identifier.uic is not None:
                self._by_uic.setdefault(identifier.uic, []).append(point)
            if code and code.trigram:
                self._by_trigram.setdefault(code.trigram, []).append(point)

    def point(self, item: PathItem) -> OperationalPoint | None:
        """Operational point of a path item, if it names one that there is."""
        if item.operational_point is not None:
            return self._by_id.get(item.operational_point)
        found = []
        if item.uic is not None:
            found = self._by_uic.get(item.uic, [])
        elif item.trigram is not None:
            found = self._by_trigram.get(item.trigram, [])
        code = item.secondary_code
        exact = [p for p in found if p.extensions.sncf and p.extensions.sncf.ch == code]
        return next(iter(exact or found), None)

    def on_track(self, item: PathItem) -> tuple[str, float] | None:
        """Track section and position [m] of a path item, if it names those."""
        if item.track not in self._tracks or item.track is None:
            return None
        return item.track, min(max(item.offset / 1e3, 0.0), self._tracks[item.track])

    def is_known(self, item: PathItem) -> bool:
        """Whether a path item leads somewhere."""
        return self.point(item) is not None or self.on_track(item) is not None


def known_trains(trains: Sequence[TrainSchedule], places: Places) -> list[TrainSchedule]:
    """Trains whose ways are in the infrastructure; the others are counted."""
    found = []
    for train in trains:
        items = [item for item in train.path if not item.deleted]
        if len(items) < 2:
            places.unknown["fewer than two places on their way"] += 1
        elif all(places.is_known(item) for item in items):
            found.append(train.model_copy(update={"path": items}))
        else:
            places.unknown["places that the infrastructure does not have"] += 1
    return found


def as_timetable(
    trains: Iterable[TrainSchedule], station_of: Callable[[PathItem], str | None]
) -> list[Train]:
    """Trains with their calls; times count from the midnight before the first of them.

    Parameters
    ----------
    trains : iterable of TrainSchedule
    station_of : callable
        Station of a path item; None if it is on no line.
    """
    trains = list(trains)
    if not trains:
        return []
    first = min(train.start_time for train in trains)
    midnight = first.replace(hour=0, minute=0, second=0, microsecond=0)
    found: list[Train] = []
    for train in trains:
        calls = _calls(train, (train.start_time - midnight).total_seconds(), station_of)
        if len(calls) >= 2:
            name = own_name(" ".join(train.train_name.split()), [each.name for each in found])
            kind = plain_name(train.rolling_stock_name, "train")
            found.append(Train(name, kind, ends_told(calls)))
    return found


def _calls(
    train: TrainSchedule, start_s: float, station_of: Callable[[PathItem], str | None]
) -> list[Call]:
    times = {item.at: item for item in train.schedule}
    calls: list[Call] = []
    for i, item in enumerate(train.path):
        station = station_of(item)
        if station is None:
            return []
        call = _call(station, times.get(item.id), start_s, is_first=i == 0)
        if not calls or calls[-1].station != station:
            calls.append(call)
        elif call.kind == "stop" and len(calls) > 1:
            calls[-1] = call
    return calls


def _call(station: str, given: ScheduleItem | None, start_s: float, is_first: bool) -> Call:
    dwell_s = given.stop_for if given else None
    if is_first:
        return Call(station, "start", departure_s=start_s + (dwell_s or 0.0))
    arrival_s = start_s + given.arrival if given and given.arrival is not None else None
    if dwell_s is None:
        return Call(station, "pass", arrival_s=arrival_s)
    departure_s = arrival_s + dwell_s if arrival_s is not None else None
    return Call(station, "stop", arrival_s, departure_s, dwell_s)


def left_out_of_trains(trains: Sequence[TrainSchedule], places: Places) -> list[str]:
    """What of the train schedules was left out, with counts."""
    counts = {
        "margins of running times, which supplement_percent of [[timetables]] may stand for": [
            t for t in trains if t.margins and any(not _is_none(m) for m in t.margins.values)
        ],
        "power restrictions": [t for t in trains if t.power_restrictions],
        "initial speeds: trains begin at rest": [t for t in trains if t.initial_speed],
        "speed limit tags: the limits of all trains apply": [
            t for t in trains if t.speed_limit_tag
        ],
    }
    told = [f"{words}; of {len(those)} of the trains" for words, those in counts.items() if those]
    return told + [f"trains with {why}: {count}" for why, count in places.unknown.items()]


def _is_none(margin: str) -> bool:
    return margin == "none" or margin.split("%")[0].split("min")[0].strip() in ("0", "0.0")
