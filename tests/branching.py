"""Kernels with every form that the conversion for lanes knows; each takes two numbers, and gives one."""

from tpss.kernel import kernel


@kernel
def returns_early(x: float, y: float) -> float:
    if x < 0.0:
        return -x
    if y > 1.0:
        x = x * y
        if x > 3.0:
            return x - 3.0
    return x + y


@kernel
def sets_in_branches(x: float, y: float) -> float:
    if x > y:
        large, small = x, y
    else:
        large, small = y, x
        if small < -1.0:
            small = -1.0
    large += 1.0
    return large * small


@kernel
def counts_turns(x: float, y: float) -> float:
    turns = 0
    while x > y and turns < 7:
        x /= 2.0
        turns += 1
        if x < 0.1:
            break
    return x + turns


@kernel
def _halved(x: float) -> float:
    return x / 2.0 if x > 1.0 else x


@kernel
def loops_over_bounds(x: float, y: float) -> float:
    first, end, total = 1 if x > 0.0 else 0, 4 if y > 0.0 else 3, 0.0
    for k in range(first, end):
        if k == 2 and x > y:
            continue
        total += k * _halved(y)
        if total > 5.0:
            return -total
    return total


@kernel
def joins_conditions(x: float, y: float) -> float:
    between = -1.0 <= x < 1.0
    if not between or (y > 0.0 and _halved(x) > 0.2):
        return 1.0 if x in (2.0, 3.0) else 2.0
    return min(x, y, 0.5) + max(abs(x), y) ** 2


KERNELS = (returns_early, sets_in_branches, counts_turns, loops_over_bounds, joins_conditions)
