"""Rectifiers whose valves are closed little by little: a start where stations of direct current block.

Which stations conduct and which block is what makes such a load flow hard: at a kink of their
characteristic Newton's method goes to and fro.  Raising the loads together helps little by itself, as
what trains offer and what they draw grow alike, so that a surplus stays a surplus.  So at first all
stations conduct in both directions, as a voltage behind a resistance does, and take the surplus; the
loads are raised on that line; then the conductance of the other direction is lowered by steps, each from
the solution of the one before, and at last it is 0.  Where a step fails, a smaller one is taken.
"""

import math

from tpss.kernel import at, inlined, kernel
from tpss.powerflow.chain import WARM
from tpss.powerflow.linked import newton_linked
from tpss.powerflow.network import Flow, Loads, Network
from tpss.powerflow.newton import MOST_PASSES, Solution, newton
from tpss.powerflow.path import set_aside, take_back
from tpss.sources.kinds import SourceKind

LOWERED = 0.1
"""Factor on the reverse conductance from step to step. [1]"""

CLOSED = 1e-4
"""Below this share of the forward conductance the next step closes the valves. [1]"""

SMALLEST_FACTOR_STEP = 0.9
"""A step that lowers the conductance by less than this factor is none. [1]"""


@kernel
def set_reverse(share: float, network: Network) -> bool:
    """Let all rectifiers conduct backwards with a share of their conductance; whether there are any."""
    rectifies = False
    for s in range(network.sources.size):
        source = network.sources[at(s)]
        if source.kind == SourceKind.RECTIFIER:
            source.rectifier.reverse_share = share
            rectifies = True
    return rectifies


@inlined
def solve_with_valves(share: float, network: Network, flow: Flow, loads: Loads) -> tuple[int, int]:
    """Solve with a share of reverse conductance; return a status and the passes."""
    set_reverse(share, network)
    status, passes = newton(1.0, WARM, MOST_PASSES, network, flow, loads)
    if status == Solution.NOT_CONVERGED:
        take_back(flow)
        status, more = newton_linked(1.0, network, flow, loads)
        passes += more
    return status, passes


@kernel
def open_valves(network: Network) -> bool:
    """Let all rectifiers conduct in both directions; whether there are any."""
    return set_reverse(1.0, network)


@kernel
def close_valves(solved: bool, network: Network, flow: Flow, loads: Loads) -> tuple[int, int]:
    """Close the valves of all rectifiers by steps; return a status, and the passes.

    Parameters
    ----------
    solved : bool
        Whether the state is that with all of them open; if not, they are closed at once.
    """
    share, factor, passes = 1.0, LOWERED, 0
    status: int = Solution.NOT_CONVERGED
    while solved and share > 0.0 and factor < SMALLEST_FACTOR_STEP:
        set_aside(flow)
        lowered = share * factor if share * factor >= CLOSED else 0.0
        status, more = solve_with_valves(lowered, network, flow, loads)
        passes += more
        if status == Solution.NOT_CONVERGED or status == Solution.WRONG_BRANCH:
            take_back(flow)
            factor = math.sqrt(factor)
        else:
            share, factor = lowered, max(LOWERED, factor * factor)
    set_reverse(0.0, network)
    return (status if share == 0.0 else Solution.NOT_CONVERGED), passes
