"""Several processes that share a cache of kernels compile each kernel once: one does, others wait.

numba knows no such order.  Two processes that need a kernel at the same time compile it both; and if
they compile it for different types, one may overwrite what the index of the other one names.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from hashlib import sha256
from typing import Any

from numba.core.caching import FunctionCache
from numba.core.compiler_lock import global_compiler_lock
from numba.core.dispatcher import Dispatcher
from numba.core.sigutils import normalize_signature

from tpss.kernel import cache_folder

try:
    import fcntl
except ImportError:  # no such locks on this system: all compile what they need
    fcntl = None  # type: ignore[assignment]


def compile_once() -> None:
    """Let this process wait where another one compiles a kernel for the same types, then load it."""
    if fcntl is None or hasattr(Dispatcher.compile, "waits"):
        return
    compile_now, save_now = Dispatcher.compile, FunctionCache.save_overload

    def compile_or_wait(self: Any, sig: Any) -> Any:
        types, _ = normalize_signature(sig)
        if tuple(types) in self.overloads:
            return compile_now(self, sig)
        # The lock of the process first: a thread that waits for a file must not hold up one that has it.
        with global_compiler_lock, _alone(self.py_func, sha256(str(types).encode()).hexdigest()):
            return compile_now(self, sig)

    def save_one_by_one(self: Any, sig: Any, data: Any) -> None:
        with _alone(self._py_func, "index"):
            save_now(self, sig, data)

    compile_or_wait.waits = True  # type: ignore[attr-defined]
    Dispatcher.compile, FunctionCache.save_overload = compile_or_wait, save_one_by_one


@contextmanager
def _alone(function: Any, what: str) -> Iterator[None]:
    """Hold a lock of a kernel.

    A kernel is compiled while one that calls it is, never the other way round: none waits in a circle.
    """
    folder = cache_folder() / "locks"
    folder.mkdir(parents=True, exist_ok=True)
    name = f"{function.__module__}.{function.__qualname__}".replace("<", "").replace(">", "")
    with (folder / f"{name}-{what[:16]}").open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield
