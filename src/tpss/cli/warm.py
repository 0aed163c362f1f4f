"""The command ``tpss warm``: compile all kernels ahead."""

import sys

from tpss.cli.run import DONE, INTERRUPTED
from tpss.cli.terminal import Console, counted_kernels, say
from tpss.errors import ResultError


def warm_up(quiet: bool) -> int:
    """Compile all kernels, with a bar of those that are done; return the exit code.

    Raises
    ------
    ResultError
        The kernels cannot be kept.
    """
    from tpss.kernel import cache_folder, compiles, is_kept
    from tpss.warm import warm

    if not compiles():
        raise ResultError("NUMBA_DISABLE_JIT is set, so nothing is compiled; unset it")
    if not is_kept():
        remedy = "let NUMBA_CACHE_DIR name a folder that can be written"
        raise ResultError(f"compiled kernels cannot be kept; {remedy}")
    console = Console(stderr=True, quiet=quiet)
    try:
        with counted_kernels("Compiling", console) as rename:
            count = warm(lambda at: rename(f"{at.number + 1} of {at.occasions}: {at.occasion}"))
    except KeyboardInterrupt:
        print("Interrupted; the same command continues.", file=sys.stderr)
        return INTERRUPTED
    if not quiet:
        folder = cache_folder()
        nothing = f"Nothing had to be compiled; the kernels are in {folder}"
        say(Console(), f"Compiled {count} kernels into {folder}" if count else nothing)
    return DONE
