"""A run whose step is too long, however well trains move within a step."""

from typing import Any

from scenarios import stops

WHOLE_STEPS: dict[str, Any] = {"simulation.braking": "whole-steps"}
"""Trains brake, and stop, in whole steps: their trips are as long as the steps are."""

ROUGH = {
    **WHOLE_STEPS,
    **stops(*((0.5 * n, 0.3) for n in range(1, 5))),
    "line.stations.5.position_km": 2.5,
    "line.length_km": 2.5,
    "supply.converter_stations.1.position_km": 2.5,
}
"""Five stops, 500 m from each other, with dwells of 0.3 min, for changes of the short line."""
