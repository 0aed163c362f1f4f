"""From a warm start to an honest end: the order in which a load flow is attempted.

1. Newton from the last step's state.
2. Newton from a flat start (all voltages at their base value).
3. Linked Newton steps (`powerflow.linked`) from the last step's state: behind many trains whose current
   is limited, Newton over the nodes alone would have to begin very close.
4. On lines of direct current: the same as follows with rectifiers that conduct in both directions,
   whose valves are closed then (`powerflow.valves`).  On all lines: load continuation from base
   voltage, all loads raised together from zero, by steps that shrink where Newton fails.
5. The paths of `powerflow.path`, with ever smaller steps: the state without load from that of like
   sources; from there the loads, to the whole of them or to the end of the path, also through states
   that are implausible; and once more, with the loads raised first and the sources brought apart then.
   Where no path leads to the whole load, the share at which that of the loads ends is the result, and
   `Flow.search` says how it ended.
6. 3 to 5 again with slopes from the other side, where the path was lost: trains on their passage have
   slopes by differences, over a voltage a little above.  Just below the knee of a demand these belong
   to neither side, and Newton's method goes past the solution again and again.

What 1 to 4 find has the sign of the determinant that belongs to the stable branch, but another branch
may have it as well: stations out of phase can feed each other.  So where the stations' powers have
changed by more than the trains draw, the solution is held against the one to which the path from the
state without load leads, and that one counts.

A sound line needs 1 and 2 only.  So the clock's kernel does these, and asks for the rest, which Python
has done by a kernel that is compiled when it is needed.
"""

from tpss.kernel import at, inlined, kernel, switch
from tpss.numerics.pairs import magnitude
from tpss.powerflow.bundle_state import predict_bundles, remember_bundles
from tpss.powerflow.chain import FLAT, WARM
from tpss.powerflow.keeping import bring_back, keep_all
from tpss.powerflow.linked import newton_linked
from tpss.powerflow.network import Ending, Flow, Loads, Network, Request
from tpss.powerflow.newton import MOST_PASSES, Solution, newton
from tpss.powerflow.path import (
    BEYOND,
    LOADS,
    LOADS_OF_LIKE_SOURCES,
    SOURCES_LOADED,
    SOURCES_UNLOADED,
    STRICT,
    follow,
    note_ending,
    predict_on_path,
    set_aside,
    start_alike,
    take_back,
)
from tpss.powerflow.raising import continue_from_zero, start_flat
from tpss.powerflow.valves import close_valves, open_valves

UNSUSPICIOUS = 0.5
"""Changes of the stations' powers up to this are not looked into. [p.u. of the base power]"""

OF_DRAWN = 4.0
"""How many times what the trains draw, now or a step ago, they may change by besides."""

ASKS = -1.0
"""In place of the share that is carried: a search is asked for. [1]"""

SOLVED, UNSOLVED = switch(Solution.SOLVED), switch(Solution.NOT_CONVERGED)

SAME_ROOT = 1e-6
"""Solutions closer than this are the same one. [p.u. of the base voltage]"""


@inlined
def predict(flow: Flow) -> None:
    """Start from the straight line through the solutions of the last two time steps."""
    for n in range(flow.nodes.size):
        node = flow.nodes[at(n)]
        node.voltage_v = 2.0 * node.last_v - node.before_v
    for s in range(flow.sections.size):
        section = flow.sections[at(s)]
        section.current_a = 2.0 * section.last_a - section.before_a
    predict_bundles(flow.bundles)


@inlined
def remember(first: int, flow: Flow) -> None:
    """Keep the solution of a time step for the prediction of the next; `first`: there is no other."""
    for n in range(flow.nodes.size):
        node = flow.nodes[at(n)]
        node.before_v = node.voltage_v if first else node.last_v
        node.last_v = node.voltage_v
        node.last_leaving_a = node.leaving_current_a
    flow.search[0].last_drawn_va = flow.search[0].drawn_va
    for s in range(flow.sections.size):
        section = flow.sections[at(s)]
        section.before_a = section.current_a if first else section.last_a
        section.last_a = section.current_a
    remember_bundles(flow.bundles, first)


@inlined
def start_from_last(flow: Flow, loads: Loads) -> None:
    """Start with all voltages, those at the trains too, from the last time step."""
    predict(flow)
    for s in range(flow.sections.size):
        section = flow.sections[at(s)]
        for k in range(section.first, section.end):
            place = flow.standing[at(k)]
            place.voltage_v = loads.trains[at(place.train)].line_voltage_v


@inlined
def find_state_without_load(network: Network, flow: Flow, loads: Loads) -> tuple[bool, int]:
    """Bring the sources apart without load; return whether that succeeded, and the passes.

    Where their path ends before, `flow.search` says how, and Newton's method tries it from base voltage.
    """
    start_alike(network, flow)
    reached, _, passes = follow(0.0, SOURCES_UNLOADED, BEYOND, network, flow, loads)
    if reached == 1.0:
        return True, passes
    more = note_ending(reached, SOURCES_UNLOADED, network, flow, loads)
    passes += more
    flow.search[0].without_load = True
    start_flat(network, flow)
    status, more = newton(0.0, WARM, MOST_PASSES, network, flow, loads)
    if status != Solution.SOLVED:
        predict_on_path(0.0, flow)
    return status == Solution.SOLVED, passes + more


