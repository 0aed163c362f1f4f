"""What all benchmarks share: the machine in words, tables, and where published figures go."""

import argparse
import json
import os
import platform
import re
from collections.abc import Iterable, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "benchmarks.md"
FIGURES = ROOT / "docs" / "figures"
RESULTS = Path(__file__).parent / "results"


def arguments(text: str | None, **defaults: int) -> argparse.Namespace:
    """The command line of a benchmark: whole numbers with defaults, and ``--publish``."""
    parser = argparse.ArgumentParser(description=text)
    for name, value in defaults.items():
        parser.add_argument(f"--{name}", type=int, default=value, help=f"default: {value}")
    parser.add_argument(
        "--publish", action="store_true", help="write the result to benchmarks/results and docs"
    )
    return parser.parse_args()


def machine(*packages: str) -> dict[str, str]:
    """Processor, cores, Python, and the versions of TPSS and of some packages."""
    return {
        "processor": _processor(),
        "cores": str(os.cpu_count()),
        "system": f"{platform.system()} {platform.machine()}",
        "Python": platform.python_version(),
        **{name: version(name) for name in ("tpss", "numba", "numpy", *packages)},
    }


def _processor() -> str:
    """Name of the processor, as Linux tells it."""
    file = Path("/proc/cpuinfo")
    text = file.read_text("utf-8") if file.exists() else ""
    found = re.search(r"^model name\s*: (.+)$", text, re.MULTILINE)
    return found[1] if found else platform.processor()


def stay_on_one_core() -> None:
    """Keep this process, with all threads that it may start, on one core (Linux)."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Table in Markdown."""
    lines = (f"| {' | '.join(cells)} |" for cells in rows)
    return "\n".join([f"| {' | '.join(head)} |", f"|{'---|' * len(head)}", *lines])


def caption(described: dict[str, str]) -> str:
    """The machine as a sentence."""
    hardware = "{processor}, {cores} cores, {system}".format(**described)
    versions = [f"{name} {value}" for name, value in list(described.items())[3:]]
    return f"{hardware}; {', '.join(versions)}."


def deliver(name: str, result: dict[str, Any], text: str, publish: bool) -> None:
    """Print a result; if it is to be published, keep its figures and replace its part of the page.

    The part of a benchmark stands between ``<!-- name -->`` and ``<!-- end -->``.
    """
    print(text)
    if not publish:
        return
    RESULTS.mkdir(exist_ok=True)
    (RESULTS / f"{name}.json").write_text(json.dumps(result, indent=1) + "\n", "utf-8")
    mark, end = f"<!-- {name} -->", "<!-- end -->"
    before, found, rest = PAGE.read_text("utf-8").partition(mark)
    _, closed, after = rest.partition(end)
    if not (found and closed):
        raise SystemExit(f"{PAGE}: no place for the figures, expected {mark} ... {end}")
    PAGE.write_text(f"{before}{mark}\n\n{text}\n\n{end}{after}", "utf-8")
