"""Arrays as kernels hand them to one another: where the elements lie, and how many there are.

numba hands an array from function to function as seven machine words, nine if it has two dimensions: its
owner and its parent, which count only where memory is allocated, its size twice over, the size of an
element, which the type says, and strides, which follow from the shape.  A model, its state and what is
recorded are a hundred arrays, so the kernels of a step spent a quarter of their time pushing words that
nobody reads.

Arrays of records and those in the named tuples of this package have a type of their own, `KernelArray`,
of which kernels hand over the address, the shape, and strides only if they do not follow from it.  To
whatever else works on arrays it is an array like any other.
"""

from typing import Any

import llvmlite.ir
import numba.extending
import numpy as np
from numba.core import types
from numba.core.datamodel import models

from tpss.record import Record

_Array: Any = types.Array
_ArrayModel: Any = models.ArrayModel
_typeof: Any = numba.extending.typeof_impl
_box: Any = numba.extending.box
_NamedTuple: Any = types.BaseNamedTuple
_ir: Any = llvmlite.ir

NOT_GIVEN_BACK = (
    "kernels give no arrays back to Python: call the plain function (`tpss.kernel.plain`)"
)

PACKAGE = __name__.partition(".")[0]


class KernelArray(_Array):  # type: ignore[misc]
    """Type of an array that is handed over in few words; a view of one is one too."""

    def copy(
        self, dtype: Any = None, ndim: Any = None, layout: Any = None, readonly: Any = None
    ) -> Any:
        """The type with another element, number of dimensions, or order in memory."""
        return kernel_array(super().copy(dtype, ndim, layout, readonly))


def kernel_array(array: Any) -> KernelArray:
    """The type of an array, handed over in few words."""
    return KernelArray(
        array.dtype, array.ndim, array.layout, readonly=not array.mutable, aligned=array.aligned
    )


@numba.extending.register_model(KernelArray)
class KernelArrayModel(_ArrayModel):  # type: ignore[misc]
    """What of an array is handed over; within a function it is as any other."""

    def __init__(self, manager: Any, array: Any) -> None:
        super().__init__(manager, array)
        self._follows = array.layout == "C"
        self._handed = ("data", "shape") if self._follows else ("data", "shape", "strides")

    def _model_of(self, field: str) -> Any:
        return self._models[self.get_field_position(field)]

    def get_argument_type(self) -> tuple[Any, ...]:
        """Types of what is handed over."""
        return tuple(self._model_of(field).get_argument_type() for field in self._handed)

    def as_argument(self, builder: Any, value: Any) -> tuple[Any, ...]:
        """What is handed over of an array."""
        return tuple(
            self._model_of(field).as_argument(builder, self.get(builder, value, field))
            for field in self._handed
        )

    def from_argument(self, builder: Any, value: Any) -> Any:
        """The array again, of what was handed over."""
        parts = {
            field: self._model_of(field).from_argument(builder, part)
            for field, part in zip(self._handed, value, strict=True)
        }
        lengths = [builder.extract_value(parts["shape"], k) for k in range(self._fe_type.ndim)]
        parts["itemsize"] = self._element_size()
        # Sizes of what begins at each dimension, the innermost first, in elements and in bytes.
        elements, strides = _ir.Constant(parts["itemsize"].type, 1), []
        for length in reversed(lengths):
            strides.append(builder.mul(elements, parts["itemsize"]))
            elements = builder.mul(elements, length)
        parts["nitems"] = elements
        if self._follows:
            packed = _ir.Constant(self._model_of("strides").get_value_type(), _ir.Undefined)
            for k, stride in enumerate(reversed(strides)):
                packed = builder.insert_value(packed, stride, k)
            parts["strides"] = packed
        return self._put_together(builder, parts)

    def _put_together(self, builder: Any, parts: dict[str, Any]) -> Any:
        """An array of its parts; it has no owner."""
        array = _ir.Constant(self.get_value_type(), _ir.Undefined)
        for field, model in zip(self._fields, self._models, strict=True):
            part = parts.get(field)
            if part is None:
                part = _ir.Constant(model.get_value_type(), None)
            array = self.set(builder, array, part, field)
        return array

    def _element_size(self) -> Any:
        """Bytes from an element to the next, which the target machine's layout says."""
        pointer = self._model_of("data").get_value_type()
        word = _ir.Constant(_ir.IntType(64), 1)
        return _ir.Constant(pointer, None).gep([word]).ptrtoint(word.type)


@_box(KernelArray)  # type: ignore[untyped-decorator]
def to_python(_: Any, __: Any, boxing: Any) -> Any:
    """Refuse to give an array back: which object of Python it was, nobody handed over.

    A call from Python of a kernel that returns arrays ends in a `SystemError` with this as its cause.
    """
    boxing.pyapi.err_set_string("PyExc_TypeError", NOT_GIVEN_BACK)
    return boxing.pyapi.make_none()


_type_of_array, _type_of_tuple = (_typeof.dispatch(kind) for kind in (np.ndarray, tuple))


@_typeof.register(np.recarray)  # type: ignore[untyped-decorator]
def type_of_records(array: Any, context: Any) -> Any:
    """Type of an array of records: a `KernelArray` if they are of this package."""
    found = _type_of_array(array, context)
    return kernel_array(found) if array.dtype in Record.dtypes else found


@_typeof.register(tuple)  # type: ignore[untyped-decorator]
def type_of_tuple(values: Any, context: Any) -> Any:
    """Type of a tuple: the arrays in a named one of this package are `KernelArray`s."""
    found = _type_of_tuple(values, context)
    if not (isinstance(found, _NamedTuple) and _is_ours(type(values))):
        return found
    return types.BaseTuple.from_types([handed_over(part) for part in found], type(values))


def handed_over(kind: Any) -> Any:
    """A type as kernels hand it to one another."""
    return kernel_array(kind) if isinstance(kind, _Array) else kind


def _is_ours(kind: type) -> bool:
    return kind.__module__.partition(".")[0] == PACKAGE
