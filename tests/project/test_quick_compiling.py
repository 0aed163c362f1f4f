"""Compiled quickly, code is the same as by the passes of numba."""

import re
from contextlib import nullcontext

import numba
import numpy as np
import pytest

from tpss import quick_compiling as quick
from tpss.kernel import compiles
from tpss.quick_compiling import quick_compiling
from tpss.record import Record

pytestmark = pytest.mark.skipif(not compiles(), reason="compilation is switched off")


class Point(Record):
    x: float
    y: float


@numba.njit(inline="always")
def _reached(points, k, scale):
    if points[k].x > points[k].y:
        scale = -scale
    return scale * points[k].y


def _sum(points, scale):
    total, k = 0.0, 0
    while k < points.size:
        found = _reached(points, k, scale)
        if found < 0.0:
            total -= found
        elif found > 1.0:
            scale, found = found, max(scale, 1.0)
            total += found
        k += 1
    return total, scale


NAMES = (
    r"_v\d+_|\bB\d+|;.*|_ZN[\w$]*|@[\".\w<>$ :]*|\$\d+|\d+ x i8|0x[0-9a-f]+"
    r"|inttoptr \(i64 \d+|c\".*\""
)
"""What differs between two compilations of one function."""


def _compiled(context):
    function = numba.njit(no_cpython_wrapper=True, error_model="numpy")(_sum)
    points = Point.array([Point.row(x=1.0, y=2.0), Point.row(x=3.0, y=1.5)])
    kinds = numba.typeof(points), numba.float64
    with context:
        function.compile(kinds)
    return re.sub(NAMES, "", function.inspect_llvm(kinds))


def test_code_is_that_of_numba():
    assert _compiled(quick_compiling()) == _compiled(nullcontext())


def test_another_numba_compiles_by_its_own_passes(monkeypatch):
    """Of one that nobody has tried nothing is changed."""
    monkeypatch.setattr(quick, "TESTED", "0.0.")
    monkeypatch.setattr(quick, "_changes", lambda: pytest.fail("it is changed"))
    assert _compiled(quick_compiling()) == _compiled(nullcontext())


def test_all_is_as_before_afterwards():
    before = [(owner, name, getattr(owner, name)) for owner, name, _ in quick._changes()]
    with quick_compiling():
        now = [getattr(owner, name) for owner, name, _ in before]
    assert all(new is not slow for new, (_, _, slow) in zip(now, before, strict=True))
    assert all(getattr(owner, name) == slow for owner, name, slow in before)


def test_variables_that_live_are_those_of_numba():
    """A loop, and a variable that only one way defines."""
    from numba.core import analysis, compiler

    blocks = compiler.run_frontend(_sum).blocks
    graph, found = analysis.compute_cfg_from_blocks(blocks), analysis.compute_use_defs(blocks)
    arguments = graph, blocks, found.usemap, found.defmap
    assert quick._live_variables(*arguments) == analysis.compute_live_map(*arguments)


def test_a_function_is_found_once_for_each_types():
    """numba's own text of the types of a record is written once, too."""
    kind = numba.typeof(np.zeros(1, Point.dtype)).dtype
    with quick_compiling():
        assert repr(kind) is repr(kind)
