"""Stores of energy at the nodes: loads whose power follows the voltage, and their limits in a step.

The current of a store at a node joins those that leave it, so a node with a source obeys its law with
what it feeds into the line and the store together.  Its derivatives are those of a train (see `chain`).
"""

import math

from tpss.kernel import at, kernel
from tpss.numerics.pairs import scaled, squared
from tpss.powerflow.network import UNFED, Flow, Network
from tpss.storage.store import begin_store
from tpss.storage.wayside import power_at_voltage


@kernel
def begin_stores(step_s: float, network: Network, flow: Flow) -> None:
    """Find the limits of the stores at the line in a step of this length. [s]"""
    for m in range(network.stores.size):
        begin_store(step_s, network.stores[at(m)].store, flow.stores[at(m)])


@kernel
def add_stores(derivatives: bool, network: Network, flow: Flow) -> None:
    """Add the currents of the stores to those that leave their nodes, and to the linear system.

    Where no source reaches the node, a store rests.
    """
    for m in range(network.stores.size):
        law, state = network.stores[at(m)], flow.stores[at(m)]
        state.power_w = 0.0
        if network.source_of_node[at(law.node)] == UNFED:
            continue
        node = flow.nodes[at(law.node)]
        square = squared(node.voltage_v)
        magnitude = math.sqrt(square)
        power, slope = power_at_voltage(magnitude, law, state)
        state.power_w = power
        reciprocal = scaled(node.voltage_v, 1.0 / square)  # 1 / conj(V)
        current = power * reciprocal
        node.leaving_current_a += current
        if derivatives:
            y1 = 0.5 * slope / magnitude
            block = flow.blocks[at(law.node)]
            block.p += y1
            block.q += (y1 * node.voltage_v - current) * reciprocal
