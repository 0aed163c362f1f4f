"""Records of eight cases in one: each number becomes a vector, in the places that it had.

A field at the byte `o` of a record lies at `8 o` of the record of lanes, so records of eight cases
become one, and one becomes eight, by one transposition of words.  What is the same in all cases, as
places of blocks and kinds of laws are, is read as a plain number from the first lane.
"""

import hashlib
import operator
from collections.abc import Iterable
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt
from llvmlite import ir
from numba.core import cgutils, types
from numba.core.datamodel import models
from numba.core.datamodel.registry import register_default
from numba.core.extending import infer_getattr, lower_builtin, typeof_impl
from numba.core.imputils import lower_getattr_generic
from numba.core.typing.templates import AbstractTemplate, AttributeTemplate, infer_global, signature
from numba.np.arrayobj import getitem_array_tuple, make_array
from numba.np.numpy_support import from_dtype

from tpss.lanes.types import (
    BITS,
    INDEX,
    LANES,
    NUMBER,
    NUMBERS,
    WHOLE,
    WHOLES,
    ZERO,
    LaneComplex,
    LaneInt,
    LaneIntType,
    Lanes,
    LanesType,
    spread,
)

Words = npt.NDArray[np.int64]

WORD = 8
"""Bytes of a number. [B]"""


class LaneRecord(types.Record):
    """Record whose numbers are lanes; a short name makes short symbols."""

    def __init__(self, fields: Any, size: int) -> None:
        super().__init__(fields, size, True)
        self.name = f"LaneRecord({hashlib.sha256(self.name.encode()).hexdigest()[:12]})"

    @property
    def dtype(self) -> Any:
        """As numba asks: so many bytes."""
        return np.dtype(f"V{self.size}")


register_default(LaneRecord)(models.RecordModel)


@cache
def lane_type(dtype: Any, same: frozenset[str]) -> Any:
    """Type of a number or record in lanes.

    Parameters
    ----------
    dtype : numpy.dtype
        Of one case.
    same : frozenset of str
        Names of whole numbers that are the same in all cases; ``"*"``: all of them are.
    """
    if dtype.names is None:
        return {"f": Lanes, "c": LaneComplex}.get(dtype.kind, LaneInt)
    fields: list[tuple[str, dict[str, Any]]] = []
    for name in dtype.names:
        kind, offset = dtype.fields[name][:2]
        if offset % WORD:  # booleans side by side; no kernel in lanes may ask for them
            continue
        base, shape = kind.subdtype or (kind, ())
        whole = base.kind in "iub" and base.names is None
        if whole and (name in same or "*" in same):
            typed = from_dtype(base)
        else:
            typed = lane_type(base, same)
            typed = types.NestedArray(dtype=typed, shape=shape) if shape else typed
        place = {"type": typed, "offset": LANES * offset, "alignment": None, "title": None}
        fields.append((name, place))
    return LaneRecord(fields, LANES * dtype.itemsize)


class LaneArray(np.ndarray[Any, Any]):
    """Array of bytes that numba sees as one of lanes, or of records of them."""

    typed: Any
    words: Words
    """The same memory as whole numbers, lanes last."""

    def __array_finalize__(self, other: Any) -> None:
        self.typed = getattr(other, "typed", None)


@typeof_impl.register(LaneArray)
def _typeof(array: LaneArray, _: Any) -> Any:
    layout = "C" if array.flags.c_contiguous else "A"
    return types.Array(array.typed, array.ndim, layout, aligned=True)


