"""Several processes that share a cache of kernels compile each kernel once: one does, others wait.

numba knows no such order.  Two processes that need a kernel at the same time compile it both; and if
they compile it for different types, one may overwrite what the index of the other one names.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from numba.core.compiler_lock import global_compiler_lock
from numba.core.dispatcher import Dispatcher

from tpss.kernel import cache_folder

try:
    import fcntl
except ImportError:  # no such locks on this system: all compile what they need
    fcntl = None  # type: ignore[assignment]


def compile_once() -> None:
    """Let this process wait where another one is compiling the same kernel, then load it."""
    if fcntl is None or getattr(Dispatcher, "waits", False):
        return
    compile_now = Dispatcher.compile

    def compile_or_wait(self: Any, sig: Any) -> Any:
        # The lock of the process first: a thread that waits for a file must not hold up one that has it.
        with global_compiler_lock, _alone(self.py_func):
            return compile_now(self, sig)

    Dispatcher.compile = compile_or_wait
    Dispatcher.waits = True


@contextmanager
def _alone(function: Any) -> Iterator[None]:
    """Hold the lock of a kernel.

    A kernel is compiled while one that calls it is, never the other way round: none waits in a circle.
    """
    folder = Path(cache_folder()) / "locks"
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / f"{function.__module__}.{function.__qualname__}").open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield
