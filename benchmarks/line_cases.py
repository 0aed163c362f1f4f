"""A network with trains on it, ready to be solved, for tests and benchmarks of the load flow."""

from dataclasses import dataclass

import numpy as np

from tpss.powerflow.assembly import new_flow
from tpss.powerflow.bundle_points import order_points
from tpss.powerflow.network import Flow, Loads, Network
from tpss.powerflow.placing import locate_trains, measure_pieces
from tpss.record import Records
from tpss.track.leg import Leg, along_one_line


@dataclass
class Case:
    """A network with trains on it, ready to be solved."""

    network: Network
    flow: Flow
    loads: Loads

    @property
    def train_voltage(self) -> np.ndarray:
        """Voltages in the order along the line. [V]"""
        return self.flow.standing.voltage_v

    @property
    def fed(self) -> np.ndarray:
        """P + jQ of each source. [VA]"""
        nodes = self.flow.nodes[self.network.sources.node]
        return nodes.voltage_v * nodes.leaving_current_a.conj()


def place(network: Network, loads: Loads, legs: Records[Leg] | None = None) -> Case:
    """Put the trains of `loads` onto the line, or onto the legs of their routes."""
    count = loads.trains.size
    flow = new_flow(network, count)
    legs = along_one_line(network.sections.size) if legs is None else legs
    locate_trains(count, loads.trains, legs, network, flow)
    measure_pieces(count, network, flow)
    order_points(network.bundles, network, flow)
    return Case(network, flow, loads)
