"""Arrays that kernels hand to one another as an address and a shape are the arrays that they were."""

from typing import NamedTuple

import numba
import numpy as np
import pytest

from tpss.kernel import compiles, kernel
from tpss.kernel_arrays import KernelArray, handed_over
from tpss.record import Record


class Weight(Record):
    mass_kg: float
    count: int


class Ours(NamedTuple):
    line: np.ndarray
    plane: np.ndarray
    weights: np.ndarray


class Theirs(NamedTuple):
    line: np.ndarray


Ours.__module__ = "tpss.made_up"


def ours():
    """Of 3 × 4 numbers 0 to 11, four numbers 1 to 4, and weights of 5 and 7 kg."""
    weights = Weight.array([(5.0, 2), (7.0, 3)])
    return Ours(np.arange(1.0, 5.0), np.arange(12.0).reshape(3, 4), weights)


@kernel
def weigh(row, plane, weights):
    total = 0.0
    for j in range(row.size):
        total += row[j] * plane[2, j]
    return total, weights[1].mass_kg * weights[1].count, plane.size + 10 * weights.size


@kernel
def hand_over(of, last):
    return (
        weigh(of.plane[1], of.plane, of.weights),
        weigh(of.plane[:, 1], of.plane, of.weights),
        last,
    )


@kernel
def give_back(of):
    return of


def test_rows_columns_and_records_are_what_they_were():
    """Row 1 is 4 to 7, column 1 is 1, 5, 9, row 2 is 8 to 11:

    4·8 + 5·9 + 6·10 + 7·11 = 214;  1·8 + 5·9 + 9·10 = 143;  7 kg · 3 = 21 kg;  12 + 10·2 = 32
    """
    assert hand_over(ours(), 1) == ((214.0, 21.0, 32), (143.0, 21.0, 32), 1)


def test_what_a_kernel_writes_is_in_the_array():
    @kernel
    def write(plane, weights):
        plane[1, 2] = -1.0
        weights[0].count = 9

    @kernel
    def write_through(of):
        write(of.plane, of.weights)

    given = ours()
    write_through(given)
    assert given.plane[1, 2] == -1.0
    assert given.weights[0].count == 9


def test_arrays_of_this_package_only_are_handed_over_so():
    own = numba.typeof(ours())
    assert all(isinstance(part, KernelArray) for part in own)
    assert isinstance(numba.typeof(ours().weights), KernelArray)
    foreign = np.zeros(2, dtype=[("mass_kg", float)]).view(np.recarray)
    for given in (np.zeros(2), foreign):
        assert not isinstance(numba.typeof(given), KernelArray)
        assert not isinstance(numba.typeof(Theirs(given)).types[0], KernelArray)


def test_an_array_is_two_words_a_plane_three_and_a_view_of_it_its_strides_too():
    manager = numba.core.datamodel.default_manager

    def words(array):
        return len(
            numba.core.datamodel.ArgPacker(
                manager, [handed_over(numba.typeof(array))]
            ).argument_types
        )

    plane = np.zeros((3, 4))
    assert [words(array) for array in (plane[0], plane, plane[:, ::2])] == [2, 3, 5]


@pytest.mark.skipif(not hasattr(give_back, "overloads"), reason="nothing is compiled")
@pytest.mark.skipif(not compiles(), reason="plain Python gives back what it likes")
def test_a_call_from_python_that_would_return_arrays_is_refused():
    with pytest.raises(SystemError) as refused:
        give_back(ours())
    assert "call the plain function" in str(refused.value.__cause__)
