"""Compiled kernels on disk, of which none has to be whole, and without which a run does too.

What is not in the user's cache may have come with the package (`tpss.shipped`).

A computer that loses its power may leave files of a cache empty or cut off; a disk may be full.  What
cannot be read is thrown away and compiled anew, what cannot be written stays in memory, and either is
told once by the logger ``tpss.kernels``.
"""

import logging
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba.core.caching

from tpss.shipped import Shipped, key_of, name_of

_FunctionCache: Any = numba.core.caching.FunctionCache
_log = logging.getLogger("tpss.kernels")
_told: set[str] = set()


class KernelCache(_FunctionCache):  # type: ignore[misc]
    """The cache of a kernel; see above.

    Parameters
    ----------
    function : callable
        The kernel in Python.
    shipped : callable
        Gives the kernels that came with the package, None if none fit.
    """

    def __init__(self, function: Callable[..., Any], shipped: Callable[[], Shipped | None]) -> None:
        super().__init__(function)
        self._shipped = shipped

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Compiled code of a signature; None if there is none, or it is damaged."""
        try:
            return super().load_overload(sig, target_context)
        except Exception as error:  # of damaged bytes, any
            _tell("read", f"{type(error).__name__}: {error}; what is damaged is compiled anew")
            self._throw_away()
            return None

    def _load_overload(self, sig: Any, target_context: Any) -> Any:
        """`load_overload` of what is whole: the user's own code, else what came with the package."""
        found = super()._load_overload(sig, target_context)
        if found is not None or (shipped := self._shipped()) is None:
            return found
        key = key_of(self._index_key(sig, target_context.codegen()), shipped.level)
        data = shipped.load(name_of(self._py_func), key)
        return None if data is None else self._impl.rebuild(target_context, data)

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep compiled code, where there is room."""
        try:
            super().save_overload(sig, data)
        except OSError as error:
            _tell("written", f"{error}; the next start compiles again")
            self._throw_away()

    @property
    def index(self) -> Path:
        """File that says what of the kernel is compiled."""
        return Path(self._cache_file._index_path)

    def _throw_away(self) -> None:
        """Remove the files of this kernel, which may be damaged, or written in part."""
        index = self.index
        for file in [index, *index.parent.glob(f"{index.stem}.*.nbc")]:
            try:
                file.unlink(missing_ok=True)
            except OSError as error:
                _tell("cleared", str(error))


def _tell(what: str, why: str) -> None:
    """Say that the cache cannot be read or written, once a process."""
    if what not in _told:
        _told.add(what)
        _log.warning("the cache of compiled kernels cannot be %s: %s", what, why)
