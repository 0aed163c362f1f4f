"""A small infrastructure in OSRD's format, made up: a line over two tracks, and a branch."""

import copy
from typing import Any

LINK = {"switch_type": "link", "group_change_delay": 0.0}
POINTS = {"switch_type": "point_switch", "group_change_delay": 0.0}


def track(name: str, length_m: float, line: str = "", **more: Any) -> dict[str, Any]:
    sncf = {"line_code": 7, "line_name": line, "track_number": 1, "track_name": "V1"}
    return {
        "id": name, "length": length_m, "slopes": [], "curves": [], "loading_gauge_limits": [],
        "geo": {"type": "LineString", "coordinates": [[0.0, 50.0], [0.1, 50.0]]},
        "extensions": {"sncf": {**sncf, "line_code": line}} if line else {}, **more,
    }  # fmt: skip


def ports(**ends: str) -> dict[str, Any]:
    """Ports of a switch, from such as ``A="M1.END"``."""
    pairs = {port: end.split(".") for port, end in ends.items()}
    return {port: {"track": name, "endpoint": end} for port, (name, end) in pairs.items()}


def point(name: str, uic: int, *parts: tuple[str, float]) -> dict[str, Any]:
    return {
        "id": f"op.{uic}",
        "parts": [{"track": name, "position": position} for name, position in parts],
        "extensions": {
            "identifier": {"name": name, "uic": uic},
            "sncf": {"ci": 0, "ch": "BV", "trigram": name[:2].upper()},
        },
    }


def on(name: str, begin_m: float, end_m: float, directions: str = "BOTH") -> dict[str, Any]:
    return {"track": name, "begin": begin_m, "end": end_m, "applicable_directions": directions}


def limit(speed_m_s: float | None, *ranges: dict[str, Any], **more: Any) -> dict[str, Any]:
    return {
        "id": "s", "speed_limit": speed_m_s, "speed_limit_by_tag": {}, "track_ranges": list(ranges),
        **more,
    }  # fmt: skip


INFRA: dict[str, Any] = {
    "version": "3.4.12",
    "track_sections": [
        track("M1", 6000.0, "Main",
              slopes=[{"gradient": 5.0, "begin": 1000.0, "end": 3000.0}],
              curves=[{"radius": -800.0, "begin": 2000.0, "end": 2500.0},
                      {"radius": 60.0, "begin": 2600.0, "end": 2700.0}]),
        track("M2", 4000.0, "Main",  # its end is where M1 ends
              slopes=[{"gradient": 2.0, "begin": 0.0, "end": 1000.0}]),
        track("B1", 5000.0, "Branch"),
    ],
    "switches": [
        {"id": "s.1", **POINTS, "ports": ports(A="M1.END", B1="B1.BEGIN", B2="M2.END"),
         "extensions": {"sncf": {"label": "Fork"}}},
    ],
    "operational_points": [
        point("West", 1, ("M1", 0.0)),
        point("East", 2, ("M2", 0.0)),
        point("Mine", 3, ("B1", 4800.0), ("B1", 5000.0)),
    ],
    "speed_sections": [
        limit(40.0, on("M1", 0.0, 6000.0), on("M2", 0.0, 4000.0)),
        limit(20.0, on("M1", 5000.0, 6000.0, "START_TO_STOP"),
              on("M2", 3000.0, 4000.0, "START_TO_STOP")),
        limit(10.0, on("B1", 0.0, 5000.0), on_routes=["r.1"]),
        limit(None, on("B1", 0.0, 5000.0), speed_limit_by_tag={"MA100": 20.0}),
    ],
    "electrifications": [{"id": "e", "voltage": "25000V", "track_ranges": [on("M1", 0.0, 6000.0)]}],
    "neutral_sections": [
        {"id": "n1", "lower_pantograph": False, "track_ranges": [on("M1", 5900.0, 6000.0)],
         "announcement_track_ranges": [on("M1", 5500.0, 5900.0)]},
        {"id": "n2", "lower_pantograph": True, "track_ranges": [on("M1", 5700.0, 5950.0)],
         "announcement_track_ranges": []},
        {"id": "n3", "lower_pantograph": False, "track_ranges": [on("M2", 2000.0, 2100.0)]},
    ],
    "signals": [{}, {}], "routes": [{}], "detectors": [{}, {}, {}], "buffer_stops": [],
    "extended_switch_types": [],
}  # fmt: skip

TRAINS: list[dict[str, Any]] = [
    {
        "train_name": "4101", "rolling_stock_name": "Fast freight", "labels": [],
        "start_time": "2024-05-01T05:40:00+02:00",
        "path": [{"id": "a", "uic": 1, "secondary_code": "BV"},
                 {"id": "b", "track": "M1", "offset": 3_000_000},
                 {"id": "c", "trigram": "MI"}],
        "schedule": [{"at": "b", "arrival": "PT2M30S", "stop_for": None},
                     {"at": "c", "arrival": "PT10M", "stop_for": "P0D"}],
        "margins": {"boundaries": ["b"], "values": ["5%", "3min/100km"]}, "initial_speed": 2.5,
    },
    {
        "train_name": "4102", "rolling_stock_name": "", "labels": [],
        "start_time": "2024-05-02T00:05:00+02:00",
        "path": [{"id": "a", "operational_point": "op.2"}, {"id": "x", "uic": 3, "deleted": True},
                 {"id": "b", "track": "M1", "offset": 3_000_000},
                 {"id": "c", "operational_point": "op.1"}],
        "schedule": [{"at": "a", "stop_for": "PT5M"},
                     {"at": "b", "arrival": "PT0.2H", "stop_for": "PT90S"}],
        "margins": {"boundaries": [], "values": ["0%"]}, "initial_speed": 0,
    },
    {
        "train_name": "lost", "start_time": "2024-05-01T06:00:00+02:00",
        "path": [{"id": "a", "uic": 1}, {"id": "b", "uic": 99}],
    },
]  # fmt: skip


def parallel() -> dict[str, Any]:
    """Two tracks of 1000 m between two switches, and a track on either side."""
    infra = {**copy.deepcopy(INFRA), "operational_points": [], "speed_sections": []}
    infra["track_sections"] = [
        track("left", 2000.0), track("upper", 1000.0), track("lower", 1000.0), track("right", 3000.0)
    ]  # fmt: skip
    infra["switches"] = [
        {"id": "S1", **POINTS, "ports": ports(A="left.END", B1="upper.BEGIN", B2="lower.BEGIN")},
        {"id": "S2", **POINTS, "ports": ports(A="right.BEGIN", B1="upper.END", B2="lower.END")},
    ]
    return infra


def circle() -> dict[str, Any]:
    """Two tracks that are linked at both ends."""
    infra = {**copy.deepcopy(INFRA), "operational_points": [], "speed_sections": []}
    infra["track_sections"] = [track("one", 3000.0), track("two", 1000.0)]
    infra["switches"] = [
        {"id": "S1", **LINK, "ports": ports(A="one.END", B="two.BEGIN")},
        {"id": "S2", **LINK, "ports": ports(A="two.END", B="one.BEGIN")},
    ]
    return infra
