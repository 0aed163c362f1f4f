"""The equations behind each chart: which function computes what, in the words of its own source."""

import ast
import inspect
import threading
from functools import cache
from importlib.resources import files
from typing import Any, NamedTuple

from tpss.errors import ResultError
from tpss.studio.formulas import in_pieces


class Source(NamedTuple):
    """A function of the program: its file below ``src/tpss``, and its name, if it is not all of it."""

    file: str
    function: str
    page: str
    """Of the documentation, which says how the equation is read."""


_LOAD_FLOW = Source("powerflow/newton.py", "", "theory/load-flow.html")
_CONVERTER = (
    Source("sources/converter.py", "converter_voltage", "theory/converter.html"),
    Source("sources/converter.py", "terminal_voltage", "theory/converter.html"),
    Source("sources/converter.py", "grid_angle", "theory/converter.html"),
)
_LOADING = Source("sources/kinds.py", "loading", "theory/converter.html")
_MOTION = (
    Source("physics/locomotive.py", "acceleration", "theory/train.html"),
    Source("physics/locomotive.py", "machine_force", "theory/train.html"),
    Source("physics/adhesion.py", "adhesion_limit", "theory/train.html"),
    Source("physics/running_resistance.py", "running_resistance", "theory/train.html"),
    Source("physics/running_resistance.py", "gradient_force", "theory/train.html"),
    Source("driving/braking.py", "braking_plan", "theory/driving.html"),
)
_POWER = (
    Source("physics/locomotive.py", "motor_power", "theory/train.html"),
    Source("physics/locomotive.py", "active_power", "theory/train.html"),
    Source("vehicle/demand.py", "electrical_demand", "theory/train.html"),
)

BEHIND: dict[str, tuple[Source, ...]] = {
    "voltage": (_LOAD_FLOW, *_CONVERTER, *_POWER),
    "graph": _MOTION,
    "powers": (*_POWER, *_CONVERTER, _LOAD_FLOW),
    "loading": (_LOADING, *_CONVERTER),
    "losses": (_LOAD_FLOW,),
}
"""What stands behind a chart, by its name; a chart more may have a line here."""


def behind(chart: str) -> list[dict[str, Any]]:
    """Functions behind a chart, with their files and pages, and their texts as words and formulas.

    Raises
    ------
    ResultError
        Nothing is told of such a chart.
    """
    if chart not in BEHIND:
        raise ResultError(f"no equations are told of {chart!r}; charts: {', '.join(BEHIND)}")
    return [
        {
            "function": each.function or each.file,
            "file": f"tpss/{each.file}",
            "page": each.page,
            "pieces": in_pieces(text_of(each.file, each.function)),
        }
        for each in BEHIND[chart]
    ]


_one_parses = threading.Lock()
"""Held while a source is parsed: Python 3.11 counts the depth of trees for all threads together."""


@cache
def text_of(file: str, function: str) -> str:
    """The docstring of a function, or of a whole file, from the source, so that nothing is imported.

    Raises
    ------
    KeyError
        The file has no such function.
    """
    with _one_parses:
        tree = ast.parse((files("tpss") / file).read_text(encoding="utf-8"))
    if not function:
        return inspect.cleandoc(ast.get_docstring(tree) or "")
    found = {node.name: node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}
    return inspect.cleandoc(ast.get_docstring(found[function]) or "")
