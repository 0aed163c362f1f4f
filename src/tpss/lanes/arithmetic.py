"""Arithmetic of lanes: what numba's operators and functions do with them.

Each operator is one instruction of the vector unit.  Complex numbers follow the formulas that numba has
for plain ones, but that a real factor stays real.
"""

import math
import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.extending import infer_getattr, lower_builtin, lower_getattr
from numba.core.typing.templates import (
    AbstractTemplate,
    AttributeTemplate,
    bound_function,
    infer_global,
    signature,
)

from tpss.lanes.types import (
    LANES,
    NUMBERS,
    LaneComplex,
    LaneComplexType,
    LaneInt,
    LaneIntType,
    Lanes,
    LanesType,
    LaneType,
    Mask,
    MaskType,
    pair,
    parts,
)

_REAL = (types.Float, types.Integer, types.Boolean, LanesType, LaneIntType)


def widest(arguments: Any) -> Any:
    """Lane type that holds all arguments; None if none of them has lanes, or one is a mask."""
    if not any(isinstance(each, LaneType) for each in arguments):
        return None
    if any(isinstance(each, (LaneComplexType, types.Complex)) for each in arguments):
        return LaneComplex
    if any(isinstance(each, (LanesType, types.Float)) for each in arguments):
        return Lanes
    return LaneInt


def _infer(function: Any, typing: Callable[[Any], Any]) -> None:
    """Let numba know a function of lanes by what its arguments' types give; None: none of ours."""

    class Template(AbstractTemplate):
        def generic(self, arguments: Any, _: Any) -> Any:
            return typing(arguments)

    infer_global(function)(Template)


def _arithmetic(symbol: Any) -> Callable[[Any], Any]:
    def typing(arguments: Any) -> Any:
        wide = widest(arguments)
        if wide is None or len(arguments) > 2:
            return None
        if wide == LaneComplex:  # a real factor stays real
            return signature(wide, *(Lanes if isinstance(a, _REAL) else wide for a in arguments))
        if wide == LaneInt and symbol is operator.truediv:
            wide = Lanes
        return signature(wide, *[wide] * len(arguments))

    return typing


def _whole(arguments: Any) -> Any:
    wide = widest(arguments)
    return signature(wide, wide, wide) if wide == LaneInt else None


def _comparison(arguments: Any) -> Any:
    wide = widest(arguments)
    return signature(Mask, wide, wide) if wide in (Lanes, LaneInt, LaneComplex) else None


def _lower(function: Any, kinds: tuple[Any, ...], generate: Callable[..., Any]) -> None:
    """Let a function of lanes be what `generate` makes of the builder and the values."""

    @lower_builtin(function, *kinds)
    def lowered(_: Any, builder: Any, __: Any, values: Any) -> Any:
        return generate(builder, *values)


_PLAIN = {
    operator.add: ("fadd", "add"),
    operator.sub: ("fsub", "sub"),
    operator.mul: ("fmul", "mul"),
    operator.truediv: ("fdiv", None),
}
_BITWISE = {operator.or_: "or_", operator.and_: "and_", operator.lshift: "shl",
            operator.rshift: "ashr"}  # fmt: skip
_COMPARED = {
    operator.lt: "<", operator.le: "<=", operator.gt: ">", operator.ge: ">=",
    operator.eq: "==", operator.ne: "!=",
}  # fmt: skip


def _instruction(name: str) -> Callable[..., Any]:
    return lambda builder, *values: getattr(builder, name)(*values)


def _compared(sign: str) -> tuple[Callable[..., Any], Callable[..., Any]]:
    floats = "fcmp_unordered" if sign == "!=" else "fcmp_ordered"
    return (
        lambda builder, a, b: getattr(builder, floats)(sign, a, b),
        lambda builder, a, b: builder.icmp_signed(sign, a, b),
    )


for _symbol, (_float, _int) in _PLAIN.items():
    _infer(_symbol, _arithmetic(_symbol))
    _lower(_symbol, (LanesType, LanesType), _instruction(_float))
    if _int:
        _lower(_symbol, (LaneIntType, LaneIntType), _instruction(_int))
for _symbol, _name in _BITWISE.items():
    _infer(_symbol, _whole)
    _lower(_symbol, (LaneIntType, LaneIntType), _instruction(_name))
for _symbol, _sign in _COMPARED.items():
    _infer(_symbol, _comparison)
    for _kind, _made in zip((LanesType, LaneIntType), _compared(_sign), strict=True):
        _lower(_symbol, (_kind, _kind), _made)
_infer(operator.neg, _arithmetic(operator.neg))
_infer(operator.floordiv, _whole)
_lower(operator.neg, (LanesType,), _instruction("fneg"))
_lower(operator.neg, (LaneIntType,), _instruction("neg"))


@lower_builtin(operator.floordiv, LaneIntType, LaneIntType)
def _floor_divide(_context: Any, builder: Any, _signature: Any, values: Any) -> Any:
    """Of numbers that are not negative, as indices are."""
    return builder.sdiv(*values)


_Parts = tuple[Any, Any]


def _add(b: Any, x: _Parts, y: _Parts) -> _Parts:
    imag = x[1] if y[1] is None else y[1] if x[1] is None else b.fadd(x[1], y[1])
    return b.fadd(x[0], y[0]), imag


def _subtract(b: Any, x: _Parts, y: _Parts) -> _Parts:
    imag = x[1] if y[1] is None else b.fneg(y[1]) if x[1] is None else b.fsub(x[1], y[1])
    return b.fsub(x[0], y[0]), imag


