"""Compile the kernels of every run for processors of each level, for a wheel that carries them.

    python tools/ship_kernels.py && pip wheel . --no-deps --wheel-dir dist

A wheel built after that holds kernels for the Python, the packages and the operating system that ran
this; on all others it compiles as ever.  Levels that this processor has not are left out.
"""

import argparse
import hashlib
import os
import pickle
import subprocess
import sys
import tempfile
import time
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import llvmlite.binding

import tpss
from tpss.kernel import KERNEL_PACKAGES, source_digest
from tpss.shipped import FOLDER, file_name, key_of, levels_of

SHIPPED = ("every run",)
"""Of `tpss.warm.OCCASIONS`: what few lines need would make the wheel several times as large."""

PACKAGE = Path(tpss.__file__).parent


def modules() -> dict[tuple[str, str], str]:
    """Modules with kernels by the folder and the beginning of the name that numba gives to theirs."""
    found = {}
    for package in KERNEL_PACKAGES:
        for file in (PACKAGE / package).rglob("*.py"):
            digest = hashlib.sha1(str(file.parent).encode()).hexdigest()
            dotted = ".".join(file.relative_to(PACKAGE.parent).with_suffix("").parts)
            found[f"{file.parent.name}_{digest}", file.stem] = dotted
    return found


def compile_for_level(level: str, folder: Path) -> None:
    """Compile all kernels into a folder, for a level in place of this processor."""
    environment = {
        **os.environ,
        "NUMBA_CPU_NAME": level,
        "NUMBA_CPU_FEATURES": "",
        "NUMBA_CACHE_DIR": str(folder),
    }
    call = f"from tpss.warm import warm; warm(names={SHIPPED!r})"
    subprocess.run([sys.executable, "-c", call], env=environment, check=True)


def indices(folder: Path, level: str) -> Iterator[tuple[str, dict[Any, Path]]]:
    """Names of the kernels in a cache of numba, and the files of their code by their keys."""
    known = modules()
    for path in sorted(folder.rglob("*.nbi")):
        stem, rest = path.name.split(".", 1)
        dotted = known.get((path.parent.name, stem))
        if dotted is None:
            continue
        with path.open("rb") as file:
            pickle.load(file)  # the version of numba
            _, overloads = pickle.loads(file.read())
        name = f"{dotted}.{rest.rsplit('-', 1)[0]}"
        yield name, {key_of(key, level): path.parent / code for key, code in overloads.items()}


def pack(folder: Path, level: str) -> Path:
    """Write the file of a level from a cache of numba; return it."""
    target = FOLDER / file_name(source_digest(PACKAGE), level)
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        number = 0
        for name, codes in indices(folder, level):
            places = {}
            for key, code in codes.items():
                places[key] = str(number)
                archive.writestr(str(number), code.read_bytes())
                number += 1
            archive.writestr(f"{name}.index", pickle.dumps(places))
    return target


def main() -> None:
    """Make the files of all levels that this processor has, in place of those there are."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.parse_args()
    levels = levels_of(llvmlite.binding.get_host_cpu_features())
    if not levels:
        sys.exit("this processor has none of the levels for which kernels are shipped")
    FOLDER.mkdir(exist_ok=True)
    for old in FOLDER.glob("*.zip"):
        old.unlink()
    for level in levels:
        started = time.perf_counter()
        with tempfile.TemporaryDirectory() as scratch:
            compile_for_level(level, Path(scratch))
            target = pack(Path(scratch), level)
        size_mb, took_s = target.stat().st_size / 1e6, time.perf_counter() - started
        print(f"Wrote {target.name}: {size_mb:.1f} MB in {took_s:.0f} s")


if __name__ == "__main__":
    main()