@inlined
def raise_loads(share: float, network: Network, flow: Flow, loads: Loads) -> tuple[float, int]:
    """Follow the path of the loads from a share of them; return its end and the passes.

    The share is that up to which all states are plausible, unless the whole load has a plausible one.
    `flow.search` says why: that the band is left, or a source out of step, only if the path has an end
    beyond, or leads out for good.
    """
    outcome = flow.search[0]
    share, status, passes = follow(share, LOADS, STRICT, network, flow, loads)
    end, after = share, status
    left = status == Solution.IMPLAUSIBLE or status == Solution.OUT_OF_STEP
    if share < 1.0 and left:
        set_aside(flow)
        end, after, more = follow(share, LOADS, BEYOND, network, flow, loads)
        passes += more
    outcome.ending = Ending.FOUND
    if end == 1.0 and after == Solution.SOLVED:
        return end, passes
    if end < 1.0:
        passes += note_ending(end, LOADS, network, flow, loads)
    if left:
        take_back(flow)
        if outcome.ending != Ending.LOST:
            left_band = status == Solution.IMPLAUSIBLE
            outcome.ending = Ending.LEFT_BAND if left_band else Ending.OUT_OF_STEP
    return share, passes


@inlined
def bring_loaded_sources_apart(network: Network, flow: Flow, loads: Loads) -> tuple[bool, int]:
    """Raise the loads of like sources, then bring these apart; return whether there is a solution."""
    start_alike(network, flow)
    reached, _, passes = follow(0.0, LOADS_OF_LIKE_SOURCES, BEYOND, network, flow, loads)
    if reached < 1.0:
        return False, passes
    reached, status, more = follow(0.0, SOURCES_LOADED, BEYOND, network, flow, loads)
    return reached == 1.0 and status == Solution.SOLVED, passes + more


@inlined
def search(
    known: bool, carried: float, network: Network, flow: Flow, loads: Loads
) -> tuple[float, int]:
    """Look for a solution by paths; return the share of the load that is carried, and the passes.

    Parameters
    ----------
    known : bool
        Whether the state is that without load.
    carried : float
        Share whose solution was put aside, for the case that it is not. [1]
    """
    outcome, share, passes = flow.search[0], 0.0, 0
    if not known and carried > 0.0:
        take_back(flow)
        known, share = True, carried
    # 1. The loads.
    if known:
        share, passes = raise_loads(share, network, flow, loads)
        outcome.without_load = False
        if share == 1.0:
            return share, passes
    # 2. The sources, after the loads.
    set_aside(flow)
    found, more = bring_loaded_sources_apart(network, flow, loads)
    passes += more
    if found:
        outcome.ending, outcome.without_load = Ending.FOUND, False
        return 1.0, passes
    # 3. The end of the loads' path; the last trials have left their voltages at the trains.
    take_back(flow)
    if known:
        newton(share, WARM, MOST_PASSES, network, flow, loads)
    return share, passes


@inlined
def drawn_power(flow: Flow, loads: Loads) -> float:
    """Powers of the trains on the line and of stores, active and reactive ones without sign. [VA]"""
    drawn_va = 0.0
    for s in range(flow.sections.size):
        for k in range(flow.sections[at(s)].first, flow.sections[at(s)].end):
            demand = loads.trains[at(flow.standing[at(k)].train)].demand
            drawn_va += abs(demand.active_power_w) + abs(demand.reactive_power_var)
    for m in range(flow.stores.size):
        drawn_va += abs(flow.stores[at(m)].power_w)
    return drawn_va


@inlined
def stations_jumped(network: Network, flow: Flow, loads: Loads) -> bool:
    """Whether the stations' powers have changed since the last time step by more than trains explain."""
    drawn_va, change_va = drawn_power(flow, loads), 0.0
    for s in range(network.sources.size):
        node = flow.nodes[at(network.sources[at(s)].node)]
        before = node.last_v * node.last_leaving_a.conjugate()
        change_va += magnitude(node.voltage_v * node.leaving_current_a.conjugate() - before)
    flow.search[0].drawn_va = drawn_va
    explained_va = OF_DRAWN * max(drawn_va, flow.search[0].last_drawn_va)
    return change_va > explained_va + UNSUSPICIOUS * network.system.base_power_va


@kernel
def differs_from_aside(network: Network, flow: Flow) -> bool:
    """Whether a state is another one than that put aside."""
    largest_v = 0.0
    for n in range(flow.nodes.size):
        node = flow.nodes[at(n)]
        largest_v = max(largest_v, magnitude(node.voltage_v - node.aside_v))
    return largest_v > SAME_ROOT * network.system.base_voltage_v


