"""A Ctrl-C between two stretches of a run, in place of an exception in the midst of a kernel."""

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def interruptible(notice: Callable[[], None] | None = None) -> Iterator[list[int]]:
    """Give a list that a Ctrl-C fills, in place of an exception in the midst of a kernel.

    A second Ctrl-C interrupts as usual.  Nothing is changed outside the main thread, nor where a
    Ctrl-C is ignored, as in the background of a shell script.

    Parameters
    ----------
    notice : callable, optional
        Called at the first Ctrl-C, between any two instructions of the program.
    """
    received: list[int] = []
    usual = signal.getsignal(signal.SIGINT)
    in_main = threading.current_thread() is threading.main_thread()
    if not in_main or usual in (signal.SIG_IGN, None):
        yield received
        return

    def note(number: int, _: object) -> None:
        received.append(number)
        signal.signal(signal.SIGINT, usual)
        if notice is not None:
            notice()

    signal.signal(signal.SIGINT, note)
    try:
        yield received
    finally:
        signal.signal(signal.SIGINT, usual)
