"""A cold start on two cores: the kernels are compiled in parts, by two processes at once.

The second process keeps what it compiles in a cache folder of its own, as two that write into one may
spoil each other's entries.  The first one adopts from it whatever itself does not have.  Where a second
process is of no use or does not succeed, the first one compiles everything, a little later.
"""

import os
import pickle
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from tpss.audit.aggregate import gather, new_figures
from tpss.kernel import cache_folder, kernels_are_compiled
from tpss.simulation.parts import Call, compile_calls, driving, load_flow, start
from tpss.simulation.run import Clock, compile_kernels
from tpss.simulation.state import Model, new_recording

_ready: set[Clock] = set()
"""Clocks all of whose kernels this process has compiled or loaded."""


def make_ready(model: Model, clock: Clock) -> None:
    """Compile all kernels of a run, or load them from the cache, once in this process.

    Parameters
    ----------
    model : Model
        Any: all have the same types.
    clock : callable
        What runs the steps.
    """
    if clock in _ready:
        return
    if not kernels_are_compiled() and (os.cpu_count() or 1) > 1 and sys.executable:
        with _compiled_apart("driving", model):
            compile_calls(load_flow(model))
        with _compiled_apart("figures", model):
            compile_kernels(model)
    compile_kernels(model, clock)
    compile_calls(figures(model))
    _ready.add(clock)


def figures(model: Model) -> list[Call]:
    """Kernels that gather the figures of a run and audit it."""
    _, trains = start(model)
    recording, blank = new_recording(model, 0, trains.size), new_figures(model, trains.size, [])
    at_line_level = np.zeros(model.network.source_of_node.size, dtype=bool)
    return [(gather, (0, 0, 0, at_line_level, trains, model, recording, blank))]


@contextmanager
def _compiled_apart(part: str, model: Model) -> Iterator[None]:
    """Have a part compiled by a second process meanwhile, and adopt what it has made at the end."""
    folder = cache_folder()
    with tempfile.TemporaryDirectory(prefix="part-", dir=folder) as apart:
        environment = {**os.environ, "NUMBA_CACHE_DIR": apart}
        command = [sys.executable, "-m", "tpss.compiling", part]
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        with subprocess.Popen(command, env=environment, stdin=subprocess.PIPE, **quiet) as second:  # type: ignore[call-overload]
            try:
                _send(model, second)
                yield
                second.wait()
            finally:
                second.kill()
        adopt(Path(apart) / "tpss" / folder.name, folder)


def _send(model: Model, process: "subprocess.Popen[bytes]") -> None:
    assert process.stdin is not None
    try:
        with process.stdin as stdin:
            pickle.dump(model, stdin)
    except BrokenPipeError:
        pass  # it has ended already; all is compiled here


def adopt(apart: Path, folder: Path) -> None:
    """Move compiled kernels into a cache folder that does not know them.

    Of a kernel that both know, nothing is moved: entries of one index must be of one origin.
    """
    for index in sorted(apart.rglob("*.nbi")):
        target = folder / index.relative_to(apart)
        if not target.exists():
            target.parent.mkdir(parents=True, exist_ok=True)
            for code in index.parent.glob(f"{index.stem}.*.nbc"):
                code.replace(target.parent / code.name)
            index.replace(target)


if __name__ == "__main__":
    parts = {"driving": driving, "figures": figures}
    compile_calls(parts[sys.argv[1]](pickle.load(sys.stdin.buffer)))
