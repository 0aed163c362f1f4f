"""Services of imported trains that run every so many minutes, as ``[[traffic]]`` of a scenario."""

import json
from collections.abc import Iterable

from tpss.importers.network import own_name
from tpss.importers.timetable import Call, Service

EXAMPLE = """
# ASSUMED, edit it: no trains were imported.
[[traffic]]
name = "service"
train = {train}
from = {begin}
to = {end}
{via}headway_min = 30.0
"""


def service_tables(services: Iterable[Service], hours_s: tuple[float, float]) -> str:
    """Tables of services: with a headway, or with their departures where they end before the simulation.

    Parameters
    ----------
    services : iterable of Service
    hours_s : tuple of float
        When the simulation begins and ends, after midnight. [s]
    """
    names: list[str] = []
    texts = []
    for each in services:
        names.append(own_name(each.train.name, names))
        texts.append(_table(names[-1], each, *hours_s))
    return "".join(texts)


def _table(name: str, service: Service, begin_s: float, end_s: float) -> str:
    calls = service.train.calls
    first, last = calls[0], calls[-1]
    lines = [
        "",
        "[[traffic]]",
        f"name = {_text(name)}",
        f"train = {_text(service.train.train_type)}",
        f"from = {_text(first.station)}",
        f"to = {_text(last.station)}",
        *_departures(service, begin_s, end_s),
    ]
    passed = [call.station for call in calls[1:-1]]
    if any(call.kind == "pass" for call in calls[1:-1]):
        lines.append(f"via = [{', '.join(map(_text, passed))}]")
    stops = [_stop(call) for call in calls[1:-1] if call.kind == "stop"]
    if stops:
        lines += ["stops = [", *(f"  {{ {stop} }}," for stop in stops), "]"]
    if last.arrival_s is not None:
        lines.append(f"arrive_after_min = {_minutes(last.arrival_s)}")
    return "\n".join([*lines, ""])


def _departures(service: Service, begin_s: float, end_s: float) -> list[str]:
    only = service.windows[0]
    if len(service.windows) == 1 and only.last_s + only.headway_s > end_s:
        first_s = only.first_s - begin_s
        return [
            f"headway_min = {_minutes(only.headway_s)}",
            *([f"first_departure_min = {_minutes(first_s)}"] if first_s else []),
        ]
    departures_s = {time for window in service.windows for time in window.departures_s}
    times = ", ".join(_minutes(time - begin_s) for time in sorted(departures_s))
    return [f"departures_min = [{times}]"]


def _stop(call: Call) -> str:
    parts = [f"station = {_text(call.station)}", f"dwell_min = {_minutes(call.min_dwell_s or 0.0)}"]
    if call.arrival_s is not None:
        parts.append(f"arrive_after_min = {_minutes(call.arrival_s)}")
    if call.departure_s is not None:
        parts.append(f"depart_after_min = {_minutes(call.departure_s)}")
    return ", ".join(parts)


def _minutes(seconds: float) -> str:
    return repr(round(seconds / 60.0, 6))


def _text(words: str) -> str:
    return json.dumps(words, ensure_ascii=False)
