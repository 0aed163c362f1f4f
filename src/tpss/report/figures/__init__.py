"""Figures of results for print, one function per figure.

Those of one train or of stations accept runs by their labels and overlay them: the first solid, the next
dashed, then dash-dotted.  All return a matplotlib figure, which is neither shown nor saved:
``journey({"as built": result}).savefig("journey.png")``.  `draw` makes one by its name,
`overlay` one of several results.
"""

from tpss.report.drawings import braking as _braking
from tpss.report.drawings import converter_losses as _converter_losses
from tpss.report.drawings import effort as _effort
from tpss.report.drawings import energy as _energy
from tpss.report.drawings import journey as _journey
from tpss.report.drawings import measured as _measured
from tpss.report.drawings import network as _network
from tpss.report.drawings import stations as _stations
from tpss.report.drawings import storage as _storage
from tpss.report.drawings import time_distance as _time_distance
from tpss.report.drawings import unbalance as _unbalance
from tpss.report.drawings import voltage as _voltage
from tpss.report.figures.catalogue import FIGURES as FIGURES
from tpss.report.figures.catalogue import draw as draw
from tpss.report.figures.catalogue import overlay as overlay
from tpss.report.render.static import static

braking = static(_braking.braking)
converter_losses = static(_converter_losses.converter_losses)
effort = static(_effort.effort)
energy_flow = static(_energy.energy_flow)
journey = static(_journey.journey)
measured_durations = static(_measured.measured_durations)
measured_over_time = static(_measured.measured_over_time)
network = static(_network.network)
station_loading = static(_stations.station_loading)
station_powers = static(_stations.station_powers)
storage = static(_storage.storage)
time_distance = static(_time_distance.time_distance)
unbalance = static(_unbalance.unbalance)
voltage_along_line = static(_voltage.voltage_along_line)
voltage_envelope = static(_voltage.voltage_envelope)
