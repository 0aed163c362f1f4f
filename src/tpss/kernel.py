"""Compilation of numerical kernels, with a cache that no edit can leave stale.

numba keys its file cache on the file that holds a function, not on the files of the functions that
it calls: a formula edited in another file would silently keep its old result.  The cache folder is
therefore named after a digest of *all* kernel sources.
"""

import hashlib
import os
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import numba
import numba.extending
import numpy as np
import platformdirs

from tpss.kernel_cache import KernelCache
from tpss.kernel_calls import KernelCompiler, KernelDispatcher, for_kernels
from tpss.shipped import Shipped, shipped

_Function = TypeVar("_Function", bound=Callable[..., Any])
_Int = TypeVar("_Int", bound=int)

_config: Any = numba.config
_njit: Any = numba.njit
_cache_of: Any = KernelCache
_overload: Any = numba.extending.overload

_indices: list[Path] = []
"""Files that say what of each kernel is compiled, within the folder of all."""

_OPTIONS: dict[str, Any] = {
    "cache": True,
    "nogil": True,
    "error_model": "numpy",
    "no_cfunc_wrapper": True,  # nobody calls a kernel from C
    "_nrt": False,  # kernels allocate nothing, so no references need counting
    # Not fast-math: a product and the sum that it enters may be rounded once in place of twice, and
    # nothing else.  NaN, infinities and the order of operations stay what they are.
    "fastmath": {"contract"},
    "pipeline_class": KernelCompiler,
}

_WITHOUT_CACHE = {name: value for name, value in _OPTIONS.items() if name != "cache"}

KERNEL_PACKAGES = (
    "numerics", "physics", "storage", "vehicle", "sources", "track", "powerflow", "driving", "step",
    "audit",
)  # fmt: skip
"""Packages that hold kernels."""


def source_digest(package_folder: Path) -> str:
    """Digest of every kernel source below `package_folder`, of how it is compiled, and of numba's
    version.
    """
    digest = hashlib.sha256(numba.__version__.encode())
    for shared in (Path(__file__).name, "kernel_calls.py", "quick_compiling.py", "record.py"):
        digest.update((package_folder / shared).read_bytes())
    for name in KERNEL_PACKAGES:
        for file in sorted((package_folder / name).rglob("*.py")):
            digest.update(file.relative_to(package_folder).as_posix().encode())
            digest.update(file.read_bytes())
    return digest.hexdigest()[:16]


@cache
def cache_folder() -> Path:
    """Folder of the compiled kernels, in `kernels_home` or, if that is not writable, a temporary one."""
    digest = source_digest(Path(__file__).parent)
    try:
        folder = kernels_home() / digest
        folder.mkdir(parents=True, exist_ok=True)
        writable = os.access(folder, os.W_OK)
    except (OSError, RuntimeError):  # also of a user without a home
        writable = False
    return folder if writable else Path(tempfile.mkdtemp(prefix="tpss-kernels-")) / "tpss" / digest


def kernels_home() -> Path:
    """Folder of compiled kernels of all versions: that of the system for caches of the user.

    ``NUMBA_CACHE_DIR`` names another one.

    Raises
    ------
    RuntimeError
        The user has no home.
    """
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    home = Path(chosen, "tpss") if chosen else platformdirs.user_cache_path("tpss", appauthor=False)
    return home.expanduser()


@cache
def shipped_kernels() -> Shipped | None:
    """The kernels that came compiled with the package; None if none fit."""
    return shipped(source_digest(Path(__file__).parent))


def compiles() -> bool:
    """Whether kernels are compiled; they stay plain Python under ``NUMBA_DISABLE_JIT=1``."""
    return not _config.DISABLE_JIT


def is_kept() -> bool:
    """Whether compiled kernels are there for later processes, not in a folder for this one only."""
    try:
        return cache_folder().parent == kernels_home()
    except RuntimeError:
        return False


def compiled_kernels() -> tuple[int, int]:
    """How many of the kernels that were imported are on disk, and how many there are.

    Those count that another process compiles for this one in a folder of its own.  Kernels that become
    part of others do not count, as they are not compiled by themselves.
    """
    folders = [cache_folder(), *cache_folder().glob("part-*/tpss/*")]
    done = sum(any((folder / index).exists() for folder in folders) for index in _indices)
    return done, len(_indices)


def kernels_are_compiled(last: str) -> bool:
    """Whether compiled kernels of exactly this source exist (or compilation is off).

    Parameters
    ----------
    last : str
        Name of the kernel that is compiled last.
    """
    if not compiles() or any(cache_folder().rglob(f"*.{last}-*.nbi")):
        return True
    fitting = shipped_kernels()
    return fitting is not None and fitting.has(last)


