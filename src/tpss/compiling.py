"""A cold start on two cores: the kernels are compiled in two parts, by two processes at once.

The second process keeps what it compiles in a cache folder of its own, as two that write into one may
spoil each other's entries.  The first one adopts from it whatever itself does not have.  Where a second
process is of no use or does not succeed, the first one compiles everything, a little later.
"""

import os
import pickle
import subprocess
import sys
import tempfile
from pathlib import Path

from tpss.kernel import cache_folder
from tpss.simulation.parts import compile_calls, driving, load_flow
from tpss.simulation.state import Model


def compile_in_parts(model: Model) -> None:
    """Compile what the clock calls, in two processes; the clock itself is left.

    Parameters
    ----------
    model : Model
        Any: all have the same types.
    """
    if (os.cpu_count() or 1) < 2 or not sys.executable:
        return
    folder = cache_folder()
    with tempfile.TemporaryDirectory(prefix="part-", dir=folder) as apart:
        environment = {**os.environ, "NUMBA_CACHE_DIR": apart}
        command = [sys.executable, "-m", "tpss.compiling"]
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        with subprocess.Popen(command, env=environment, stdin=subprocess.PIPE, **quiet) as second:  # type: ignore[call-overload]
            try:
                _send(model, second)
                compile_calls(load_flow(model))
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
    compile_calls(driving(pickle.load(sys.stdin.buffer)))
