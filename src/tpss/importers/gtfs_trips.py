"""Trips of some routes of a GTFS feed on one day."""

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import date, timedelta

from tpss.errors import Finding, ScenarioError, closest
from tpss.importers.gtfs_feed import Feed, Row

WEEKDAYS = ("monday", "tuesday", "wednesday", "thursday", "friday", "saturday", "sunday")

MOST_DAYS = 800
"""Days that are searched for the one with the most trips."""

RAIL = ("0", "1", "2", "5", "7", "12")
"""Types of route on rails; from 100 to 199, 400 to 499 and 900 to 999 too."""


@dataclass(frozen=True)
class StopTime:
    """A trip at a stop; times after midnight, where they are given. [s]"""

    stop: str
    arrival_s: float | None
    departure_s: float | None
    passes: bool
    distance: float | None
    """Way along the shape of the trip, in units that the feed does not tell."""


@dataclass
class Trip:
    """A trip of a route."""

    ident: str
    route: str
    name: str
    service: str
    shape: str = ""
    """Its course, if the feed has it."""
    stops: list[StopTime] = field(default_factory=list)
    windows: list[tuple[float, float, float]] = field(default_factory=list)
    """Beginnings and ends of the times when it runs again and again [s], and how often [s]."""


def chosen_routes(feed: Feed, wanted: Sequence[str]) -> dict[str, str]:
    """Names of the routes that are asked for by their ids, short or long names.

    Raises
    ------
    ScenarioError
        There is no route of that name.
    """
    rows = list(feed.rows("routes.txt", "route_id", "route_type"))
    found: dict[str, str] = {}
    findings = []
    for name in wanted:
        columns = ("route_id", "route_short_name", "route_long_name")
        matches = [row for row in rows if name in (row[column] for column in columns)]
        found |= {row["route_id"]: _route_name(row) for row in matches}
        if not matches:
            known = [_route_name(row) for row in sorted(rows, key=lambda row: not _on_rails(row))]
            near = closest(name, [row[column] for row in rows for column in columns if row[column]])
            hint = f"did you mean {near}? " if near else ""
            remedy = f"{hint}routes: {', '.join(known[:20])}"
            place = str(feed.path / "routes.txt")
            findings.append(Finding(place, "--route", name, "there is no such route", remedy))
    if findings:
        raise ScenarioError(findings)
    return found


def _route_name(row: Row) -> str:
    return row["route_short_name"] or row["route_long_name"] or row["route_id"]


def _on_rails(row: Row) -> bool:
    kind = row["route_type"]
    return kind in RAIL or (len(kind) == 3 and kind[0] in "149")


def trips_of(feed: Feed, routes: Mapping[str, str]) -> list[Trip]:
    """Trips of some routes, with their stops and times."""
    trips: dict[str, Trip] = {}
    for row in feed.rows("trips.txt", "route_id", "service_id", "trip_id"):
        if row["route_id"] in routes:
            name = row["trip_short_name"] or row["trip_id"]
            ident = row["trip_id"]
            trips[ident] = Trip(ident, row["route_id"], name, row["service_id"], row["shape_id"])
    stops: dict[str, list[tuple[float, StopTime]]] = defaultdict(list)
    for row in feed.rows("stop_times.txt", "trip_id", "stop_id", "stop_sequence"):
        if row["trip_id"] in trips:
            stops[row["trip_id"]].append((row.number("stop_sequence"), _stop_time(row)))
    for ident, rows in stops.items():
        trips[ident].stops = [stop for _, stop in sorted(rows, key=lambda pair: pair[0])]
    columns = ("trip_id", "start_time", "end_time", "headway_secs")
    for row in feed.optional_rows("frequencies.txt", *columns):
        if row["trip_id"] in trips:
            trips[row["trip_id"]].windows.append(_window(row))
    return list(trips.values())


def _stop_time(row: Row) -> StopTime:
    distance = row.number("shape_dist_traveled") if row["shape_dist_traveled"] else None
    passes = row["pickup_type"] == row["drop_off_type"] == "1"
    times = (row.seconds("arrival_time"), row.seconds("departure_time"))
    return StopTime(row["stop_id"], *times, passes, distance)


def _window(row: Row) -> tuple[float, float, float]:
    begin_s, end_s = row.seconds("start_time"), row.seconds("end_time")
    headway_s = row.number("headway_secs")
    if begin_s is None or end_s is None:
        column = "start_time" if begin_s is None else "end_time"
        raise ScenarioError([row.finding(column, "it is missing")])
    if headway_s <= 0.0:
        raise ScenarioError([row.finding("headway_secs", "not greater than 0")])
    return begin_s, end_s, headway_s


class Calendar:
    """Services by day."""

    def __init__(self, feed: Feed, services: set[str]) -> None:
        self.place = str(feed.path)
        self._weekly: list[tuple[str, date, date, set[int]]] = []
        self._added: dict[date, set[str]] = defaultdict(set)
        self._removed: dict[date, set[str]] = defaultdict(set)
        for row in feed.optional_rows("calendar.txt", "service_id", "start_date", "end_date"):
            if row["service_id"] in services:
                days = {i for i, name in enumerate(WEEKDAYS) if row[name] == "1"}
                ends = (_day(row, "start_date"), _day(row, "end_date"))
                self._weekly.append((row["service_id"], *ends, days))
        columns = ("service_id", "date", "exception_type")
        for row in feed.optional_rows("calendar_dates.txt", *columns):
            if row["service_id"] in services:
                kind = self._added if row["exception_type"] == "1" else self._removed
                kind[_day(row, "date")].add(row["service_id"])

    def services_on(self, day: date) -> set[str]:
        """Services that run on a day."""
        weekly = {
            service
            for service, first, last, days in self._weekly
            if first <= day <= last and day.weekday() in days
        }
        return (weekly - self._removed[day]) | self._added[day]

    def busiest(self, trips_of_service: Mapping[str, int]) -> date:
        """The first day with the most trips.

        Raises
        ------
        ScenarioError
            No service runs on any day.
        """
        counts: Counter[date] = Counter()
        for day in self._days():
            counts[day] = sum(trips_of_service[each] for each in self.services_on(day))
        most = max(counts.values(), default=0)
        if not most:
            problem, remedy = "its trips run on no day", "name another route"
            raise ScenarioError([Finding(self.place, "calendar.txt", "", problem, remedy)])
        return min(day for day, count in counts.items() if count == most)

    def _days(self) -> Iterator[date]:
        firsts = [*(first for _, first, _, _ in self._weekly), *self._added]
        lasts = [*(last for _, _, last, _ in self._weekly), *self._added]
        if firsts:
            first = min(firsts)
            for i in range(min((max(lasts) - first).days + 1, MOST_DAYS)):
                yield first + timedelta(days=i)


def _day(row: Row, column: str) -> date:
    text = row[column]
    try:
        if len(text) != 8:
            raise ValueError
        return date(int(text[:4]), int(text[4:6]), int(text[6:]))
    except ValueError:
        raise ScenarioError([row.finding(column, "not a date as YYYYMMDD")]) from None