@inlined
def take_root_of_path(known: bool, network: Network, flow: Flow, loads: Loads) -> int:
    """Take the solution to which the path from no load leads, if it does; return the passes.

    Where it is the one that was put aside, or the path does not reach the whole load, that one stays.
    """
    flow.search[0].ending, flow.search[0].without_load = Ending.FOUND, False
    passes = 0
    if known:
        share, status, passes = follow(0.0, LOADS, BEYOND, network, flow, loads)
        if share == 1.0 and status == Solution.SOLVED and differs_from_aside(network, flow):
            return passes
    take_back(flow)
    _, more = newton(1.0, WARM, MOST_PASSES, network, flow, loads)
    return passes + more


@kernel
def solve_from_zero(solved: int, network: Network, flow: Flow, loads: Loads) -> tuple[float, int]:
    """Steps 3 to 5; or hold the solution in `flow` against that of the path, if it is `SOLVED`.

    Return the share of the load that is carried, and the passes.  All that is rarely asked for is one
    kernel, as each that calls `newton` takes seconds to compile.
    """
    share, passes = 1.0, 0
    if solved != Solution.SOLVED:
        if flow.search[0].warm:
            start_from_last(flow, loads)
            status, passes = newton_linked(1.0, network, flow, loads)
            if status == Solution.SOLVED:
                return 1.0, passes
        if open_valves(network):
            share, more = continue_from_zero(network, flow, loads)
            passes += more
            status, more = close_valves(share == 1.0, network, flow, loads)
            passes += more
            if status == Solution.SOLVED:
                return 1.0, passes
        share, more = continue_from_zero(network, flow, loads)
        passes += more
        if share == 1.0:
            return share, passes
    flow.search[0].ending, flow.search[0].without_load = Ending.FOUND, False
    set_aside(flow)
    known, more = find_state_without_load(network, flow, loads)
    passes += more
    if solved != Solution.SOLVED:
        share, more = search(known, share, network, flow, loads)
    else:
        more = take_root_of_path(known, network, flow, loads)
    return share, passes + more


@inlined
def solve_or_ask(warm: bool, network: Network, flow: Flow, loads: Loads) -> tuple[float, int]:
    """Solve a load flow as far as steps 1 and 2 do, or ask in `flow.search` for what they cannot do.

    Once that is done (`answer`), a second call gives what it has found.

    Parameters
    ----------
    warm : bool
        Whether `flow` holds the state of a similar load flow.

    Returns
    -------
    share : float
        1.0, or the share of all loads beyond which no solution was found; `flow` then holds the
        state at that share, and in `search` why that is the end.  `ASKS`, if a search is asked for.
    passes : int
        Evaluations of the whole network since the last call.
    """
    asked, passes = flow.search[0], 0
    if asked.request == Request.ANSWERED:
        asked.request = Request.NOTHING
        return asked.share, asked.passes
    asked.warm = warm
    status: int = Solution.NOT_CONVERGED
    for start in (WARM, FLAT):
        if status != Solution.SOLVED and (warm or start == FLAT):
            if start == FLAT:
                start_flat(network, flow)
            status, more = newton(1.0, start, MOST_PASSES, network, flow, loads)
            passes += more
    if status != Solution.SOLVED:
        asked.request = Request.SOLUTION
    elif stations_jumped(network, flow, loads):
        asked.request = Request.CONFIRMATION
    else:
        return 1.0, passes
    return ASKS, passes


@kernel
def answer(network: Network, flow: Flow, loads: Loads) -> None:
    """Search for what `solve_or_ask` asks for.

    Few runs ever ask, so this is called from Python: it is compiled when it is needed.
    """
    asked, share, passes = flow.search[0], 1.0, 0
    jumped = asked.request == Request.CONFIRMATION
    if not jumped:
        share, passes = solve_from_zero(UNSOLVED, network, flow, loads)
        jumped = share == 1.0 and stations_jumped(network, flow, loads)
    if jumped:
        _, more = solve_from_zero(SOLVED, network, flow, loads)
        passes += more
    asked.share, asked.passes = share, passes
    asked.request = Request.ANSWERED


def answer_in_turn(network: Network, flow: Flow, loads: Loads) -> None:
    """`answer`, and what it does not find from the other side."""
    answer(network, flow, loads)
    asked = flow.search[0]
    if asked.share < 1.0 and asked.ending == Ending.LOST:
        answer_from_other_side(network, flow, loads)


def answer_from_other_side(network: Network, flow: Flow, loads: Loads) -> None:
    """`answer` with slopes over voltages on the other side; what was found stays if it finds no more."""
    driving, asked, kept = loads.driving, flow.search[0], keep_all(flow, loads)
    change = -driving.options.slope_change
    turned = driving._replace(options=driving.options._replace(slope_change=change))
    passes, asked.request = asked.passes, Request.SOLUTION
    answer(network, flow, loads._replace(driving=turned))
    if asked.share < 1.0:
        bring_back(kept, flow, loads)
    else:
        asked.passes += passes


def solve(warm: bool, network: Network, flow: Flow, loads: Loads) -> tuple[float, int]:
    """Solve a single load flow, with a search if need be; as `solve_or_ask`."""
    share, passes = solve_or_ask(warm, network, flow, loads)
    if share == ASKS:
        answer_in_turn(network, flow, loads)
        share, more = solve_or_ask(warm, network, flow, loads)
        passes += more
    return share, passes
