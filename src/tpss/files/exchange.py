"""Two folders that take each other's place in one step of the file system."""

import ctypes
import errno
import os
import sys
from pathlib import Path

AT_THE_CURRENT_FOLDER, EXCHANGE = -100, 2
"""`AT_FDCWD` and `RENAME_EXCHANGE` of Linux, and `RENAME_SWAP` of macOS, which is 2 too."""

CANNOT = (errno.ENOSYS, errno.EINVAL, errno.ENOTSUP, errno.EOPNOTSUPP)
"""What systems and file systems answer that cannot do it."""


def exchange(one: Path, other: Path) -> bool:
    """Let two folders of a disk take each other's name; return whether the system can do that.

    Raises
    ------
    OSError
    """
    try:
        library = ctypes.CDLL(None, use_errno=True)
        if sys.platform == "linux":
            call = library.renameat2
            here = ctypes.c_int(AT_THE_CURRENT_FOLDER)
            arguments = (here, os.fsencode(one), here, os.fsencode(other))
        else:
            call = library.renamex_np
            arguments = (os.fsencode(one), os.fsencode(other))
    except (AttributeError, OSError, TypeError):  # the last two on Windows
        return False
    if call(*arguments, ctypes.c_uint(EXCHANGE)) == 0:
        return True
    number = ctypes.get_errno()
    if number in CANNOT:
        return False
    raise OSError(number, os.strerror(number), str(other))
