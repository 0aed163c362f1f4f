"""Services of imported trains that run every so many minutes, as ``[[traffic]]`` of a scenario."""

import json
from collections.abc import Iterable

from tpss.importers.network import own_name
from tpss.importers.timetable import Call, Headway

EXAMPLE = """
# ASSUMED, edit it: no trains were imported.
[[traffic]]
name = "service"
train = "train"
from = {begin}
to = {end}
{via}headway_min = 30.0
"""


def service_tables(services: Iterable[Headway], hours_s: tuple[float, float]) -> str:
    """Tables of services: with a headway, or with their departures where they end before the simulation.

    Parameters
    ----------
    services : iterable of Headway
    hours_s : tuple of float
        When the simulation begins and ends, after midnight. [s]
    """
    names: list[str] = []
    texts = []
    for each in services:
        names.append(own_name(each.train.name, names))
        texts.append(_table(names[-1], each, *hours_s))
    return "".join(texts)


def _table(name: str, service: Headway, begin_s: float, end_s: float) -> str:
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


def _departures(service: Headway, begin_s: float, end_s: float) -> list[str]:
    first_s, every_s = service.first_s - begin_s, service.headway_s
    if service.last_s + every_s > end_s:
        return [
            f"headway_min = {_minutes(every_s)}",
            *([f"first_departure_min = {_minutes(first_s)}"] if first_s else []),
        ]
    count = int((service.last_s - service.first_s) // every_s) + 1
    times = ", ".join(_minutes(first_s + i * every_s) for i in range(count))
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
