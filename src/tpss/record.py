"""Records: one class gives the types of its fields to mypy, to numpy and numba, and to the reader.

    class Motion(Record):
        position_m: float
        \"\"\"Position on the line. [m]\"\"\"

To compiled code a record is one pointer, however many fields it has, and a nested record a constant
offset from it.  So kernels are handed records, and of a nested record the part that they may touch.
A record class is never instantiated: its rows lie in arrays (`Record.blank`, `Record.array`), whose
elements have the fields as attributes, in compiled and in plain Python.
"""

from collections.abc import Iterable
from enum import IntEnum
from inspect import get_annotations
from typing import Any, ClassVar, Protocol, Self, TypeVar, overload

import numpy as np
import numpy.typing as npt

_R = TypeVar("_R", covariant=True)
_Index = int | np.integer[Any]


class Records(Protocol[_R]):
    """Array of records, as mypy sees it; in fact a `numpy.recarray`.

    An index gives a record; a name, a slice or a mask what it gives of any array.
    """

    size: int
    shape: tuple[int, ...]

    @overload
    def __getitem__(self, index: _Index | tuple[_Index, _Index]) -> _R: ...
    @overload
    def __getitem__(self, index: str | slice | npt.NDArray[Any] | tuple[Any, ...]) -> Any: ...
    def __getattr__(self, name: str) -> Any: ...


class Record:
    """Base of the record classes; their annotations are the fields, those of a base class first.

    A field is a float, int, bool or complex, an `IntEnum`, another record, or an array of floats of
    fixed shape (``Annotated[Floats, (3, 4)]``).  A value in the class is a default.
    """

    dtype: ClassVar[np.dtype[Any]]
    dtypes: ClassVar[set[np.dtype[Any]]] = set()
    """Those of all record classes."""

    def __init_subclass__(cls) -> None:
        classes = [each for each in reversed(cls.__mro__) if issubclass(each, Record)][1:]
        hints = {name: hint for each in classes for name, hint in get_annotations(each).items()}
        fields = [(name, *_numpy_type(hint)) for name, hint in hints.items()]
        cls.dtype = np.dtype((np.record, np.dtype(fields, align=True)))
        Record.dtypes.add(cls.dtype)

    @classmethod
    def row(cls, **values: Any) -> Any:
        """Values of all fields in their order.

        Raises
        ------
        TypeError
            A name is not that of a field, or a field has neither a value nor a default.
        """
        names = cls.dtype.names or ()
        unknown = [name for name in values if name not in names]
        missing = [name for name in names if name not in values and not hasattr(cls, name)]
        if unknown or missing:
            raise TypeError(f"{cls.__name__}: unknown fields {unknown}, missing fields {missing}")
        return tuple(values[name] if name in values else getattr(cls, name) for name in names)

    @classmethod
    def array(cls, rows: Iterable[tuple[Any, ...]]) -> Records[Self]:
        """Array of records, a `row` each; what lies between fields is zero."""
        given = list(rows)
        array = cls.blank(len(given))
        array.view(np.ndarray)[:] = given
        return array

    @classmethod
    def blank(cls, *shape: int) -> Records[Self]:
        """Array of records, all zero."""
        return np.zeros(shape, dtype=cls.dtype).view(np.recarray)  # type: ignore[return-value]


def _numpy_type(hint: Any) -> tuple[Any, ...]:
    """Type of a field, and its shape if it is an array."""
    if isinstance(hint, type) and issubclass(hint, Record):
        return (hint.dtype,)
    if isinstance(hint, type) and issubclass(hint, IntEnum):
        return (np.int64,)
    if metadata := getattr(hint, "__metadata__", None):
        return (np.float64, metadata[0])
    return (hint,)


def copy_of_records(array: Any) -> Any:
    """Copy of an array of records, as bytes; numpy would copy field by field."""
    as_bytes = array.view(np.ndarray).view(f"V{array.dtype.itemsize}")
    return as_bytes.copy().view(array.dtype).view(np.recarray)
