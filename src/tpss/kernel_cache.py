"""Compiled kernels on disk, of which none has to be whole, and without which a run does too.

A computer that loses its power may leave files of a cache empty or cut off; a disk may be full.  What
cannot be read is thrown away and compiled anew, what cannot be written stays in memory, and either is
told once by the logger ``tpss.kernels``.
"""

import logging
from pathlib import Path
from typing import Any

import numba.core.caching

_FunctionCache: Any = numba.core.caching.FunctionCache
_log = logging.getLogger("tpss.kernels")
_told: set[str] = set()


class KernelCache(_FunctionCache):  # type: ignore[misc]
    """The cache of a kernel; see above."""

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Compiled code of a signature; None if there is none, or it is damaged."""
        try:
            return super().load_overload(sig, target_context)
        except Exception as error:  # of damaged bytes, any
            _tell("read", f"{type(error).__name__}: {error}; what is damaged is compiled anew")
            self._throw_away()
            return None

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
