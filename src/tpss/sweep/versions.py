"""Versions of the program that creates the rows of a table."""

from functools import cache
from importlib.metadata import version
from pathlib import Path

import tpss
from tpss.kernel import source_digest


@cache
def versions() -> dict[str, str]:
    """Version of TPSS, and digest of its kernels' sources and of numba's version."""
    package = Path(tpss.__file__).parent
    return {"tpss_version": version("tpss"), "kernel_hash": source_digest(package)}
