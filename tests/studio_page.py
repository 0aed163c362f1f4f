"""What a page of the studio asks its server, and a scenario for it to open."""

from base64 import b64decode
from typing import Any

import numpy as np
from starlette.testclient import TestClient

from tpss.studio.app import application
from tpss.studio.live import Live

TOKEN = "a-secret"
HOME = "http://127.0.0.1:8000"

LINE = """\
# A line to try the studio with.
format = 1
name = "short-line"

[simulation]
time_step_min = 0.05
motion = "stepped"          # as in other tests of short lines
braking = "whole-steps"

[line]
length_km = 20.0
gradients = [{ from_km = 0.0, permille = 0.0 }]
speed_limits = [{ from_km = 0.0, speed_kmh = 60.0 }]
stations = [
  { name = "West", position_km = 0.0 },
  { name = "Middle", position_km = 10.0 },   # in the middle
  { name = "East", position_km = 20.0 },
]

[supply]
frequency_hz = 16.7
catenary = "BT"

[supply.high_voltage_line]
type = "132kV"
transformers_km = [6.0, 14.0]

[[supply.converter_stations]]
name = "West"
position_km = 0.0
type = "Q48/Q49"
converters = 2

[[supply.converter_stations]]
name = "East"
position_km = 20.0
type = "Q48/Q49"
converters = 2

[trains.freight]
model = "Rc4-freight-1470t"

[[traffic]]
name = "eastbound"
train = "freight"
from = "West"
to = "East"
headway_min = 60.0  # one an hour
"""


class Page:
    """What a page asks its server."""

    def __init__(self, live: Live) -> None:
        self.live = live
        self.client = TestClient(application(live, TOKEN, lambda: True), base_url=HOME)
        self.number = 0

    def ask(self, name: str, **asked: Any) -> dict[str, Any]:
        answer = self.client.post(f"/{TOKEN}/api/{name}", json=asked)
        assert answer.status_code == 200, answer.text
        found: dict[str, Any] = answer.json()
        return found

    def see(self, *edits: Any, charts: tuple[str, ...] = ()) -> dict[str, Any]:
        self.number += 1
        pairs = [list(each) for each in edits]
        return self.ask("see", page="one", number=self.number, edits=pairs, charts=list(charts))


def numbers(packed: dict[str, str]) -> np.ndarray[Any, Any]:
    """An array that the server packed."""
    return np.frombuffer(b64decode(packed["f4"]), dtype="<f4")
