"""Small supply networks with constant loads, for tests of the load flow."""

import math
from dataclasses import dataclass

import numpy as np

from tpss.kernel import blank_records
from tpss.model.trains import build_machine
from tpss.physics.locomotive import TRAIN_TYPE
from tpss.powerflow.chain import place_trains, sort_by_position
from tpss.powerflow.network import SOURCE, Flow, Loads, Network, assemble, new_flow
from tpss.simulation.state import TRAIN

BT = complex(0.21, 0.20) * 1e-3
STIFF = {
    "no_load_voltage_v": 16_500.0,
    "installed": 1,
    "motor_voltage_v": 16_500.0,
    "rating_va": 10e6,
}
ROTARY = {
    **STIFF,
    "droop_v_per_var": 50e-6,
    "generator_reactance_ohm": 0.53 * 16.5**2 / 10,
    "motor_reactance_ohm": 0.49 * 16.5**2 / 10.7,
}


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


def sources(*kinds: tuple[int, dict[str, float]]) -> np.recarray:
    """Records of sources from pairs of node and parameters."""
    rows = blank_records(len(kinds), SOURCE)
    for row, (node, parameters) in zip(rows, kinds, strict=True):
        row.node = node
        for name, value in parameters.items():
            row[name] = value
    return rows


def constant_loads(positions_m: list[float], powers_va: list[complex]) -> Loads:
    """Trains that draw the same power at any voltage."""
    types = blank_records(len(powers_va), TRAIN_TYPE)
    types.inertia_kg, types.slip_factor = 1.0, 1.0
    types.filter_reactance_ohm = math.inf
    types.auxiliary_power_w = np.real(powers_va)
    types.auxiliary_reactive_power_var = np.imag(powers_va)
    trains = blank_records(len(powers_va), TRAIN)
    trains.train_type = np.arange(len(powers_va))
    trains.position_m = positions_m
    trains.per_efficiency = 1.0
    return Loads(trains, types, build_machine())


def place(network: Network, loads: Loads) -> Case:
    """Put the trains of `loads` onto the line."""
    count = loads.trains.size
    flow = new_flow(network, count)
    flow.standing.train = np.arange(count)
    sort_by_position(flow.standing, count, loads.trains)
    place_trains(count, loads.trains, network, flow)
    return Case(network, flow, loads)


def simple_line(
    length_m: float, positions_m: list[float], powers_va: list[complex], *ends: dict[str, float],
    impedance: complex = BT, susceptance: float = 0.0,
) -> Case:  # fmt: skip
    """A line of one section with a source at its start, and at its end if a second one is given."""
    network = assemble(
        2, [(0, 1, 0.0, length_m, impedance, susceptance)], [], sources(*enumerate(ends))
    )
    return place(network, constant_loads(positions_m, powers_va))
