"""What can be compared: quantities of stations, trains and nodes, and units in which they are measured.

To compare one more recorded quantity takes a line in `QUANTITIES`.
"""

from typing import Literal, NamedTuple

import numpy as np
import numpy.typing as npt
import xarray as xr

from tpss.results.places import lines_of
from tpss.results.result import Result

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

CONTACT_LINE = "contact line"
"""Kind of the nodes that stations feed."""

NEAR_M = 1.0
"""A node within this of a station is at it. [m]"""


class Quantity(NamedTuple):
    """A quantity that is recorded and may be measured.

    Attributes
    ----------
    of : str
        What has it: station, train or node, a dimension of the dataset.
    variable : str
        Variable of the dataset.
    unit : str
        Unit of SI in which that is.
    words : str
    worst : str
        Which means over windows count: the highest of a power, the lowest of a voltage.
    """

    of: str
    variable: str
    unit: str
    words: str
    worst: Literal["highest", "lowest"]


QUANTITIES = {
    "station_active_power": Quantity(
        "station", "station_active_power", "W", "active power fed into the railway", "highest"
    ),
    "station_reactive_power": Quantity(
        "station", "station_reactive_power", "var", "reactive power fed into the railway", "highest"
    ),
    "station_voltage": Quantity(
        "station", "node_voltage", "V", "voltage of the contact line at the station", "lowest"
    ),
    "active_power": Quantity(
        "train", "active_power", "W", "active power drawn at the pantograph", "highest"
    ),
    "reactive_power": Quantity(
        "train", "reactive_power", "var", "reactive power drawn at the pantograph", "highest"
    ),
    "pantograph_voltage": Quantity(
        "train", "pantograph_voltage", "V", "voltage at the pantograph", "lowest"
    ),
    "node_voltage": Quantity("node", "node_voltage", "V", "node voltage", "lowest"),
}
"""Quantities by the names that columns give them, mostly those of the dataset."""

UNITS: dict[str, tuple[str, float]] = {
    # unit: (unit of SI, factor to it)
    "W": ("W", 1.0), "kW": ("W", 1e3), "MW": ("W", 1e6),
    "var": ("var", 1.0), "kvar": ("var", 1e3), "Mvar": ("var", 1e6),
    "VAr": ("var", 1.0), "kVAr": ("var", 1e3), "MVAr": ("var", 1e6),
    "V": ("V", 1.0), "kV": ("V", 1e3),
}  # fmt: skip
"""Units in which series are measured."""


class Shown(NamedTuple):
    """How a quantity is shown."""

    unit: str
    factor: float
    """From it to the unit of SI."""
    energy: str = ""
    """Unit of its integral over time in hours; empty if that means nothing."""


SHOWN = {
    "W": Shown("MW", 1e6, "MWh"),
    "var": Shown("Mvar", 1e6, "Mvarh"),
    "V": Shown("kV", 1e3),
}
"""How quantities are shown, by their units of SI."""


def units_of(quantity: Quantity) -> list[str]:
    """Units in which a quantity can be measured."""
    return [name for name, (si_unit, _) in UNITS.items() if si_unit == quantity.unit]


def elements_of(quantity: Quantity, dataset: xr.Dataset) -> list[str]:
    """Names of what has a quantity in a run."""
    return [str(name) for name in dataset[quantity.of].to_numpy()]


def nodes_of(station: str, result: Result) -> list[str]:
    """Nodes that may be the busbar of a station: the one at its place, or several where that tells none.

    With an outage, and for a station that names the lines it feeds, an open feed may part it from the
    contact line at its place; then any node may be its own.
    """
    dataset, scenario = result.dataset, result.scenario
    number = elements_of(QUANTITIES["station_voltage"], dataset).index(station)
    known = scenario.supply.stations[number].feeds is None and scenario.simulation.outage is None
    away_m = np.abs(dataset.node_position.to_numpy() - dataset.station_position.to_numpy()[number])
    on_it = lines_of(dataset, "node") == lines_of(dataset, "station")[number]
    there = on_it & (away_m < NEAR_M) & (dataset.node_kind.to_numpy() == CONTACT_LINE)
    names = dataset.node.to_numpy()
    return [str(name) for name in (names[there] if known else names)]


def simulated_values(quantity: Quantity, element: str, result: Result) -> Floats:
    """Values of an element's quantity, each from an instant to the next, shape (steps,).

    They are in the unit of SI; NaN: a train is not there.
    """
    name, dataset = element, result.dataset
    if quantity.of == "station" and quantity.variable == "node_voltage":
        (name,) = nodes_of(element, result)
    dimension = "node" if quantity.variable == "node_voltage" else quantity.of
    values = dataset[quantity.variable].sel({dimension: name}).to_numpy()
    return np.asarray(values[:-1], dtype=float)
