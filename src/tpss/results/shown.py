"""What is shown of a result at a prompt, and in a notebook."""

import html
from typing import Any

from tpss.units import on_line


def in_a_line(figures: dict[str, Any], trains: int) -> str:
    """A result in a line: its name, how it ended and when, its trains, its audit."""
    audit = "passed" if figures["audit"]["passed"] else "FAILED"
    return (
        f"<Result {figures['name']!r}: {figures['status']}, {figures['duration_min']:.2f} min, "
        f"{trains} train{'s' * (trains != 1)}, audit {audit}>"
    )


def as_table(figures: dict[str, Any], trains: int) -> str:
    """A result as a table of HTML, of what is asked for first."""
    lowest = figures["lowest_voltage"]
    rows = {
        "Status": figures["status"],
        "Why": figures.get("problem"),
        "Audit": "passed" if figures["audit"]["passed"] else "FAILED",
        "Simulated": f"{figures['duration_min']:.2f} min, {trains} train{'s' * (trains != 1)}",
        "Energy": f"{figures['total_energy_mwh']:.3f} MWh, losses {figures['losses_mwh']:.3f} MWh",
        "Lowest voltage": lowest and _of_voltage(lowest),
    }
    cells = "".join(
        f"<tr><th style='text-align:left'>{name}</th>"
        f"<td style='text-align:left'>{html.escape(str(value))}</td></tr>"
        for name, value in rows.items()
        if value
    )
    return f"<table><caption>{html.escape(figures['name'])}</caption>{cells}</table>"


def _of_voltage(lowest: dict[str, Any]) -> str:
    place = on_line(lowest.get("line", ""), f"{lowest['position_km']:.2f} km")
    return (
        f"{lowest['voltage_kv']:.3f} kV, {lowest['train']} at {place}, {lowest['time_min']:.2f} min"
    )
