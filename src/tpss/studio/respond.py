"""What if: figures over a number that is varied, and the smallest one that keeps a limit."""

import math
from collections.abc import Callable, Sequence
from typing import Any

from tpss.errors import Finding, ScenarioError
from tpss.many import simulate_many
from tpss.results.key_figures import KeyFigures
from tpss.scenario.override import override
from tpss.scenario.scenario import Scenario
from tpss.studio.bounds import demand_bounded
from tpss.studio.desk import Desk, Document, Edits
from tpss.studio.newest import DroppedError

MOST_RUNS = 60
"""Runs of a response curve."""

FEWEST, MOST = 1, 40
"""Numbers of converters or transformers of a station that are tried."""

FIGURES: dict[str, tuple[str, str, Callable[[KeyFigures], float]]] = {
    "lowest": (
        "lowest voltage", "kV",
        lambda each: each.lowest_voltage.voltage_kv if each.lowest_voltage else math.nan,
    ),
    "useful": ("mean useful voltage", "kV", lambda each: each.mean_useful_voltage_kv),
    "loading": (
        "highest peak loading", "%",
        lambda each: 100.0 * max(station.peak_loading for station in each.stations),
    ),
    "trip": ("trip time", "min", lambda each: each.trip_time_min),
    "energy": ("total energy", "MWh", lambda each: each.total_energy_mwh),
    "losses": ("losses", "MWh", lambda each: each.losses_mwh),
}  # fmt: skip
"""Figures by their names: words, unit, and how they are taken from a run."""


def respond(
    desk: Desk, edits: Edits, path: str, values: Sequence[Any], interrupted: list[int]
) -> dict[str, Any]:
    """Figures of the scenario with edits over values of one key path; None where a run has none.

    Raises
    ------
    ScenarioError
        There are too many values.
    DroppedError
        A newer request came meanwhile.
    """
    if len(values) > MOST_RUNS:
        problem, remedy = f"more than {MOST_RUNS} values", "ask for fewer"
        raise ScenarioError([Finding(desk.given, path, str(len(values)), problem, remedy)])
    document = desk.document(edits)
    tried = [_tried(desk, document, path, value) for value in values]
    ready = [each for each in tried if isinstance(each, Scenario)]
    runs = list(_until(simulate_many(ready), interrupted))
    found = iter(runs)
    rows = [next(found) if isinstance(each, Scenario) else None for each in tried]
    return {
        "path": path,
        "values": list(values),
        "figures": {
            name: {"words": words, "unit": unit, "values": [_number(take, row) for row in rows]}
            for name, (words, unit, take) in FIGURES.items()
        },
        "ended": [row.status if row else "not a scenario" for row in rows],
    }


def _until(runs: Any, interrupted: list[int]) -> Any:
    for run in runs:
        if interrupted:
            raise DroppedError("a newer one was asked for")
        yield run


def _tried(desk: Desk, document: Document, path: str, value: Any) -> Scenario | None:
    """The scenario with a value, if it may have it."""
    try:
        scenario = desk.scenario(override(document, {path: value}, desk.file))
        demand_bounded(scenario)
    except ScenarioError:
        return None
    return scenario


def _number(take: Callable[[KeyFigures], float], row: KeyFigures | None) -> float | None:
    value = math.nan if row is None or not row.audit.passed else take(row)
    return value if math.isfinite(value) else None


def keeps(figures: KeyFigures, lowest_kv: float | None, loading_percent: float | None) -> bool:
    """Whether a run ends as it should, with its voltage and loadings within limits."""
    lowest = figures.lowest_voltage
    voltage = lowest_kv is None or (lowest is not None and lowest.voltage_kv >= lowest_kv)
    loadings = [100.0 * station.peak_loading for station in figures.stations]
    loaded = loading_percent is None or max(loadings) <= loading_percent
    return figures.status == "finished" and figures.audit.passed and voltage and loaded


def fewest(
    desk: Desk,
    edits: Edits,
    path: str,
    lowest_kv: float | None,
    loading_percent: float | None,
    interrupted: list[int],
) -> dict[str, Any]:
    """The smallest number at a key path with which the limits are kept, found by halving.

    More units are taken to be no worse; that fewer by one do not keep the limits is seen in a run.

    Parameters
    ----------
    desk, edits, interrupted
        As of `respond`.
    path : str
        Of a number of units; with ``*`` that of every station.
    lowest_kv : float, optional
        Voltage that no train may be below. [kV]
    loading_percent : float, optional
        Loading that no station may pass. [%]

    Raises
    ------
    ScenarioError
        The scenario has faults with every number.
    DroppedError
    """
    document = desk.document(edits)
    tried: dict[int, KeyFigures] = {}

    def keep(count: int) -> bool:
        if interrupted:
            raise DroppedError("a newer one was asked for")
        if count not in tried:
            scenario = desk.scenario(override(document, {path: count}, desk.file))
            demand_bounded(scenario)
            (tried[count],) = simulate_many([scenario])
        return keeps(tried[count], lowest_kv, loading_percent)

    low, high = FEWEST - 1, FEWEST
    while high < MOST and not keep(high):
        low, high = high, min(2 * high, MOST)
    enough = keep(high)
    while enough and high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if keep(middle) else (middle, high)
    rows = [
        [count, figures.status, keeps(figures, lowest_kv, loading_percent),
         *(_number(take, figures) for _, _, take in FIGURES.values())]
        for count, figures in sorted(tried.items())
    ]  # fmt: skip
    return {"fewest": high if enough else None, "path": path, "rows": rows}
