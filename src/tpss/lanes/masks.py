"""What generated kernels are made of besides arithmetic: choices by masks, and looks at all lanes.

Each does its work on plain values too: a condition that is the same for all cases stays a boolean, and
what it chooses a plain number.
"""

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic as _numba_intrinsic

from tpss.lanes.arithmetic import widest
from tpss.lanes.types import (
    BITS,
    INDEX,
    LANES,
    NAUGHT,
    NUMBERS,
    WHOLES,
    LaneComplex,
    LaneInt,
    LaneIntType,
    Lanes,
    LaneType,
    Mask,
    MaskType,
    pair,
    parts,
    spread,
)

intrinsic: Any = _numba_intrinsic

_truth = (MaskType, types.Boolean)
_whole = (LaneIntType, types.Integer, *_truth)


def _merged(context: Any, mask: Any, a: Any, b: Any) -> Any:
    """Type that holds either of two, by a mask."""
    if isinstance(a, types.BaseTuple):
        each = [_merged(context, mask, x, y) for x, y in zip(a.types, b.types, strict=True)]
        return types.BaseTuple.from_types(each)
    if isinstance(mask, types.Boolean) and not any(isinstance(x, LaneType) for x in (a, b)):
        return context.unify_pairs(a, b)
    if all(isinstance(x, _truth) for x in (a, b)):
        return Mask
    return LaneInt if all(isinstance(x, _whole) for x in (a, b)) else widest((a, b, Lanes))


def _choose(context: Any, builder: Any, kind: Any, mask: Any, a: Any, b: Any) -> Any:
    if isinstance(kind, types.BaseTuple):
        chosen = [
            _choose(
                context,
                builder,
                each,
                mask,
                builder.extract_value(a, k),
                builder.extract_value(b, k),
            )
            for k, each in enumerate(kind.types)
        ]
        return context.make_tuple(builder, kind, chosen)
    if kind == LaneComplex:
        both_parts = zip(parts(context, builder, a), parts(context, builder, b), strict=True)
        return pair(context, builder, *(builder.select(mask, x, y) for x, y in both_parts))
    return builder.select(mask, a, b)


@intrinsic
def select(context: Any, mask: Any, a: Any, b: Any) -> Any:
    """`a` in the lanes of the mask, `b` in the others."""
    kind = _merged(context, mask, a, b)

    def generate(context: Any, builder: Any, typed: Any, values: Any) -> Any:
        return _choose(context, builder, typed.return_type, *values)

    return kind(mask, kind, kind), generate


def _logical(name: str) -> Any:
    @intrinsic
    def logical(_: Any, a: Any, b: Any) -> Any:
        kind = Mask if isinstance(a, MaskType) or isinstance(b, MaskType) else types.boolean

        def generate(_: Any, builder: Any, __: Any, values: Any) -> Any:
            return getattr(builder, name)(*values)

        return kind(kind, kind), generate

    return logical


both, either = _logical("and_"), _logical("or_")


@intrinsic
def negated(_: Any, a: Any) -> Any:
    """The lanes that a mask leaves out."""

    def generate(_: Any, builder: Any, __: Any, values: Any) -> Any:
        kind = values[0].type
        ones = ir.Constant(kind, [1] * LANES if isinstance(a, MaskType) else 1)
        return builder.xor(values[0], ones)

    return a(a), generate


@intrinsic
def as_mask(_: Any, a: Any) -> Any:
    """What a condition says: numbers are true where they are not zero."""

    def of_lanes(_: Any, builder: Any, __: Any, values: Any) -> Any:
        return builder.icmp_signed("!=", values[0], NAUGHT)

    def of_whole(_: Any, builder: Any, __: Any, values: Any) -> Any:
        return builder.icmp_signed("!=", values[0], ir.Constant(values[0].type, 0))

    def as_it_is(_: Any, __: Any, ___: Any, values: Any) -> Any:
        return values[0]

    if isinstance(a, LaneIntType):
        return Mask(a), of_lanes
    return (types.boolean(a), of_whole) if isinstance(a, types.Integer) else (a(a), as_it_is)


@intrinsic
def anyone(_: Any, a: Any) -> Any:
    """Whether a mask holds any lane."""

    def generate(_: Any, builder: Any, __: Any, values: Any) -> Any:
        if isinstance(a, types.Boolean):
            return values[0]
        bits = ir.IntType(LANES)
        return builder.icmp_unsigned("!=", builder.bitcast(values[0], bits), ir.Constant(bits, 0))

    return types.boolean(a), generate


