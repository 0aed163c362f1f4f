"""Which way trains run: towards rising kilometres, or towards falling ones.

A train's position is a coordinate along its own route, which grows: the kilometre, or minus the
kilometre.  So drivers and brakes know one direction.  A train that runs both ways is a type for each, as
gradients and limits that lie ahead of it differ.
"""

from collections.abc import Sequence
from typing import NamedTuple

from tpss.scenario.line import Line
from tpss.scenario.rolling_stock import Train
from tpss.scenario.scenario import Scenario
from tpss.scenario.traffic import Traffic


class Running(NamedTuple):
    """A train of the scenario in one direction."""

    train: Train
    runs_down: bool = False
    """Whether towards falling kilometres."""
    name: str = ""


def runs_down(entry: Traffic, line: Line) -> bool:
    """Whether the trains of a service run towards falling kilometres."""
    position_km = {station.name: station.position_km for station in line.stations}
    return position_km[entry.destination] < position_km[entry.origin]


def running_trains(scenario: Scenario) -> list[Running]:
    """All trains up the line, used or not, then those that run down it too."""
    up = [Running(train, False, name) for name, train in scenario.trains.items()]
    down = dict.fromkeys(
        entry.train for entry in scenario.traffic if runs_down(entry, scenario.line)
    )
    return [*up, *(Running(scenario.trains[name], True, name) for name in down)]


def index_of(entry: Traffic, line: Line, running: Sequence[Running]) -> int:
    """Index of the trains of a service among all."""
    wanted = entry.train, runs_down(entry, line)
    return next(i for i, each in enumerate(running) if (each.name, each.runs_down) == wanted)