def _multiply(b: Any, x: _Parts, y: _Parts) -> _Parts:
    if y[1] is None:
        return b.fmul(x[0], y[0]), b.fmul(x[1], y[0])
    if x[1] is None:
        return b.fmul(x[0], y[0]), b.fmul(x[0], y[1])
    real = b.fsub(b.fmul(x[0], y[0]), b.fmul(x[1], y[1]))
    return real, b.fadd(b.fmul(x[0], y[1]), b.fmul(x[1], y[0]))


def _divide(b: Any, x: _Parts, y: _Parts) -> _Parts:
    if y[1] is None:
        return b.fdiv(x[0], y[0]), b.fdiv(x[1], y[0])
    square = b.fadd(b.fmul(y[0], y[0]), b.fmul(y[1], y[1]))
    real, imag = _multiply(b, x, (y[0], b.fneg(y[1])))
    return b.fdiv(real, square), b.fdiv(imag, square)


def _complex(symbol: Any, formula: Callable[..., _Parts]) -> None:
    def generate(context: Any, builder: Any, typed: Any, values: Any) -> Any:
        operands = [
            parts(context, builder, value) if kind == LaneComplex else (value, None)
            for kind, value in zip(typed.args, values, strict=True)
        ]
        return pair(context, builder, *formula(builder, *operands))

    for first, second in (
        (LaneComplexType, LaneComplexType), (LaneComplexType, LanesType), (LanesType, LaneComplexType),
    ):  # fmt: skip
        lower_builtin(symbol, first, second)(generate)


for _symbol, _formula in (
    (operator.add, _add), (operator.sub, _subtract), (operator.mul, _multiply),
    (operator.truediv, _divide),
):  # fmt: skip
    _complex(_symbol, _formula)


@lower_builtin(operator.neg, LaneComplexType)
def _negative(context: Any, builder: Any, _: Any, values: Any) -> Any:
    return pair(context, builder, *(builder.fneg(x) for x in parts(context, builder, values[0])))


@lower_builtin(operator.eq, LaneComplexType, LaneComplexType)
def _equal(context: Any, builder: Any, _: Any, values: Any) -> Any:
    (a, b), (c, d) = (parts(context, builder, value) for value in values)
    return builder.and_(builder.fcmp_ordered("==", a, c), builder.fcmp_ordered("==", b, d))


def function_of_vectors(name: str, count: int) -> Callable[..., Any]:
    """LLVM's function of a name on vectors of numbers."""

    def generate(builder: Any, *values: Any) -> Any:
        kind = ir.FunctionType(NUMBERS, [NUMBERS] * count)
        full = f"llvm.{name}.v{LANES}f64"
        function = cgutils.get_or_insert_function(builder.module, kind, full)
        return builder.call(function, values)

    return generate


def _of_lanes(function: Any, count: int, generate: Callable[..., Any]) -> None:
    def typing(arguments: Any) -> Any:
        ours = len(arguments) == count and widest(arguments) in (Lanes, LaneInt)
        return signature(Lanes, *[Lanes] * count) if ours else None

    _infer(function, typing)
    _lower(function, (LanesType,) * count, generate)


for _function, _name, _count in (
    (math.sqrt, "sqrt", 1), (math.floor, "floor", 1), (math.ceil, "ceil", 1), (abs, "fabs", 1),
    (math.copysign, "copysign", 2),
):  # fmt: skip
    _of_lanes(_function, _count, function_of_vectors(_name, _count))


def _extreme(function: Any, sign: str) -> None:
    """As numba has it of numbers: the second one only if it is beyond the first."""

    def typing(arguments: Any) -> Any:
        wide = widest(arguments) if len(arguments) == 2 else None
        return signature(wide, wide, wide) if wide in (Lanes, LaneInt) else None

    def of_floats(builder: Any, a: Any, b: Any) -> Any:
        return builder.select(builder.fcmp_ordered(sign, b, a), b, a)

    def of_wholes(builder: Any, a: Any, b: Any) -> Any:
        return builder.select(builder.icmp_signed(sign, b, a), b, a)

    _infer(function, typing)
    _lower(function, (LanesType, LanesType), of_floats)
    _lower(function, (LaneIntType, LaneIntType), of_wholes)


_extreme(min, "<")
_extreme(max, ">")


def _made_complex(arguments: Any) -> Any:
    ours = len(arguments) == 2 and widest(arguments) in (Lanes, LaneInt)
    return signature(LaneComplex, Lanes, Lanes) if ours else None


_infer(complex, _made_complex)


@lower_builtin(complex, LanesType, LanesType)
def _make_complex(context: Any, builder: Any, _: Any, values: Any) -> Any:
    return pair(context, builder, *values)


def _as_float(arguments: Any) -> Any:
    ours = len(arguments) == 1 and isinstance(arguments[0], (LanesType, LaneIntType, MaskType))
    return signature(Lanes, Lanes) if ours else None


_infer(float, _as_float)
_lower(float, (LanesType,), lambda _, value: value)


@infer_getattr
class _ComplexAttributes(AttributeTemplate):
    key = LaneComplexType

    def resolve_real(self, _: Any) -> Any:
        return Lanes

    def resolve_imag(self, _: Any) -> Any:
        return Lanes

    @bound_function("lanecomplex.conjugate")
    def resolve_conjugate(self, _: Any, __: Any, ___: Any) -> Any:
        return signature(LaneComplex)


@lower_getattr(LaneComplexType, "real")
def _real(context: Any, builder: Any, _: Any, value: Any) -> Any:
    return parts(context, builder, value)[0]


@lower_getattr(LaneComplexType, "imag")
def _imag(context: Any, builder: Any, _: Any, value: Any) -> Any:
    return parts(context, builder, value)[1]


@lower_builtin("lanecomplex.conjugate", LaneComplexType)
def _conjugate(context: Any, builder: Any, _: Any, values: Any) -> Any:
    real, imag = parts(context, builder, values[0])
    return pair(context, builder, real, builder.fneg(imag))
