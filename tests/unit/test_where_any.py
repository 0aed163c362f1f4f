"""What is compiled for those only who have any of it."""

import numba
import numpy as np
import pytest

from tpss.kernel import where_any


def _nothing(_part, amount):
    return amount


@where_any(without=_nothing)
def add_all(part, amount):
    """An amount, and all numbers of an array that is the only item of a part."""
    for k in range(part[0].size):
        amount += part[0][k]
    return amount


@numba.njit
def twice(part, amount):
    return 2.0 * add_all(part, amount)


@pytest.mark.parametrize(("part", "expected"), [((), 2.0), ((np.array([3.0, 4.0]),), 16.0)])
def test_a_part_that_is_not_there_is_an_empty_tuple(part, expected):
    """2 (1 + 3 + 4) with two numbers, 2 * 1 without: where there is no array, none is asked for."""
    assert twice(part, 1.0) == expected
    assert twice.py_func(part, 1.0) == expected
