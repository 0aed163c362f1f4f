"""What a run may take: memory, and simulated time."""

from tpss.errors import TooLargeError
from tpss.step.model import Model
from tpss.step.recording import recording_bytes

LONGEST_RUN_S = 7 * 24 * 3600.0
"""A run that waits for a train to arrive gives up after this simulated time. [s]"""

MOST_MEMORY_BYTES = 8 * 2**30
"""A recording larger than this is refused. [byte]"""


def has_room(model: Model, steps: int, trains: int) -> bool:
    """Whether the recording of a run fits into memory."""
    return recording_bytes(model, steps, trains) <= MOST_MEMORY_BYTES


def demand_room(model: Model, steps: int, trains: int) -> None:
    """Refuse a run whose recording would not fit into memory.

    Raises
    ------
    TooLargeError
    """
    if not has_room(model, steps, trains):
        needed = recording_bytes(model, steps, trains)
        raise TooLargeError(
            f"{steps} steps with {trains} trains need {needed / 2**30:.0f} GiB of memory, more than "
            f"{MOST_MEMORY_BYTES / 2**30:.0f}; take a longer time step, a shorter duration or a longer "
            "headway"
        )
