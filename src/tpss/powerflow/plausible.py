"""Whether a state without mismatch is one of a sound line, and not another root of its equations."""

from tpss.kernel import at, inlined
from tpss.numerics.pairs import squared
from tpss.powerflow.bundle_state import lies_in_band
from tpss.powerflow.network import UNFED, Flow, Network
from tpss.sources.kinds import is_plausible


@inlined
def voltages_are_plausible(network: Network, flow: Flow) -> bool:
    """Whether every node and train that is fed lies in the band that a sound line never leaves."""
    low = network.system.lowest_voltage_v**2
    high = network.system.highest_voltage_v**2
    for n in range(flow.nodes.size):
        plausible = low <= squared(flow.nodes[at(n)].voltage_v) <= high
        if plausible or network.source_of_node[at(n)] == UNFED:
            continue
        if lies_in_band(network.bundles, n):
            return False
    for s in range(flow.sections.size):
        for k in range(flow.sections[at(s)].first, flow.sections[at(s)].end):
            if not low <= squared(flow.standing[at(k)].voltage_v) <= high:
                return False
    return True


@inlined
def sources_are_plausible(network: Network, flow: Flow) -> bool:
    """Whether every source in service is in a state that its law admits."""
    for s in range(network.sources.size):
        source = network.sources[at(s)]
        node, running = flow.nodes[at(source.node)], flow.sources[at(s)].running
        if running == 0.0:
            continue
        if not is_plausible(node.voltage_v, node.leaving_current_a, running, source):
            return False
    return True
