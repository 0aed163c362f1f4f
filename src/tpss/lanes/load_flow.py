"""The load flow of all cases together: Newton's method in lock-step.

All take the same passes; a case that is solved waits.  One that no whole step brings closer, or that
asks for a search, is left unsolved: its run is made alone.
"""

import math
from typing import Any

from tpss.lanes.compile import by_hand, compiled, lane_version
from tpss.lanes.masks import anyone, as_lane_int, as_lanes, both, negated, select
from tpss.powerflow.chain import CHECK, WARM
from tpss.powerflow.newton import (
    CLOSE,
    MOST_PASSES,
    Solution,
    _conclude,
    evaluate,
    find_direction,
    mark_base,
    take_step,
)
from tpss.powerflow.solve import ASKS, solve_or_ask, stations_jumped

_evaluate, _find_direction, _conclude_lanes, _stations_jumped = (
    lane_version(each)[0] for each in (evaluate, find_direction, _conclude, stations_jumped)
)
_mark_base, _take_step = lane_version(mark_base)[0], lane_version(take_step)[0]
_SOLVED, _NOT_CONVERGED = int(Solution.SOLVED), int(Solution.NOT_CONVERGED)
_MOST = int(MOST_PASSES)


@compiled(fused=False)
def newton(network: Any, flow: Any, loads: Any, mask: Any) -> tuple[Any, Any]:
    """`powerflow.newton` from a warm start, without its shorter steps; statuses and passes.

    The passes are those that each case would take alone: one that would look first, without
    derivatives, is not asked to where others need theirs.
    """
    left = both(mask, as_lanes(0.0) == 0.0)
    status, passes = as_lane_int(_NOT_CONVERGED), as_lane_int(0)
    merit, sign = as_lanes(math.inf), as_lanes(1.0)
    looks = negated(as_lanes(0.0) == 0.0)
    kind = WARM
    for turn in range(_MOST):
        if turn > 0:
            _take_step(1.0, flow, left)
        mismatch, trial, chains = _evaluate(1.0, kind, network, flow, loads, left)
        solved = both(left, mismatch < network.tolerance)
        twice = both(looks, negated(solved)) if kind != CHECK else negated(looks)
        passes = select(left, passes + select(twice, 2, 1), passes)
        if kind != CHECK:
            nearer = both(left, trial < merit)
            nearer = select(solved, left, nearer)
            sign = select(nearer, chains * _find_direction(network, flow, nearer), sign)
            merit = select(nearer, trial, merit)
            left = nearer
        if anyone(solved):
            status = select(solved, _conclude_lanes(sign, network, flow, solved), status)
            left = both(left, negated(solved))
        if not anyone(left):
            break
        if kind == CHECK:
            kind = WARM  # the derivatives at the same place
            looks = both(left, negated(left))
            continue
        looks = both(left, mismatch < CLOSE)
        kind = WARM if anyone(both(left, negated(looks))) else CHECK
        _mark_base(flow, left)
    return status, passes


@compiled(fused=False)
def solve(warm: Any, network: Any, flow: Any, loads: Any, mask: Any) -> tuple[Any, Any]:
    """`powerflow.solve.solve_or_ask` in every step but the first of a run."""
    status, passes = newton(network, flow, loads, mask)
    solved = both(mask, status == _SOLVED)
    jumped = _stations_jumped(network, flow, loads, solved)
    return select(both(solved, negated(jumped)), 1.0, ASKS), passes


by_hand[solve_or_ask] = solve, True
