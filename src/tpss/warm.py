"""Compile all kernels ahead of the first run, those that few lines need too.

Kernels are compiled for the types and shapes of a scenario.  So some examples are simulated,
for minutes of their time, and what comes of them is thrown away.
"""

from collections.abc import Callable, Collection
from typing import Any, NamedTuple

from tpss import examples
from tpss.api import prepare
from tpss.extras import absent
from tpss.kernel import cache_folder
from tpss.run.kernels import compile_calls, search_calls
from tpss.savings.table import spare_time_savings
from tpss.scenario.load import load_scenario
from tpss.scenario.scenario import Scenario

SHORT: dict[str, Any] = {"simulation.until": None, "simulation.duration_min": 5.0}

COUPLED = {
    "r_ohm_per_km": 0.1, "x_ohm_per_km": 0.1,
    "mutual_r_ohm_per_km": 0.05, "mutual_x_ohm_per_km": 0.05,
}  # fmt: skip
"""Tracks with an impedance in common."""

SPARED = {
    "continuous_a": 1250.0, "short_time_a": 2080.0, "short_time_min": 6.0, "preload_percent": 70.0,
    "spared": True,
}  # fmt: skip
"""Motors that drivers spare."""


def _simulate(scenario: Scenario) -> None:
    """Simulate, and compile the search for solutions too, which few runs need."""
    prepared = prepare(scenario)
    compile_calls(search_calls(prepared.start.model))
    prepared.run()


class Occasion(NamedTuple):
    """What asks for kernels of its own: an example, what is changed in it, and what is done with it."""

    example: str
    changes: dict[str, Any]
    work: Callable[[Scenario], object] = _simulate
    need: str | None = None
    """Of `tpss.extras`; without its packages nobody has the occasion."""


OCCASIONS = {
    "every run": Occasion("thesis-160km", SHORT),
    "time to spare": Occasion("emu-25kv", {}, lambda scenario: spare_time_savings(scenario, [5.0])),
    "spared motors": Occasion("thesis-160km", {**SHORT, "trains.freight.motor_rating": SPARED}),
    "coupled tracks": Occasion("network", {**SHORT, "supply.catenary": COUPLED}),
    "conductors": Occasion("hs-2x25kv", SHORT),
    "several stations at a busbar": Occasion(
        "neutral-section-25kv", {**SHORT, "supply.transformer_stations.*.busbar": "north"}
    ),
    "least squares": Occasion(
        "thesis-160km", {**SHORT, "simulation.load_flow": "least-squares"}, need="least squares"
    ),
}
"""Occasions by their names; what every run needs comes first."""


class Warming(NamedTuple):
    """How far the compilation has come."""

    occasion: str
    number: int
    """Occasions that are done."""
    occasions: int


def warm(
    report: Callable[[Warming], None] | None = None, names: Collection[str] | None = None
) -> int:
    """Compile all kernels that are not compiled yet.

    Parameters
    ----------
    report : callable, optional
        Called before each occasion.
    names : collection of str, optional
        Of the occasions; by default all.

    Returns
    -------
    int
        How many were compiled, each type of arguments counted.
    """
    possible = {
        name: OCCASIONS[name]
        for name in (OCCASIONS if names is None else names)
        if not ((need := OCCASIONS[name].need) and absent(need))
    }
    before = _on_disk()
    for number, (name, each) in enumerate(possible.items()):
        if report is not None:
            report(Warming(name, number, len(possible)))
        each.work(load_scenario(examples.path(each.example), each.changes))
    return _on_disk() - before


def _on_disk() -> int:
    """Pieces of machine code that are kept."""
    return sum(1 for _ in cache_folder().rglob("*.nbc"))
