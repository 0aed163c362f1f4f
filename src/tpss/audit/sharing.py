"""What sources that share a grid do to each other, from the powers that were recorded.

The solver knows it by admittances, as part of its linear system; here it is the voltage that each loses.
"""

from typing import Any

from tpss.kernel import where_any
from tpss.powerflow.shared_grids import SharedGrids
from tpss.step.model import Model
from tpss.step.recording import Recording


def _no_drop(*_: Any) -> complex:
    """`drop_by_others` where no source shares its grid."""
    return 0j


@where_any(without=_no_drop)
def drop_by_others(
    shared: SharedGrids, s: int, step: int, model: Model, recording: Recording
) -> complex:
    """Voltage that source `s` loses over the currents of those that share its grid. [V]

    References
    ----------
    [Steimel2014]_, the feeding of single-phase lines from the three-phase grid.
    """
    network, drop = model.network, 0j
    for j in range(network.sources.size):
        if shared.mutual_ohm[s, j] != 0.0 and network.sources[j].installed > 0:
            node = recording.nodes[step, network.sources[j].node]
            fed = recording.stations[step, j]
            power = complex(fed.station_active_power, fed.station_reactive_power)
            voltage = complex(node.node_real, node.node_imag)
            drop += shared.mutual_ohm[s, j] * (power / voltage).conjugate()
    return drop
