"""The charts of a run that a page shows, by their names."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from tpss.report.contact_line import LineVoltage, line_voltage
from tpss.report.corridor import along
from tpss.report.drawings.converter_losses import converter_losses
from tpss.report.drawings.losses import losses
from tpss.report.drawings.parts import Drawing
from tpss.report.drawings.rails import rail_voltage
from tpss.report.drawings.stations import station_loading, station_powers
from tpss.report.drawings.storage import storage
from tpss.report.drawings.thermal import thermal
from tpss.report.drawings.time_distance import time_distance
from tpss.report.drawings.unbalance import unbalance
from tpss.report.drawings.voltage import envelopes
from tpss.results.converter_losses import describes_losses
from tpss.results.rails import has_rails
from tpss.results.result import Result
from tpss.results.storage import has_stores
from tpss.results.thermal.elements import has_ratings
from tpss.studio.packed import of_drawing


@dataclass(frozen=True)
class Seen:
    """A run, and what its charts have in common, made where it is first needed."""

    result: Result

    @cached_property
    def along(self) -> Result:
        """The run along the line, or of a network along the way of its first service."""
        return along(self.result)

    @cached_property
    def voltage(self) -> LineVoltage:
        """Voltage of the contact line along it."""
        found = line_voltage(self.along.dataset)
        if found is None:
            raise ValueError("no time step was simulated, so there is no voltage")
        return found


@dataclass(frozen=True)
class Chart:
    """How a chart is called, what it shows of a run, and whether a run has it."""

    title: str
    describe: Callable[[Seen], Drawing]
    is_there: Callable[[Result], bool] = lambda _: True
    over: str = "time"
    """Its horizontal axis: ``time`` or ``line``, or ``train`` of the train graph."""


CHARTS = {
    "voltage": Chart(
        "Voltage along the line",
        lambda seen: envelopes({"": (seen.along, seen.voltage)}),
        over="line",
    ),
    "graph": Chart("Train graph", lambda seen: time_distance(seen.along), over="train"),
    "powers": Chart(
        "Power of the feeding stations", lambda seen: station_powers({"": seen.result})
    ),
    "loading": Chart("Loading of the feeding stations", lambda seen: station_loading(seen.result)),
    "losses": Chart("Losses of the network", lambda seen: losses({"": seen.result})),
    "converter-losses": Chart(
        "Losses of the converter stations",
        lambda seen: converter_losses({"": seen.result}),
        lambda result: describes_losses(result.scenario),
    ),
    "unbalance": Chart(
        "Unbalance of the grid",
        lambda seen: unbalance({"": seen.result}),
        lambda result: len(result.standards.unbalance) > 0,
    ),
    "storage": Chart(
        "Stores of energy",
        lambda seen: storage({"": seen.result}),
        lambda result: has_stores(result.dataset),
    ),
    "thermal": Chart(
        "Thermal state of equipment",
        lambda seen: thermal({"": seen.result}),
        lambda result: has_ratings(result.scenario),
    ),
    "rails": Chart(
        "Voltage of the rails",
        lambda seen: rail_voltage(seen.result),
        lambda result: has_rails(result.dataset),
        over="line",
    ),
}
"""A chart more is one line here, and one more drawing of `tpss.report.drawings`."""


def drawn(result: Result, names: list[str]) -> dict[str, Any]:
    """Charts of these names that a run has, packed."""
    seen = Seen(result)
    return {
        name: of_drawing(CHARTS[name].describe(seen))
        for name in names
        if name in CHARTS and CHARTS[name].is_there(result)
    }
