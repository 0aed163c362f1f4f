"""What a run may take: memory, and simulated time."""

import math
import os
from functools import cache

from tpss.errors import TooLargeError
from tpss.step.model import Model
from tpss.step.recording import recording_bytes

LONGEST_RUN_S = 7 * 24 * 3600.0
"""A run that waits for a train to arrive gives up after this simulated time. [s]"""

MOST_MEMORY_BYTES = 8 * 2**30
"""A recording larger than this is refused. [byte]"""

PEAK_OVER_RECORDING = 2.5
"""Memory at the end of a run, with its dataset and the file that is saved, over that of the recording;
2.3 were seen in runs of some hundred megabytes. [1]"""

GIB = 2**30


@cache
def memory_of_machine() -> float:
    """Memory that this machine has, or that the process may take of it; infinite: not known. [byte]"""
    found = math.inf
    if hasattr(os, "sysconf"):
        found = float(os.sysconf("SC_PAGE_SIZE")) * float(os.sysconf("SC_PHYS_PAGES"))
    try:
        import resource
    except ImportError:  # not on Windows
        return found
    allowed, _ = resource.getrlimit(resource.RLIMIT_AS)
    return found if allowed == resource.RLIM_INFINITY else min(found, float(allowed))


def has_room(model: Model, steps: int, trains: int) -> bool:
    """Whether a run fits into memory."""
    needed = recording_bytes(model, steps, trains)
    return needed <= MOST_MEMORY_BYTES and PEAK_OVER_RECORDING * needed <= memory_of_machine()


def demand_room(model: Model, steps: int, trains: int) -> None:
    """Refuse a run that would not fit into memory.

    Raises
    ------
    TooLargeError
    """
    if not has_room(model, steps, trains):
        needed = recording_bytes(model, steps, trains)
        limit = f"{MOST_MEMORY_BYTES / GIB:.0f} may be recorded"
        if needed <= MOST_MEMORY_BYTES:
            limit = f"{memory_of_machine() / GIB:.1f} are there"
        raise TooLargeError(
            f"{steps} steps with {trains} trains need {PEAK_OVER_RECORDING * needed / GIB:.1f} GiB of "
            f"memory, {needed / GIB:.1f} of them for what is recorded, and {limit}; take a longer time "
            "step, a shorter duration or a longer headway"
        )
