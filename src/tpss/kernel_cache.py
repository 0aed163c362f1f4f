"""Compiled kernels on disk, of which none has to be whole, and without which a run does too.

What is not in the user's cache may have come with the package (`tpss.shipped`).

A computer that loses its power may leave files of a cache empty or cut off; a disk may be full.  What
cannot be read is thrown away and compiled anew, what cannot be written stays in memory, and either is
told once by the logger ``tpss.kernels``.  Files end in a checksum: machine code with another bit in it
can be read, and ends the process without a word.
"""

import io
import logging
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numba.core.caching

from tpss.kernel_calls import KernelResults
from tpss.shipped import Shipped, key_of, name_of

_FunctionCache: Any = numba.core.caching.FunctionCache
_CacheFiles: Any = numba.core.caching.IndexDataCacheFile
_log = logging.getLogger("tpss.kernels")
_told: set[str] = set()


_CHECKSUM_BYTES = 4


def _checksum(content: bytes) -> bytes:
    return zlib.crc32(content).to_bytes(_CHECKSUM_BYTES, "big")


class CheckedFiles(_CacheFiles):  # type: ignore[misc]
    """The files of a kernel in the cache, each of which ends in a checksum of what is before it."""

    def _load_index(self) -> Any:
        self._demand_whole(Path(self._index_path))
        return super()._load_index()

    def _load_data(self, name: str) -> Any:
        self._demand_whole(Path(self._data_path(name)))
        return super()._load_data(name)

    @staticmethod
    def _demand_whole(file: Path) -> None:
        """Raise a `ValueError` if a file is there and not as it was written."""
        content = file.read_bytes() if file.exists() else b""
        if content and content[-_CHECKSUM_BYTES:] != _checksum(content[:-_CHECKSUM_BYTES]):
            raise ValueError(f"{file.name} is not as it was written")

    @contextmanager
    def _open_for_write(self, filepath: str) -> Iterator[io.BytesIO]:
        """A file in memory, which is written with its checksum; what reads it passes that over."""
        content = io.BytesIO()
        yield content
        with super()._open_for_write(filepath) as file:
            file.write(content.getvalue() + _checksum(content.getvalue()))


class KernelCache(_FunctionCache):  # type: ignore[misc]
    """The cache of a kernel; see above.

    Parameters
    ----------
    function : callable
        The kernel in Python.
    shipped : callable
        Gives the kernels that came with the package, None if none fit.
    """

    _impl_class = KernelResults

    def __init__(self, function: Callable[..., Any], shipped: Callable[[], Shipped | None]) -> None:
        super().__init__(function)
        stamp, name = self._impl.locator.get_source_stamp(), self._impl.filename_base
        self._cache_file: Any = CheckedFiles(self._cache_path, name, stamp)
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
