"""Timetables: tables in files with a row for each call of a train, in the order of travel.

Each train becomes an entry of the traffic, a service of a single train: all else knows only those.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Any, NamedTuple, Self

from pydantic import Field
from pydantic_core import PydanticCustomError

from tpss.errors import Finding
from tpss.scenario.clock import minute_of
from tpss.scenario.fields import Name, Part, Real
from tpss.scenario.timetable_rows import DURATIONS, KIND_OF_PLACE, Row, read_rows
from tpss.scenario.traffic import Delays, SpareTime, Supplement, spare_time

Location = tuple[int | str, ...]


class Timetable(Part):
    """A file with the calls of trains, which become entries of the traffic."""

    file: str = Field(
        min_length=1,
        description="CSV file or workbook next to the scenario with the columns name, train, station, "
        "arrival, departure, min_dwell_s, turn_s, track and kind.",
    )
    train: Name | None = Field(
        default=None,
        description="One of the scenario's trains, of those for which the file gives none.",
    )
    min_dwell_s: Real = Field(
        default=0.0,
        ge=0,
        le=6_000_000,
        description="Least duration of the stops for which the file gives none.",
    )
    delays: Delays | None = Field(
        default=None, description="Delays of departures; leave it out: none."
    )
    supplement_percent: Supplement = Field(
        default=0.0, description="As of a service in the traffic, of all its trains."
    )
    supplement_min_per_100km: Supplement = Field(default=0.0, description="Likewise.")
    spare_time: SpareTime | None = spare_time()
    density: Real = Field(
        default=1.0,
        ge=0.01,
        le=100,
        description="How many times as often trains depart: times between departures are divided by "
        "it. A denser timetable then begins again, until the departure of its last train.",
    )


OF_ALL_TRAINS = ("delays", "supplement_percent", "supplement_min_per_100km", "spare_time")
"""Keys that a timetable gives for each of its trains."""


PLACE_OF_KEY = {
    "name": "name",
    "from": "station",
    "to": "station",
    "station": "station",
    "dwell_min": "min_dwell_s",
    "turn_min": "turn_s",
    "departure_min": "departure",
    "arrive_after_min": "arrival",
    "after_min": "arrival",
    "depart_after_min": "departure",
    "track": "track",
}
"""Columns by the keys that are made from them."""

KIND_OF_KEY = {"stops": "stop", "passes": "pass"}
"""Kinds of rows by the lists that they go to."""


@dataclass(frozen=True)
class TimetabledTrain:
    """A train of a timetable as an entry of the traffic, and the rows that it was made from."""

    path: Path
    table: int
    """Number of its timetable among those of the scenario."""
    rows: Sequence[Row]
    entry: dict[str, Any]

    def origin(self, below: Location) -> tuple[Path | None, Location]:
        """File and place that a value below its entry comes from; without a file, in the scenario."""
        key, first, last = str(next(iter(below), "")), self.rows[0], self.rows[-1]
        row: Row | None
        if key == "via" and below[1:]:
            row, column = self.rows[1 + int(below[1])], "station"
        elif key in KIND_OF_KEY and below[1:]:
            rows = [row for row in self.rows[1:-1] if row.kind == KIND_OF_KEY[key]]
            row, column = rows[int(below[1])], PLACE_OF_KEY.get(str(below[-1]), "")
        elif key in OF_ALL_TRAINS:
            row, column = None, ""
        elif key == "train":
            row, column = next((row for row in self.rows if row["train"]), None), "train"
        else:
            row = last if key in ("to", "arrive_after_min") else first
            column = PLACE_OF_KEY.get(key, "")
        if row is None:
            return None, ("timetables", self.table, *below)
        return self.path, (row.place(column),)

    @property
    def named_twice(self) -> Finding:
        """The fault that its name is taken."""
        problem = "a train or a service has this name already"
        return self.rows[0].finding("name", problem, "give it another name")


class Defaults(NamedTuple):
    """What a timetable gives for rows that leave it out."""

    table: int
    """Number of the timetable among those of the scenario."""
    train: str | None
    min_dwell_s: float
    of_all: dict[str, Any]
    """What is given for each of its trains."""

    @classmethod
    def of(cls, number: int, table: Mapping[str, Any]) -> Self:
        """Of a table as it was written; what is wrong with it has findings of its own."""
        train, dwell_s = table.get("train"), table.get("min_dwell_s", 0.0)
        is_number = isinstance(dwell_s, int | float) and dwell_s >= 0.0
        train = train if isinstance(train, str) else None
        of_all = {key: table[key] for key in OF_ALL_TRAINS if key in table}
        return cls(number, train, dwell_s if is_number else 0.0, of_all)


def read_timetable(
    path: Path,
    start_s: float | None,
    defaults: Defaults,
    findings: list[Finding],
    text: str | None = None,
) -> tuple[list[TimetabledTrain], list[str]]:
    """Trains of a file, and what is told of how it was read.

    Trains with faults are left out, and their faults added to the findings.

    Parameters
    ----------
    path : Path
    start_s : float or None
        What the clock shows at the start of the simulation, if that is known. [s]
    defaults : Defaults
    findings : list of Finding
        Of what has been read so far.
    text : str, optional
        What the file holds, as CSV, if it has been read before.

    Raises
    ------
    ScenarioError
        The file cannot be read, or its header is wrong.
    """
    rows, notes = read_rows(path, f"timetables.{defaults.table}.file", findings, text)
    trains, first_line = [], dict[str, int]()
    for name, group in groupby(rows, key=lambda row: row["name"]):
        its_rows = list(group)
        if name in first_line:
            problem = f"train {name} has rows already, from line {first_line[name]} on"
            remedy = "keep the rows of a train together, in the order of travel"
            findings.append(its_rows[0].finding("name", problem, remedy))
            continue
        first_line[name] = its_rows[0].line
        faults = list(_faults(its_rows, start_s, defaults.train))
        findings += faults
        if not faults:
            entry = _entry(its_rows, start_s, defaults)
            trains.append(TimetabledTrain(path, defaults.table, its_rows, entry))
    return trains, notes


def _faults(rows: list[Row], start_s: float | None, train: str | None) -> Iterator[Finding]:
    """Faults of the rows of a train."""
    first = rows[0]
    if not first["name"]:
        yield first.finding("name", "a row without the name of its train", "write it in each row")
        return
    if len(rows) == 1:
        problem = f"a single row of train {first['name']}"
        yield first.finding("", problem, "give it at least two, where it begins and where it ends")
        return
    kinds = [KIND_OF_PLACE["first"], *[KIND_OF_PLACE["between"]] * (len(rows) - 2)]
    for row, place in zip(rows, [*kinds, KIND_OF_PLACE["last"]], strict=True):
        yield from place.faults(row)
    if not first["departure"]:
        yield first.finding("departure", f"train {first['name']} has no departure", "add it")
    given = list(dict.fromkeys(row["train"] for row in rows if row["train"]))
    if len(given) > 1:
        row = next(row for row in rows if row["train"] == given[1])
        problem = f"another train than before, {given[0]}"
        yield row.finding("train", problem, "give a train of this name one type of train")
    if not given and train is None:
        remedy = "write it in the column train, or add train to [[timetables]] for all without one"
        yield first.finding("train", "it is not said which of the scenario's trains runs", remedy)
    for row in rows:
        number = _number(row["track"])
        if row["track"] and not (number.is_integer() and number >= 1.0):
            remedy = "write a whole number, counted from 1 at the left as seen in rising kilometres"
            yield row.finding("track", "not the number of a track", remedy)
    yield from _faults_of_times(rows, start_s)


def _faults_of_times(rows: list[Row], start_s: float | None) -> Iterator[Finding]:
    """Times that are none, and those that do not follow the travel; dwells that are none."""
    before, before_min = "", -math.inf
    for row in rows:
        for column in ("arrival", "departure"):
            try:
                minute = _minute(row[column], start_s)
            except PydanticCustomError as error:
                words = error.context or {}
                yield row.finding(column, str(words["problem"]), str(words["remedy"]))
                return
            if minute is None:
                continue
            if minute < before_min:
                problem = f"earlier than the time before it, {before}"
                remedy = (
                    "put the rows in the order of travel; after midnight the hours go on with 24"
                )
                yield row.finding(column, problem, remedy)
                return
            before, before_min = row[column], minute
        for column in DURATIONS:
            if row[column] and not _number(row[column]) >= 0.0:
                yield row.finding(column, "not a duration", "write a number of seconds")


def _number(text: str) -> float:
    """A number; NaN if the text is none that is finite."""
    try:
        number = float(text)
    except ValueError:
        return math.nan
    return number if math.isfinite(number) else math.nan


def _minute(text: str, start_s: float | None) -> float | None:
    """Minute of a time, which is a number of minutes or one of the clock; None if it is not given."""
    if not text:
        return None
    minute = _number(text)
    return minute_of(text, start_s) if math.isnan(minute) else minute


def _entry(rows: list[Row], start_s: float | None, defaults: Defaults) -> dict[str, Any]:
    """Entry of the traffic of a train without faults."""
    origin, destination = rows[0], rows[-1]
    departure_min = _minute(origin["departure"], start_s) or 0.0

    def after(*texts: str) -> float | None:
        """The first of some times that is given, counted from the departure at the origin. [min]"""
        minute = next((m for text in texts if (m := _minute(text, start_s)) is not None), None)
        return None if minute is None else minute - departure_min

    stops, passes, between = [], [], rows[1:-1]
    for row in between:
        if row.kind == "pass":
            time = after(row["arrival"], row["departure"])
            passes.append(_given(station=row["station"], track=_track(row), after_min=time))
            continue
        dwell_s = _number(row["min_dwell_s"]) if row["min_dwell_s"] else defaults.min_dwell_s
        times = {
            "arrive_after_min": after(row["arrival"]),
            "depart_after_min": after(row["departure"]),
        }
        turn_min = _number(row["turn_s"]) / 60.0 if row["turn_s"] else None
        dwell_min = dwell_s / 60.0
        durations = {"dwell_min": dwell_min, "turn_min": turn_min}
        stops.append(_given(station=row["station"], track=_track(row), **durations, **times))
    return {
        "name": origin["name"],
        "train": next((row["train"] for row in rows if row["train"]), defaults.train),
        "from": origin["station"],
        "to": destination["station"],
        **_given(track=_track(origin)),
        "departure_min": departure_min,
        **_given(arrive_after_min=after(destination["arrival"])),
        **defaults.of_all,
        "stops": stops,
        "passes": passes,
        # Rows stand in the order of travel: stations that are passed say which way a train takes.
        "via": [row["station"] for row in between] if passes else [],
    }


def _track(row: Row) -> int | None:
    """Track that a row gives, if it gives one."""
    return int(_number(row["track"])) if row["track"] else None


def _given(**values: Any) -> dict[str, Any]:
    return {key: value for key, value in values.items() if value is not None}