def kernel(function: _Function) -> _Function:
    """Compile `function` at its first call and keep the result on disk.

    Division by zero gives inf or NaN, as in numpy; NaN checks stay; the global
    interpreter lock is released.  Kernels allocate nothing, so they are compiled without the
    counting of references to arrays, which would cost as much as the arithmetic.  Under
    ``NUMBA_DISABLE_JIT=1`` the function stays plain Python.
    """
    return _compiled(function, inline="never")


def inlined(function: _Function) -> _Function:
    """`kernel` for a function with one caller: compiled as a part of it, not once more by itself."""
    return _compiled(function, inline="always")


def fused(function: _Function) -> _Function:
    """`kernel` whose machine code goes into each of its callers: for what the innermost loops call.

    There a call costs as much as the work that it asks for.  Every further caller takes longer to
    compile.
    """
    return _compiled(function, inline="never", forceinline=True)


def fused_like_numpy(function: _Function) -> _Function:
    """`fused` with every product rounded before it enters a sum, as numpy does it: for what has to be
    the same, to the last digit, as what arrays give.
    """
    return _compiled(function, inline="never", forceinline=True, fastmath=False)


def where_any(without: Callable[..., Any]) -> Callable[[_Function], _Function]:
    """Let compiled code call a function where its first argument holds anything; where that is an empty
    tuple, `without`.

    An empty tuple is a type of its own.  So of a kernel that is handed one, numba compiles what it would
    be if the function had never been written: neither a run nor a first start takes longer for those who
    have no use for it.  A kernel that is handed something is compiled once more.
    """

    def decorate(function: _Function) -> _Function:
        def call(part: Any, *others: Any) -> Any:
            return (without if part == () else function)(part, *others)

        def choose(part: Any, *_: Any) -> Callable[..., Any]:
            return without if part == numba.types.Tuple(()) else function

        call.without = without  # type: ignore[attr-defined]
        if compiles():
            _overload(call, jit_options=_WITHOUT_CACHE, strict=False)(choose)
        return call  # type: ignore[return-value]

    return decorate


def in_compiled_code(intrinsic: Any) -> Callable[[_Function], _Function]:
    """Let compiled code generate what `intrinsic` says where plain Python calls a function.

    The function has a record with an `address` and `parameters`, and what it is given.
    """

    def decorate(function: _Function) -> _Function:
        def choose(*_: Any) -> Callable[..., Any]:
            return lambda called, given: intrinsic(called.address, given, called.parameters)

        if compiles():
            _overload(function, jit_options=_WITHOUT_CACHE, strict=False)(choose)
        return function

    return decorate


def compiled_into(folder: Path, function: _Function, fused: bool) -> _Function:
    """Compile a function that is no kernel of every run, with the options of one.

    Parameters
    ----------
    folder : Path
        Where the result is kept.
    function : callable
        From a file that changes whenever it does.
    fused : bool
        As of `fused`.
    """
    folder_before = _config.CACHE_DIR
    _config.CACHE_DIR = str(folder)
    try:
        compiled: Any = _njit(inline="never", forceinline=fused, **_OPTIONS)(function)
        if compiles():
            compiled.__class__ = KernelDispatcher
            compiled._cache = _cache_of(function, _none_shipped)
    finally:
        _config.CACHE_DIR = folder_before
    return compiled  # type: ignore[no-any-return]


def _none_shipped() -> None:
    """No kernels came with the package."""


def _compiled(function: _Function, inline: str, **others: Any) -> _Function:
    options = {**_OPTIONS, **others}
    folder_before = _config.CACHE_DIR
    _config.CACHE_DIR = str(cache_folder())
    try:
        compiled: Any = _njit(inline=inline, **options)(function)
        if compiles():
            compiled.__class__ = KernelDispatcher
            compiled._cache = _cache_of(function, shipped_kernels)
            if inline == "never":
                _indices.append(compiled._cache.index.relative_to(cache_folder()))
    finally:
        _config.CACHE_DIR = folder_before
    return compiled  # type: ignore[no-any-return]


at = np.uint64
"""Index that is not negative: compiled code need not ask whether it counts from the end."""


def switch(value: _Int) -> _Int:
    """Constant that selects what a kernel does when it runs.

    numba compiles a kernel once more for each plain number or boolean that it is called with.
    """
    return np.int64(value)  # type: ignore[return-value]


def plain(function: _Function) -> _Function:
    """The plain Python of a kernel, for the few calls of a set-up, which no compilation would repay."""
    python: _Function = getattr(function, "py_func", function)
    return python


def compile_for(
    function: Callable[..., Any], arguments: tuple[Any, ...], by_kernels: bool = False
) -> None:
    """Compile a kernel for its arguments, or load it from the cache, without running it.

    Parameters
    ----------
    by_kernels : bool
        Only other kernels call it, not Python.
    """
    if hasattr(function, "compile"):  # not if compilation is switched off
        with for_kernels(by_kernels):
            function.compile(tuple(numba.typeof(argument) for argument in arguments))