@intrinsic
def all_lanes(_: Any) -> Any:
    """The mask of all lanes."""

    def generate(_: Any, __: Any, ___: Any, ____: Any) -> Any:
        return ir.Constant(BITS, [1] * LANES)

    return Mask(), generate


def _outermost(sign: str) -> Any:
    @intrinsic
    def find(_: Any, a: Any) -> Any:
        def generate(_: Any, builder: Any, __: Any, values: Any) -> Any:
            if isinstance(a, types.Integer):
                return values[0]
            each = [builder.extract_element(values[0], ir.Constant(INDEX, k)) for k in range(LANES)]
            found = each[0]
            for one in each[1:]:
                found = builder.select(builder.icmp_signed(sign, one, found), one, found)
            return found

        return (a if isinstance(a, types.Integer) else types.int64)(a), generate

    return find


lowest, highest = _outermost("<"), _outermost(">")


@intrinsic
def in_lanes(_: Any, a: Any) -> Any:
    """A number as one a lane; anything else as it is."""
    kinds = ((types.Boolean, Mask), (types.Integer, LaneInt), (types.Float, Lanes),
             (types.Complex, LaneComplex))  # fmt: skip
    kind = next((wide for plain, wide in kinds if isinstance(a, plain)), a)

    def generate(context: Any, builder: Any, _: Any, values: Any) -> Any:
        return context.cast(builder, values[0], a, kind)

    return kind(a), generate


def _conversion(kind: Any) -> Any:
    @intrinsic
    def convert(_: Any, a: Any) -> Any:
        def generate(context: Any, builder: Any, __: Any, values: Any) -> Any:
            return context.cast(builder, values[0], a, kind)

        return kind(a), generate

    return convert


as_lanes, as_lane_int = _conversion(Lanes), _conversion(LaneInt)


@intrinsic
def lane_at(_: Any, a: Any) -> Any:
    """`kernel.at` of an index, or of one a lane."""
    kind = a if isinstance(a, LaneIntType) else types.uint64

    def generate(context: Any, builder: Any, _: Any, values: Any) -> Any:
        return context.cast(builder, values[0], a, kind)

    return kind(a), generate


def _test(generate: Callable[..., Any]) -> Any:
    @intrinsic
    def test(_: Any, a: Any) -> Any:
        def generate_it(_: Any, builder: Any, __: Any, values: Any) -> Any:
            return generate(builder, values[0])

        return (Mask if isinstance(a, LaneType) else types.boolean)(a), generate_it

    return test


def _not_a_number(builder: Any, value: Any) -> Any:
    return builder.fcmp_unordered("uno", value, value)


def _finite(builder: Any, value: Any) -> Any:
    rest = builder.fsub(value, value)
    return builder.fcmp_ordered("==", rest, rest)


is_nan, is_finite = _test(_not_a_number), _test(_finite)


@intrinsic
def power_of_two_times(_: Any, _value: Any, _rounded: Any) -> Any:
    """A number times two to the whole number in the last bits of another, see `numerics.exponential`."""

    def generate(_: Any, builder: Any, __: Any, values: Any) -> Any:
        bits, exponent = (builder.bitcast(each, WHOLES) for each in values)
        moved = builder.shl(exponent, spread(builder, ir.Constant(ir.IntType(64), 52), WHOLES))
        return builder.bitcast(builder.add(bits, moved), NUMBERS)

    return Lanes(Lanes, Lanes), generate


@intrinsic
def lane_of(_: Any, values: Any, lane: Any) -> Any:
    """The number of one lane."""
    kind = types.int64 if isinstance(values, LaneIntType) else types.float64

    def generate(_: Any, builder: Any, __: Any, given: Any) -> Any:
        return builder.extract_element(given[0], given[1])

    return kind(values, lane), generate


@intrinsic
def one_lane(_: Any, _lane: Any) -> Any:
    """The mask of one lane."""

    def generate(_: Any, builder: Any, __: Any, values: Any) -> Any:
        here = spread(builder, values[0], WHOLES)
        return builder.icmp_signed("==", here, ir.Constant(WHOLES, list(range(LANES))))

    return Mask(types.int64), generate
