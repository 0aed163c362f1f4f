"""Files that are there whole or not at all."""

import os
from pathlib import Path


def write_whole(place: Path, content: bytes) -> None:
    """Write a file that is there whole, and on the disk, or not at all.

    Raises
    ------
    OSError
    """
    unfinished = place.with_name(f"{place.name}.unfinished")
    try:
        with unfinished.open("wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        unfinished.replace(place)
    except OSError:
        unfinished.unlink(missing_ok=True)
        raise