def new_lanes(dtype: Any, shape: tuple[int, ...], same: Iterable[str] = ()) -> LaneArray:
    """Array of lanes, all zero.

    Parameters
    ----------
    dtype : numpy.dtype
        Of one case; all its fields take whole words.
    shape : tuple of int
        Of one case.
    same : iterable of str
        As of `lane_type`.
    """
    dtype = np.dtype(dtype)
    words = max(1, dtype.itemsize // WORD)
    count = int(np.prod(shape, dtype=int))
    # One more: lanes that are left out read, but do not use, what lies behind the last one.
    raw = np.zeros((count + 1) * words * LANES * WORD + 64, np.uint8)
    begin = -raw.ctypes.data % 64
    used = raw[begin : begin + count * words * LANES * WORD]
    array = used.view(f"V{words * LANES * WORD}").reshape(shape).view(LaneArray)
    array.typed = lane_type(dtype, frozenset(same))
    array.words = used.view(np.int64).reshape(*shape, words, LANES)
    return array


def words_of(array: Any) -> Words:
    """An array of one case as words, shape (..., words); what is smaller than one is widened."""
    plain = np.ascontiguousarray(array).view(np.ndarray)
    if plain.dtype.itemsize < WORD:
        plain = plain.astype(np.int64)
    return plain.view(np.int64).reshape(*plain.shape, plain.dtype.itemsize // WORD)


def join(arrays: Iterable[Any], same: Iterable[str] = (), fill: float | None = None) -> LaneArray:
    """Arrays of eight cases as one of lanes.

    Parameters
    ----------
    arrays : iterable
        Of one type; where they differ in size, the largest counts.
    same : iterable of str
        As of `lane_type`.
    fill : float, optional
        What stands in places that a smaller one lacks; by default zero.
    """
    given = list(arrays)
    shapes = {each.shape for each in given}
    shape = tuple(max(sizes) for sizes in zip(*shapes, strict=True))
    joined = new_lanes(given[0].dtype, shape, same)
    if len(shapes) == 1:
        np.stack([words_of(each) for each in given], axis=-1, out=joined.words)
        return joined
    if fill is not None:
        joined.words.view(np.float64)[...] = fill
    for lane, each in enumerate(given):
        joined.words[_of_lane(each, lane)] = words_of(each)
    return joined


def part(array: LaneArray, lane: int, target: Any) -> None:
    """Write what an array of lanes has of one case into an array of its own."""
    words_of(target)[...] = array.words[_of_lane(target, lane)]


def _of_lane(array: Any, lane: int) -> tuple[Any, ...]:
    """Where the words of one case's array lie among those of lanes."""
    return (*(slice(n) for n in array.shape), slice(None), lane)


class VaryingRecord(types.Type):
    """A record whose place in its array differs by lane; its fields can be read."""

    def __init__(self, record: Any) -> None:
        self.record = record
        super().__init__(name=f"VaryingRecord({record.name})")


@register_default(VaryingRecord)
class _VaryingModel(models.StructModel):
    def __init__(self, manager: Any, fe_type: Any) -> None:
        super().__init__(manager, fe_type, [("base", types.voidptr), ("index", LaneInt)])


@infer_global(operator.getitem)
class _GetVarying(AbstractTemplate):
    def generic(self, arguments: Any, _: Any) -> Any:
        array, index = arguments
        if not isinstance(array, types.Array):
            return None
        if isinstance(index, types.BaseTuple):
            ours = array.ndim == 2 and any(isinstance(each, LaneIntType) for each in index)
            index = types.UniTuple(LaneInt, 2)
        else:
            ours = array.ndim == 1 and isinstance(index, LaneIntType)
        if ours and isinstance(array.dtype, LaneRecord):
            return signature(VaryingRecord(array.dtype), array, index)
        if ours and isinstance(array.dtype, (LanesType, LaneIntType)):
            return signature(array.dtype, array, index)
        return None


def _gather(builder: Any, base: Any, index: Any, stride: int, offset: int) -> Any:
    """Of each lane the number of its own place."""
    places = [offset + WORD * k for k in range(LANES)]
    address = builder.add(
        builder.mul(index, ir.Constant(WHOLES, [stride] * LANES)), ir.Constant(WHOLES, places)
    )
    address = builder.add(address, spread(builder, builder.ptrtoint(base, WHOLE), WHOLES))
    pointers = ir.VectorType(NUMBER.as_pointer(), LANES)
    kind = ir.FunctionType(NUMBERS, [pointers, INDEX, BITS, NUMBERS])
    name = f"llvm.masked.gather.v{LANES}f64.v{LANES}p0"
    function = cgutils.get_or_insert_function(builder.module, kind, name)
    everywhere = ir.Constant(BITS, [1] * LANES)
    given = [builder.inttoptr(address, pointers), ir.Constant(INDEX, WORD), everywhere, ZERO]
    return builder.call(function, given)


def _as(kind: Any, builder: Any, value: Any) -> Any:
    return builder.bitcast(value, WHOLES) if kind == LaneInt else value


def _take(context: Any, builder: Any, typed: Any, array: Any, index: Any) -> Any:
    """What of an array lies at an index of each lane.

    A lane that is left out may have any index: its is brought into the array.
    """
    naught, one = (ir.Constant(WHOLES, [n] * LANES) for n in (0, 1))
    last = builder.sub(spread(builder, array.nitems, WHOLES), one)
    index = builder.select(builder.icmp_signed(">", index, last), last, index)
    index = builder.select(builder.icmp_signed("<", index, naught), naught, index)
    base = builder.bitcast(array.data, ir.IntType(8).as_pointer())
    if not isinstance(typed, VaryingRecord):
        return _as(typed, builder, _gather(builder, base, index, LANES * WORD, 0))
    found = cgutils.create_struct_proxy(typed)(context, builder)
    found.base, found.index = base, index
    return found._getvalue()


@lower_builtin(operator.getitem, types.Array, LaneIntType)
def _get_varying(context: Any, builder: Any, typed: Any, values: Any) -> Any:
    array = make_array(typed.args[0])(context, builder, values[0])
    return _take(context, builder, typed.return_type, array, values[1])


@lower_builtin(operator.getitem, types.Array, types.UniTuple)
def _get_varying_of_two(context: Any, builder: Any, typed: Any, values: Any) -> Any:
    if typed.args[1].dtype != LaneInt:
        return getitem_array_tuple(context, builder, typed, values)
    array = make_array(typed.args[0])(context, builder, values[0])
    row, column = cgutils.unpack_tuple(builder, values[1], 2)
    columns = spread(builder, cgutils.unpack_tuple(builder, array.shape, 2)[1], WHOLES)
    index = builder.add(builder.mul(row, columns), column)
    return _take(context, builder, typed.return_type, array, index)


@infer_getattr
class _VaryingAttributes(AttributeTemplate):
    key = VaryingRecord

    def generic_resolve(self, varying: Any, name: str) -> Any:
        fields = varying.record.fields
        kind = varying.record.typeof(name) if name in fields else None
        return LaneInt if isinstance(kind, (types.Integer, types.Boolean)) else kind


@lower_getattr_generic(VaryingRecord)
def _read_varying(context: Any, builder: Any, typed: Any, value: Any, name: str) -> Any:
    place = cgutils.create_struct_proxy(typed)(context, builder, value=value)
    record = typed.record
    found = _gather(builder, place.base, place.index, record.size, record.offset(name))
    kind = record.typeof(name)
    return _as(kind if kind == Lanes else LaneInt, builder, found)
