"""All loads raised together, from the state without load, by steps that shrink where Newton fails."""

from tpss.kernel import at, kernel
from tpss.powerflow.bundle_points import start_bundles
from tpss.powerflow.bundle_state import flat_voltage
from tpss.powerflow.chain import FLAT, WARM
from tpss.powerflow.network import Flow, Loads, Network
from tpss.powerflow.newton import MOST_PASSES, Solution, newton
from tpss.powerflow.path import set_aside, take_back

FIRST_STEP = 0.25
STEP_GROWTH = 1.5
SHORTEST_STEP = 1e-4
"""Continuation gives up where the load can grow by less than this share. [1]"""


@kernel
def start_flat(network: Network, flow: Flow) -> None:
    """Set the state without load: base voltage everywhere, no current."""
    for n in range(flow.nodes.size):
        base_v = complex(network.system.base_voltage_v, 0.0)
        flow.nodes[at(n)].voltage_v = flat_voltage(network.bundles, n, base_v)
    for s in range(flow.sections.size):
        flow.sections[at(s)].current_a = 0.0
    start_bundles(network.bundles, network, flow)


@kernel
def continue_from_zero(network: Network, flow: Flow, loads: Loads) -> tuple[float, int]:
    """Raise all loads from zero; return the share of the load that is carried, and the passes.

    The state ends at the solution for that share, whether it is 1 or less.
    """
    start_flat(network, flow)
    set_aside(flow)
    share, step, passes = 0.0, FIRST_STEP, 0
    while share < 1.0 and step >= SHORTEST_STEP:
        target = min(1.0, share + step)
        start = FLAT if share == 0.0 else WARM
        status, more = newton(target, start, MOST_PASSES, network, flow, loads)
        passes += more
        if status == Solution.SOLVED:
            set_aside(flow)
            share = target
            step *= STEP_GROWTH
        else:
            take_back(flow)
            step /= 2.0
    if 0.0 < share < 1.0:
        # The last trial has left its voltages at the trains; find those of the share again.
        newton(share, WARM, MOST_PASSES, network, flow, loads)
    return share, passes
