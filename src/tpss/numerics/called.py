"""A function that is not known when the kernels are compiled: compiled code calls it by its address.

So a law that somebody registers (`tpss.laws`) changes no kernel, and no kernel is compiled again for it.
Such a function takes numbers and parameters and gives numbers, and has this shape in C::

    void law(const double *given, const double *parameters, double *found)

Plain Python finds it in `python_functions`.
"""

from collections.abc import Callable
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic

from tpss.kernel import in_compiled_code
from tpss.record import Record

Array = npt.NDArray[np.float64]

MOST_PARAMETERS = 16
"""Parameters that a function may have: a record has so many places."""


class Called(Record):
    """A function by its address, and its parameters."""

    address: int = 0
    """Where its machine code begins; 0: there is none."""
    parameters: Annotated[Array, (MOST_PARAMETERS,)] = (0.0,) * MOST_PARAMETERS  # type: ignore[assignment]
    """Its parameters, in its units, then zero. [1]"""


python_functions: dict[int, Callable[..., tuple[float, ...]]] = {}
"""The same functions for plain Python, by their addresses: of what is given, and the parameters."""


def _caller(count: int) -> Any:
    """Intrinsic that calls the function at an address, which finds `count` numbers."""

    @intrinsic
    def call(_: Any, address: Any, given: Any, parameters: Any) -> Any:
        found = types.UniTuple(types.float64, count)

        def generate(context: Any, builder: Any, _: Any, arguments: Any) -> Any:
            number, pointer = ir.DoubleType(), ir.DoubleType().as_pointer()
            numbers = [builder.extract_value(arguments[1], k) for k in range(given.count)]
            handed = cgutils.alloca_once(builder, number, size=given.count)
            results = cgutils.alloca_once(builder, number, size=count)
            for k, each in enumerate(numbers):
                builder.store(each, cgutils.gep_inbounds(builder, handed, k))
            array = context.make_array(parameters)(context, builder, arguments[2])
            kind = ir.FunctionType(ir.VoidType(), [pointer] * 3)
            function = builder.inttoptr(arguments[0], kind.as_pointer())
            builder.call(function, [handed, array.data, results])
            loaded = [builder.load(cgutils.gep_inbounds(builder, results, k)) for k in range(count)]
            return context.make_tuple(builder, found, loaded)

        return found(address, given, parameters), generate

    return call


@in_compiled_code(_caller(1))
def find_number(called: Called, given: tuple[float, ...]) -> tuple[float, ...]:
    """The number that a function finds.

    Parameters
    ----------
    called : Called
        The function; there must be one.
    given : tuple of float
        What it is given, as many numbers as its kind has.
    """
    return python_functions[int(called.address)](given, called.parameters)


@in_compiled_code(_caller(6))
def find_six_numbers(called: Called, given: tuple[float, ...]) -> tuple[float, ...]:
    """The six numbers that a function finds; parameters are those of `find_number`."""
    return python_functions[int(called.address)](given, called.parameters)
