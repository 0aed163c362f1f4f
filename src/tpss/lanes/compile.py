"""Lane versions of kernels: made when they are asked for, kept as files that can be read.

The files stand beside the compiled kernels, in a folder named after a digest of all that they are made
by: an edit of a kernel, or of this package, makes them anew.
"""

import ast
import hashlib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

from tpss.errors import LanesError
from tpss.kernel import cache_folder, compiled_into
from tpss.lanes import masks
from tpss.lanes.convert import Converter
from tpss.lanes.expressions import NotConvertedError

HELPERS = {
    each: getattr(masks, each)
    for each in ("select", "both", "either", "negated", "as_mask", "anyone", "lowest", "highest",
                 "lane_at", "in_lanes")
}  # fmt: skip
"""What generated code is made of."""

by_hand: dict[Any, tuple[Any, bool]] = {}
"""Lane versions that are written by hand, and whether they take a mask, by their kernels."""

of_math: dict[str, Any] = {}
"""The same of functions of `math`, by their names."""

_made: dict[Any, tuple[Any, bool]] = {}


@cache
def lanes_folder() -> Path:
    """Folder of the generated kernels and of what they are compiled to; it need not be there yet."""
    digest = hashlib.sha256()
    for file in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(file.read_bytes())
    return cache_folder() / f"lanes-{digest.hexdigest()[:16]}"


def are_compiled() -> bool:
    """Whether compiled kernels of lanes exist, of exactly this source."""
    return any(lanes_folder().rglob("*.run_together-*.nbi"))


def compiled(fused: bool) -> Callable[[Callable[..., Any]], Any]:
    """Compile a function of lanes that is written by hand."""
    return lambda function: compiled_into(lanes_folder(), function, fused)


def lane_version(kernel: Any) -> tuple[Any, bool]:
    """The lane version of a kernel, and whether it takes a mask at last.

    Parameters
    ----------
    kernel : callable
        A kernel, or a function that calls another one where there is anything: the other case is taken.

    Raises
    ------
    LanesError
        It, or what it calls, has a form that is not converted.
    OSError
        The folder of generated kernels cannot be written.
    """
    if kernel not in _made:
        _made[kernel] = by_hand.get(kernel) or _make(kernel)
    return _made[kernel]


def _make(kernel: Any) -> tuple[Any, bool]:
    without = getattr(kernel, "without", None)
    python = without or kernel.py_func
    title = f"{python.__module__}.{python.__name__}"
    try:
        converter = Converter(python, lane_version, of_math)
        tree = converter.converted()
    except NotConvertedError as error:
        raise LanesError(
            f"{title} has a form that is not converted, {error}; write it in one of those of "
            "tpss.lanes.convert, or its lane version by hand"
        ) from error
    tree.name = f"{python.__name__}_lanes"
    space = {**python.__globals__, **HELPERS, **converter.replaced}
    made = _from_file(title, tree, space)
    options = {} if without else kernel.targetoptions
    fused = bool(without) or options.get("forceinline") or options.get("inline") == "always"
    return compiled_into(lanes_folder(), made, bool(fused)), converter.needs_mask


def _from_file(title: str, tree: ast.FunctionDef, space: dict[str, Any]) -> Any:
    """A function, by way of a file that can be read; a debugger and numba's cache need one."""
    text = f'"""Made by tpss.lanes from {title}."""\n\n{ast.unparse(tree)}\n'
    file = lanes_folder() / f"{title}.py"
    if not file.exists() or file.read_text("utf-8") != text:
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, "utf-8")
    exec(compile(text, str(file), "exec"), space)
    return space[tree.name]
