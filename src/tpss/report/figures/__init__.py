"""Figures of results, one function a figure.

Those of one train or of stations take runs by their labels and overlay them: the first solid, the next
dashed, then dash-dotted.  All return a matplotlib figure, which is neither shown nor saved:
``journey({"as built": result}).savefig("journey.png")``.  `draw` makes one by its name.
"""

from tpss.report.figures.catalogue import FIGURES, draw
from tpss.report.figures.effort import effort
from tpss.report.figures.energy import energy_flow
from tpss.report.figures.journey import journey
from tpss.report.figures.stations import station_loading, station_powers
from tpss.report.figures.time_distance import time_distance
from tpss.report.figures.voltage import voltage_along_line, voltage_envelope

__all__ = [
    "FIGURES",
    "draw",
    "effort",
    "energy_flow",
    "journey",
    "station_loading",
    "station_powers",
    "time_distance",
    "voltage_along_line",
    "voltage_envelope",
]
