"""The load flow of all cases together: Newton's method in lock-step.

All take the same passes; a case that is solved waits.  One that no step brings closer, or that asks for
a search, is left unsolved: its run is made alone.
"""

import math
from typing import Any

from tpss.lanes.compile import by_hand, compiled, lane_version
from tpss.lanes.masks import anyone, as_lane_int, as_lanes, both, either, negated, select
from tpss.powerflow.chain import CHECK, WARM
from tpss.powerflow.newton import (
    CLOSE,
    MOST_HALVINGS,
    MOST_PASSES,
    Solution,
    conclude,
    evaluate,
    find_direction,
    mark_base,
    take_step,
)
from tpss.powerflow.solve import ASKS, solve_or_ask, stations_jumped

_evaluate, _find_direction, _conclude, _stations_jumped = (
    lane_version(each)[0] for each in (evaluate, find_direction, conclude, stations_jumped)
)
_mark_base, _take_step = lane_version(mark_base)[0], lane_version(take_step)[0]
_SOLVED, _NOT_CONVERGED = int(Solution.SOLVED), int(Solution.NOT_CONVERGED)
_MOST = int(MOST_PASSES)


@compiled(fused=False)
def newton(network: Any, flow: Any, loads: Any, mask: Any) -> tuple[Any, Any]:
    """`powerflow.newton` from a warm start: statuses and passes.

    The passes are those that each case would take alone: one that would look first, without
    derivatives, is not asked to where others need theirs.
    """
    everyone = as_lanes(0.0) == 0.0
    left, looks = both(mask, everyone), negated(everyone)
    status, passes = as_lane_int(_NOT_CONVERGED), as_lane_int(0)
    merit, sign, size, trials = as_lanes(math.inf), as_lanes(1.0), as_lanes(1.0), as_lane_int(1)
    kind = WARM
    for turn in range(_MOST):
        if turn > 0:
            _take_step(size, flow, left)
        mismatch, trial, chains = _evaluate(1.0, kind, network, flow, loads, left)
        solved = both(left, mismatch < network.tolerance)
        if kind == CHECK:
            passes, nearer = passes + select(left, 1, 0), solved
        else:
            passes = passes + select(left, select(both(looks, negated(solved)), 2, 1), 0)
            nearer = either(solved, both(left, trial < merit))
            farther = both(left, negated(nearer))
            ends = both(farther, either(merit == math.inf, trials == MOST_HALVINGS))
            sign = select(nearer, chains * _find_direction(network, flow, nearer), sign)
            merit = select(nearer, trial, merit)
            size = select(farther, size / 2.0, 1.0)
            trials = select(farther, trials + 1, 1)
            left = both(left, negated(ends))
        if anyone(solved):
            status = select(solved, _conclude(sign, network, flow, solved), status)
            left = both(left, negated(solved))
        if not anyone(left):
            break
        if kind == CHECK:
            kind, looks = WARM, negated(everyone)  # the derivatives at the same place
            continue
        nearer = both(left, nearer)
        _mark_base(flow, nearer)
        looks = both(nearer, mismatch < CLOSE)
        kind = WARM if anyone(both(left, negated(looks))) else CHECK
    return status, passes


@compiled(fused=False)
def solve(_warm: Any, network: Any, flow: Any, loads: Any, mask: Any) -> tuple[Any, Any]:
    """`powerflow.solve.solve_or_ask` in every step but the first of a run."""
    status, passes = newton(network, flow, loads, mask)
    solved = both(mask, status == _SOLVED)
    jumped = _stations_jumped(network, flow, loads, solved)
    return select(both(solved, negated(jumped)), 1.0, ASKS), passes


by_hand[solve_or_ask] = solve, True
