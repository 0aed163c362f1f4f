"""Faults of a study that varies what no case depends on."""

from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

from tpss.errors import Finding, no_such
from tpss.scenario.fields import LINE
from tpss.scenario.raw import lines_of

NAMES = ("format", "name", "description")
"""Keys of a scenario that say what it is called."""

OUTAGE = "simulation.outage"


def faults_of_paths(
    paths: Mapping[str, str],
    shared: Collection[str],
    base: Mapping[str, Any],
    drawn_on: str,
    source: Path,
) -> Iterator[Finding]:
    """Faults of key paths that change nothing.

    Parameters
    ----------
    paths : mapping of str to str
        Key paths of what varies or is set, and where the study says so.
    shared : collection of str
        Paths of those that all cases share.
    base : mapping
        Document of the base scenario, with these.
    drawn_on : str
        Key of the line whose gradients are drawn; empty if none are.
    source : Path
        The study file.
    """
    chosen = OUTAGE in paths or "outage" in base.get("simulation", {})
    for path, key in paths.items():
        first = path.split(".", 1)[0]
        fault = None
        if first in NAMES:
            fault = f"{first} is not simulated", "leave it out; cases are named after the study"
        elif first == "variants":
            problem = "variants are scenarios of their own, which a study does not run"
            fault = problem, "make each of them an option in [choices], with what it sets"
        elif path in shared:
            continue
        elif first == "outages" and not chosen:
            fault = "no outage applies in any case", f'add {OUTAGE} = ["none", "NAME"] to [vary]'
        elif drawn_on and path.startswith(f"{drawn_on}.gradients"):
            fault = "the gradients of this line are drawn", "leave it out, or the table [gradients]"
        if fault is not None:
            yield Finding(str(source), key, "", *fault)


def fault_of_drawn_line(
    line: str | None, base: Mapping[str, Any], source: Path
) -> Iterator[Finding]:
    """Fault of the name of the line whose gradients are drawn, if it has any."""
    names = list(lines_of(base))
    if line is not None and line not in names:
        yield Finding(str(source), "gradients.line", repr(line), *no_such("line", line, names))
    elif line is None and LINE not in names:
        remedy = f"add line, one of {', '.join(names)}"
        yield Finding(str(source), "gradients", "", "it is not said which line gets them", remedy)
