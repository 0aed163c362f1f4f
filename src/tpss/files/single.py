"""A file of its own, written whole or not at all."""

from pathlib import Path

from tpss.files.refusals import explained, refuse_to_replace
from tpss.files.whole import Content, write_file


def save_file(place: Path, content: Content, force: bool) -> Path:
    """Write a file, in place of one that is there only by force; its folder is made if it is not there.

    Raises
    ------
    ResultError
        The file exists, or cannot be written.
    """
    refuse_to_replace(place, force, "a file", Path.is_file)
    with explained(place):
        place.parent.mkdir(parents=True, exist_ok=True)
        write_file(place, content)
    return place
