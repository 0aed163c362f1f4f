"""A law is tried before it is used: whether it finds numbers, and slopes that belong to them."""

import itertools
import math
from collections.abc import Iterable, Sequence

from tpss.laws.law import Law, LawError

CHANGE = 1e-4
"""Change of a power, of the largest one tried, by which slopes are compared with differences. [1]"""

CLOSE = 1e-4
"""By how much a slope may differ from that of a difference, of what it changes over the range. [1]"""


_MEND = "mend the law, or choose other parameters"


def try_law(law: Law, values: Sequence[float], tried: Iterable[tuple[float, ...]]) -> None:
    """Demand that a law finds finite numbers.

    Parameters
    ----------
    law : Law
    values : sequence of float
        Values of its parameters.
    tried : iterable of tuple
        What it is given, one after the other.

    Raises
    ------
    LawError
        It raises an error, or does not find as many numbers as it should, or one is not a number.
    """
    for given in tried:
        found = numbers_of(law, values, given)
        for quantity, value in zip(law.kind.found, found, strict=True):
            if math.isnan(value) or (math.isinf(value) and not quantity.may_be_infinite):
                raise LawError(
                    f"the law {law.name!r} finds {quantity.name} = {value} at {_in_words(law, given)}",
                    _MEND,
                )


def numbers_of(law: Law, values: Sequence[float], given: tuple[float, ...]) -> tuple[float, ...]:
    """What a law finds, by plain Python.

    Raises
    ------
    LawError
        It raises an error, or does not find as many numbers as it should.
    """
    try:
        found = law.function(*given, *values)
        numbers = tuple(map(float, found if isinstance(found, tuple) else (found,)))
    except Exception as error:  # of somebody else's function, any
        raise LawError(
            f"the law {law.name!r} fails at {_in_words(law, given)}: {type(error).__name__}: {error}",
            _MEND,
        ) from error
    names = [each.name for each in law.kind.found]
    if len(numbers) != len(names):
        raise LawError(
            f"the law {law.name!r} finds {len(numbers)} numbers",
            f"let it find ({', '.join(names)})",
        )
    return numbers


def _in_words(law: Law, given: tuple[float, ...]) -> str:
    pairs = zip(law.kind.given, given, strict=True)
    return ", ".join(f"{quantity.name} = {value:g}" for quantity, value in pairs)


def try_converter(law: Law, values: Sequence[float], rated_va: float) -> None:
    """Demand a voltage within the rating, and slopes that belong to voltage and angle.

    Raises
    ------
    LawError
        See `try_law`; or the voltage is not positive, or a slope does not fit.
    """
    shares = (-1.0, -0.4, 0.0, 0.3, 1.0)
    grid = [(p * rated_va, q * rated_va) for p, q in itertools.product(shares, shares)]
    try_law(law, values, grid)
    for given in grid:
        if (voltage := numbers_of(law, values, given)[0]) <= 0.0:
            raise LawError(
                f"the law {law.name!r} finds voltage_v = {voltage:g} at {_in_words(law, given)}",
                _MEND,
            )
    at_rest = numbers_of(law, values, (0.0, 0.0))
    sizes = (at_rest[0], 1.0)
    for given, (axis, k) in itertools.product(grid, itertools.product((0, 1), (0, 1))):
        _compare_slope(law, values, given, axis, k, sizes[k], rated_va)


def _compare_slope(
    law: Law, values: Sequence[float], given: tuple[float, ...], axis: int, k: int, size: float,
    rated_va: float,
) -> None:  # fmt: skip
    """Compare the slope of voltage (k = 0) or angle (1) over a power with a difference."""
    change = CHANGE * rated_va
    before, after = list(given), list(given)
    before[axis] -= change
    after[axis] += change
    low, high = numbers_of(law, values, tuple(before))[k], numbers_of(law, values, tuple(after))[k]
    by_difference = (high - low) / (2.0 * change)
    place = 2 + 2 * k + axis
    slope = numbers_of(law, values, given)[place]
    if abs(slope - by_difference) * rated_va > CLOSE * size:
        raise LawError(
            f"the law {law.name!r} finds {law.kind.found[place].name} = {slope:.6g} at "
            f"{_in_words(law, given)}, where a difference of {law.kind.found[k].name} gives "
            f"{by_difference:.6g}",
            "mend the slope: the load flow needs those that belong to the law",
        )
