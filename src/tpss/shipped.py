"""Kernels that come compiled with the package, so that a first run compiles nothing.

Machine code fits one release of numba and of LLVM, one Python, one operating system and processors of
one level.  All of that, and the digest of the kernels' sources, is in the name of the file: what does
not fit is not found, and kernels are compiled as ever.  ``python tools/ship_kernels.py`` makes files.

A level is named as compilers do: x86-64-v3 has AVX2 and fused products, x86-64-v4 the parts of AVX-512
that all its processors have.  The same kernel gives the same numbers on both, to the last bit.

A file is a zip archive: for each kernel an index, of signatures and what the function was, and for each
signature what numba would have written into its cache.
"""

import pickle
import platform
import sys
import threading
import zipfile
from collections.abc import Callable, Hashable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import llvmlite
import llvmlite.binding
import numba

FOLDER = Path(__file__).with_name("kernels")
"""Where the files lie."""

LEVELS = {
    "x86-64-v4": (
        "avx2", "fma", "bmi", "bmi2", "f16c", "lzcnt", "movbe",
        "avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl",
    ),
    "x86-64-v3": ("avx2", "fma", "bmi", "bmi2", "f16c", "lzcnt", "movbe"),
}  # fmt: skip
"""What a processor of each level has, beside what all 64-bit ones have; the best level first."""

_config: Any = numba.config
_binding: Any = llvmlite.binding


def levels_of(features: Mapping[str, bool]) -> list[str]:
    """Levels that a processor with these features has, the best one first; none but on x86-64."""
    if platform.machine().lower() not in ("x86_64", "amd64"):
        return []
    return [level for level, needed in LEVELS.items() if all(features.get(each) for each in needed)]


def file_name(digest: str, level: str) -> str:
    """Name of the file of kernels that fit this Python, its packages and its operating system.

    Parameters
    ----------
    digest : str
        Of the kernels' sources, which holds the version of numba too.
    level : str
        One of `LEVELS`.
    """
    python = f"cp{sys.version_info[0]}{sys.version_info[1]}{getattr(sys, 'abiflags', '')}"
    system = f"{sys.platform}-llvmlite{llvmlite.__version__}"
    return f"{digest}-{python}-{system}-{level}.zip"


class Shipped:
    """The kernels of a file."""

    def __init__(self, path: Path, level: str) -> None:
        self.path, self.level = path, level
        self._archive = zipfile.ZipFile(path)
        self._names = frozenset(self._archive.namelist())
        self._lock = threading.Lock()

    def load(self, kernel: str, key: Hashable) -> Any:
        """What numba would have written of a kernel for a key; None if that is not there.

        Raises
        ------
        zipfile.BadZipFile
            The file is damaged.
        """
        index = f"{kernel}.index"
        if index not in self._names:
            return None
        with self._lock:  # threads share the position in the file
            place = pickle.loads(self._archive.read(index)).get(key)
            return None if place is None else pickle.loads(self._archive.read(place))

    def has(self, function: str) -> bool:
        """Whether there is code of any kernel of this name."""
        return any(f".{function}.index" in f".{name}" for name in self._names)


@cache
def shipped(digest: str) -> Shipped | None:
    """The shipped kernels that fit; None if there are none, or numba was told another processor.

    Parameters
    ----------
    digest : str
        Of the kernels' sources.
    """
    if _config.CPU_NAME or _config.DISABLE_JIT or not FOLDER.is_dir():
        return None
    for level in levels_of(_binding.get_host_cpu_features()):
        path = FOLDER / file_name(digest, level)
        if path.is_file():
            return Shipped(path, level)
    return None


def name_of(function: Callable[..., Any]) -> str:
    """Name of a kernel in a file."""
    return f"{function.__module__}.{function.__qualname__}"


def key_of(key: tuple[Any, ...], level: str) -> tuple[Any, ...]:
    """A key of numba's cache, with the level in place of the processor it was compiled on."""
    signature, _, function = key
    return signature, level, function
