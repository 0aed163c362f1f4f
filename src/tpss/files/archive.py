"""Archives of others (zip): how much they unpack to is looked at before they are unpacked."""

import io
import zipfile

MOST_TIMES = 200
"""A large part that unpacks to more than so many times its size is no data, which compress to a
hundredth at most."""

LARGE = 10_000_000
"""Parts that unpack to less are never too many times their size. [byte]"""

_DOCTYPE = b"<!DOCTYPE"
_HEAD = 1000
"""First bytes of a part in which a DOCTYPE would stand."""


class BombError(ValueError):
    """An archive unpacks to more than it should."""


def demand_bounded(content: bytes, most_bytes: int) -> None:
    """Refuse a packed document whose parts unpack to too much, or have a DOCTYPE, which may grow.

    Raises
    ------
    BombError
    zipfile.BadZipFile
        It is no archive.
    """
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        total = sum(part.file_size for part in archive.infolist())
        if total > most_bytes:
            most = f"more than the {most_bytes / 1e6:g} MB that are read"
            raise BombError(f"it unpacks to {total / 1e6:.3g} MB, {most}")
        for part in archive.infolist():
            demand_likely(part)
            with archive.open(part) as opened:
                if _DOCTYPE in opened.read(_HEAD).upper():
                    raise BombError(f"its part {part.filename} has a DOCTYPE, which is not read")


def demand_likely(part: zipfile.ZipInfo) -> None:
    """Refuse a part of an archive that unpacks to far more than data do.

    Raises
    ------
    BombError
    """
    if part.file_size > max(LARGE, MOST_TIMES * part.compress_size):
        raise BombError(
            f"its part {part.filename} unpacks to {part.file_size / 1e6:.3g} MB, "
            f"{part.file_size / max(1, part.compress_size):.0f} times its size"
        )
