"""From a warm start to an honest end: the order in which a load flow is attempted.

1. Newton from the last step's state.
2. Newton from a flat start (all voltages at their base value).
3. Load continuation: all loads are raised together from zero, by steps that shrink where Newton
   fails.  What it reaches is on the stable branch; where it ends below the full load, no solution
   exists on that branch, and the share of the load that could be carried is the result.
"""

from tpss.kernel import at, inlined, kernel
from tpss.powerflow.chain import FLAT, WARM
from tpss.powerflow.network import Flow, Loads, Network
from tpss.powerflow.newton import Solution, newton

FIRST_STEP = 0.25
STEP_GROWTH = 1.5
SHORTEST_STEP = 1e-4
"""Continuation gives up where the load can grow by less than this share. [1]"""


@inlined
def predict(flow: Flow) -> None:
    """Start from the straight line through the solutions of the last two time steps."""
    for n in range(flow.nodes.size):
        node = flow.nodes[at(n)]
        node.voltage_v = 2.0 * node.last_v - node.before_v
    for s in range(flow.sections.size):
        section = flow.sections[at(s)]
        section.current_a = 2.0 * section.last_a - section.before_a


@inlined
def remember(first: int, flow: Flow) -> None:
    """Keep the solution of a time step for the prediction of the next; `first`: there is no other."""
    for n in range(flow.nodes.size):
        node = flow.nodes[at(n)]
        node.before_v = node.voltage_v if first else node.last_v
        node.last_v = node.voltage_v
    for s in range(flow.sections.size):
        section = flow.sections[at(s)]
        section.before_a = section.current_a if first else section.last_a
        section.last_a = section.current_a


@kernel
def start_flat(network: Network, flow: Flow) -> None:
    """Set the state without load: base voltage everywhere, no current."""
    for n in range(flow.nodes.size):
        flow.nodes[at(n)].voltage_v = network.system.base_voltage_v
    for s in range(flow.sections.size):
        flow.sections[at(s)].current_a = 0.0


@kernel
def _keep(flow: Flow) -> None:
    for n in range(flow.nodes.size):
        flow.nodes[at(n)].good_v = flow.nodes[at(n)].voltage_v
    for s in range(flow.sections.size):
        flow.sections[at(s)].good_a = flow.sections[at(s)].current_a


@kernel
def _restore(flow: Flow) -> None:
    for n in range(flow.nodes.size):
        flow.nodes[at(n)].voltage_v = flow.nodes[at(n)].good_v
    for s in range(flow.sections.size):
        flow.sections[at(s)].current_a = flow.sections[at(s)].good_a


@kernel
def continue_from_zero(network: Network, flow: Flow, loads: Loads) -> tuple[float, int]:
    """Raise all loads from zero; return the share of the load that is carried, and the passes.

    The state ends at the solution for that share, whether it is 1 or less.
    """
    start_flat(network, flow)
    _keep(flow)
    share, step, passes = 0.0, FIRST_STEP, 0
    while share < 1.0 and step >= SHORTEST_STEP:
        target = min(1.0, share + step)
        start = FLAT if share == 0.0 else WARM
        status, more = newton(target, start, network, flow, loads)
        passes += more
        if status == Solution.SOLVED:
            _keep(flow)
            share = target
            step *= STEP_GROWTH
        else:
            _restore(flow)
            step /= 2.0
    if 0.0 < share < 1.0:
        # The last trial has left its voltages at the trains; find those of the share again.
        newton(share, WARM, network, flow, loads)
    return share, passes


@inlined
def solve(warm: bool, network: Network, flow: Flow, loads: Loads) -> tuple[float, int]:
    """Solve a load flow.

    Parameters
    ----------
    warm : bool
        Whether `flow` holds the state of a similar load flow.

    Returns
    -------
    share : float
        1.0, or the share of all loads beyond which no solution was found; `flow` then holds the
        state at that share.
    passes : int
        Evaluations of the whole network.
    """
    passes = 0
    if warm:
        status, passes = newton(1.0, WARM, network, flow, loads)
        if status == Solution.SOLVED:
            return 1.0, passes
    start_flat(network, flow)
    status, more = newton(1.0, FLAT, network, flow, loads)
    passes += more
    if status == Solution.SOLVED:
        return 1.0, passes
    share, more = continue_from_zero(network, flow, loads)
    return share, passes + more
