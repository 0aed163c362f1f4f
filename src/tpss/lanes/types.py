"""Numbers of eight cases at once, as numba knows them: each is one vector of the machine.

`Lanes` stands for a float, `LaneInt` for a whole number, `LaneComplex` for a complex one, `Mask` for a
boolean.  A plain number becomes lanes wherever one is needed: all cases have it.
"""

from typing import Any

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.datamodel import models
from numba.core.datamodel.registry import register_default
from numba.core.extending import lower_cast
from numba.core.typeconv.castgraph import Conversion

LANES = 8
"""Cases that are run at once.  On a processor whose vectors hold four numbers each takes two."""

NUMBER, WHOLE, BIT, INDEX = ir.DoubleType(), ir.IntType(64), ir.IntType(1), ir.IntType(32)
NUMBERS, WHOLES, BITS = (ir.VectorType(each, LANES) for each in (NUMBER, WHOLE, BIT))
ZERO = ir.Constant(NUMBERS, [0.0] * LANES)
NAUGHT = ir.Constant(WHOLES, [0] * LANES)

_plain_number = (types.Float, types.Integer, types.Boolean)


class LaneType(types.Type):
    """Base of the types; a value of one of `holds` becomes one of it where need be.

    One of `cuts` does too where it is stored in a field of this type, and loses its fraction.
    """

    holds: tuple[Any, ...] = ()
    cuts: tuple[Any, ...] = ()

    def __init__(self) -> None:
        super().__init__(name=type(self).__name__)

    def can_convert_from(self, _: Any, other: Any) -> Any:
        """As numba asks."""
        if isinstance(other, self.holds):
            return Conversion.safe
        return Conversion.unsafe if isinstance(other, self.cuts) else None

    def unify(self, _: Any, other: Any) -> Any:
        """This type, if it holds the other one."""
        return self if isinstance(other, self.holds) else None


class MaskType(LaneType):
    """A boolean a case."""

    bitwidth = LANES
    holds = (types.Boolean,)


class LaneIntType(LaneType):
    """A whole number a case."""

    bitwidth = 64 * LANES
    holds = (types.Integer, types.Boolean, MaskType)


class LanesType(LaneType):
    """A float a case."""

    bitwidth = 64 * LANES
    holds = (*_plain_number, LaneIntType, MaskType)


LaneIntType.cuts = (LanesType, types.Float)


class LaneComplexType(LaneType):
    """A complex number a case."""

    bitwidth = 128 * LANES
    holds = (types.Complex, *_plain_number, LanesType)


Lanes, LaneInt, LaneComplex, Mask = LanesType(), LaneIntType(), LaneComplexType(), MaskType()


def _as_vector(kind: Any, vector: Any) -> None:
    """Let values of a type be vectors."""

    class Model(models.PrimitiveModel):
        def __init__(self, manager: Any, fe_type: Any) -> None:
            super().__init__(manager, fe_type, vector)

    register_default(kind)(Model)


for _kind, _vector in ((LanesType, NUMBERS), (LaneIntType, WHOLES), (MaskType, BITS)):
    _as_vector(_kind, _vector)


@register_default(LaneComplexType)
class _ComplexModel(models.StructModel):
    def __init__(self, manager: Any, fe_type: Any) -> None:
        super().__init__(manager, fe_type, [("real", Lanes), ("imag", Lanes)])


def spread(builder: Any, value: Any, vector: Any) -> Any:
    """A vector that has a value in all its places."""
    nothing = ir.Constant(vector, ir.Undefined)
    first = builder.insert_element(nothing, value, ir.Constant(INDEX, 0))
    places = ir.Constant(ir.VectorType(INDEX, LANES), [0] * LANES)
    return builder.shuffle_vector(first, nothing, places)


def pair(context: Any, builder: Any, real: Any, imag: Any) -> Any:
    """`LaneComplex` of its parts."""
    made = cgutils.create_struct_proxy(LaneComplex)(context, builder)
    made.real, made.imag = real, imag
    return made._getvalue()


def parts(context: Any, builder: Any, value: Any) -> tuple[Any, Any]:
    """Parts of a `LaneComplex`."""
    made = cgutils.create_struct_proxy(LaneComplex)(context, builder, value=value)
    return made.real, made.imag


def _spreads(given: Any, to: Any, plain: Any, vector: Any) -> None:
    """Let a plain number become lanes: as a number of the kind `plain` it stands in all of them."""

    @lower_cast(given, to)
    def cast(context: Any, builder: Any, given: Any, _: Any, value: Any) -> Any:
        return spread(builder, context.cast(builder, value, given, plain), vector)


def _converts(given: Any, to: Any, instruction: str, vector: Any) -> None:
    """Let lanes become others by one instruction."""

    @lower_cast(given, to)
    def cast(_context: Any, builder: Any, _given: Any, _to: Any, value: Any) -> Any:
        return getattr(builder, instruction)(value, vector)


for _plain_kind in _plain_number:
    _spreads(_plain_kind, LanesType, types.float64, NUMBERS)
    _spreads(_plain_kind, LaneIntType, types.int64, WHOLES)
for _given, _to, _instruction, _wide in (
    (MaskType, LaneIntType, "zext", WHOLES),
    (MaskType, LanesType, "uitofp", NUMBERS),
    (LaneIntType, LanesType, "sitofp", NUMBERS),
    (LanesType, LaneIntType, "fptosi", WHOLES),
):
    _converts(_given, _to, _instruction, _wide)


@lower_cast(types.Boolean, MaskType)
def _to_mask(_context: Any, builder: Any, _given: Any, _to: Any, value: Any) -> Any:
    return spread(builder, value if value.type == BIT else builder.trunc(value, BIT), BITS)


@lower_cast(LanesType, LaneComplexType)
def _lanes_to_complex(context: Any, builder: Any, _given: Any, _to: Any, value: Any) -> Any:
    return pair(context, builder, value, ZERO)


@lower_cast(types.Float, LaneComplexType)
@lower_cast(types.Integer, LaneComplexType)
@lower_cast(types.Boolean, LaneComplexType)
def _real_to_complex(context: Any, builder: Any, given: Any, _: Any, value: Any) -> Any:
    return pair(context, builder, context.cast(builder, value, given, Lanes), ZERO)


@lower_cast(types.Complex, LaneComplexType)
def _to_complex(context: Any, builder: Any, given: Any, _: Any, value: Any) -> Any:
    wide = context.cast(builder, value, given, types.complex128)
    z = context.make_complex(builder, types.complex128, value=wide)
    return pair(context, builder, *(spread(builder, part, NUMBERS) for part in (z.real, z.imag)))
