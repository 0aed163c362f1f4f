"""A law as machine code that kernels call by its address; see `numerics.called`."""

from collections.abc import Sequence
from functools import cache
from typing import Any

import numba
from numba import types
from numba.core.errors import NumbaError
from numba.np.unsafe import ndarray

from tpss.laws.law import Law, LawError
from tpss.numerics.called import MOST_PARAMETERS, Called, python_functions

_OPTIONS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}}
_config: Any = numba.config
_array_at: Any = numba.carray  # type: ignore[attr-defined]
_as_tuple: Any = ndarray.to_fixed_tuple
_NUMBERS = types.CPointer(types.float64)
_kept: list[Any] = []
"""Compiled laws, which must not be freed as long as somebody may know their addresses."""


def called(law: Law, values: Sequence[float]) -> Any:
    """A row of `Called` for a law with values of its parameters.

    Raises
    ------
    LawError
        numba cannot compile the function.
    """
    parameters = (*values, *[0.0] * (MOST_PARAMETERS - len(values)))
    return Called.row(address=_address(law), parameters=parameters)


@cache
def _address(law: Law) -> int:
    """Where the machine code of a law begins, which is compiled once a process."""
    plain = _in_python(law)
    if _config.DISABLE_JIT:
        _kept.append(plain)
        address = id(plain)
    else:
        compiled = _machine_code(law)
        _kept.append(compiled)
        address = int(compiled.address)
    python_functions[address] = plain
    return address


def _in_python(law: Law) -> Any:
    """The law of what is given and an array of parameters, in plain Python."""
    count = len(law.parameters)

    def find(given: tuple[float, ...], parameters: Any) -> tuple[float, ...]:
        found: Any = law.function(*given, *parameters[:count])
        return found if isinstance(found, tuple) else (found,)

    return find


def _machine_code(law: Law) -> Any:
    """The law behind an interface of C."""
    function = numba.njit(**_OPTIONS)(law.function)
    given, parameters, found = len(law.kind.given), len(law.parameters), len(law.kind.found)

    def one(numbers: Any, values: Any, results: Any) -> None:
        results[0] = function(
            *_as_tuple(_array_at(numbers, (given,)), given),
            *_as_tuple(_array_at(values, (parameters,)), parameters),
        )

    def several(numbers: Any, values: Any, results: Any) -> None:
        all_found = function(
            *_as_tuple(_array_at(numbers, (given,)), given),
            *_as_tuple(_array_at(values, (parameters,)), parameters),
        )
        for k in range(found):
            results[k] = all_found[k]

    signature = types.void(_NUMBERS, _NUMBERS, _NUMBERS)
    try:
        return numba.cfunc(signature, **_OPTIONS)(one if found == 1 else several)
    except NumbaError as error:
        reason = str(error).strip().splitlines()
        raise LawError(
            f"the law {law.name!r} cannot be compiled: "
            f"{next((line for line in reason if line.strip()), '')}",
            "use arithmetic, conditions and functions of `math` on floats only",
        ) from error
