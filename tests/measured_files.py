"""A run that never was, of ten minutes, and files of what was measured of it."""

from typing import Any

import tpss

from made_up import made_up
from scenarios import short_line

WEST_MW = [0.0, 2.0, 4.0, 6.0, 3.0, 1.0, 5.0, 2.0, 0.0, 1.0]
EAST_MW = [1.0] * 10


def made_up_result(starts_at: str | None = None, **intervals: Any) -> tpss.Result:
    """A result of steps of a minute with the given variables; by default powers of two stations."""
    intervals = intervals or {"station_mw": {"West": WEST_MW, "East": EAST_MW}}
    scenario = short_line({"simulation.starts_at": starts_at} if starts_at else {})
    summary = {"status": "finished", "audit": {"passed": True, "failures": []}}
    return tpss.Result(scenario, made_up(**intervals), summary)


def in_minutes(columns: dict[str, list[Any]], step: float = 1.0, first: float = 0.0) -> str:
    """A file of columns with a time in minutes; None is an empty cell."""
    lines = [",".join(["time [min]", *columns])]
    for k, row in enumerate(zip(*columns.values(), strict=True)):
        cells = ["" if value is None else repr(value) for value in row]
        lines.append(",".join([f"{first + k * step:g}", *cells]))
    return "\n".join(lines) + "\n"
