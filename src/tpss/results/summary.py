"""The summary of a run: its most important figures."""

import datetime as dt
import math
import platform
from functools import cache
from importlib.metadata import version
from typing import Any

from tpss.results.current_limits import at_current_limit
from tpss.results.explain import explain
from tpss.results.key_figures import KeyFigures
from tpss.run.run import Outcome
from tpss.scenario.own_laws import laws_of
from tpss.scenario.scenario import Scenario
from tpss.step.model import Model


def summarise(
    scenario: Scenario, figures: KeyFigures, outcome: Outcome, model: Model
) -> dict[str, Any]:
    """Summary of a run, of plain types only."""
    lowest = figures.lowest_voltage
    stations = [station.name for station in figures.stations]
    limits = at_current_limit(outcome, model, stations)
    return {
        "name": scenario.name,
        "description": scenario.description,
        "status": figures.status,
        **explain(outcome, model, scenario),
        "time_step_min": model.options.step_s / 60.0,
        "duration_min": figures.duration_min,
        "studied_train": figures.studied_train,
        "trip_time_min": None if math.isnan(figures.trip_time_min) else figures.trip_time_min,
        "station_energy_mwh": {station.name: station.energy_mwh for station in figures.stations},
        "total_energy_mwh": figures.total_energy_mwh,
        "losses_mwh": figures.losses_mwh,
        "lowest_voltage": None if lowest is None else lowest.as_dict(),
        "load_flow_passes": {"mean": figures.mean_passes, "most": figures.most_passes},
        "limited": figures.limited,
        **({"current_limits": limits} if limits else {}),
        **({"trips": _trips(outcome)} if outcome.trips else {}),
        "audit": figures.audit.as_dict(),
    }


def _trips(outcome: Outcome) -> list[dict[str, Any]]:
    """What tripped, in the order of time."""
    return [
        {
            "element": trip.protected.name,
            "time_min": trip.time_s / 60.0,
            "load_percent": 100.0 * trip.load,
            "window_min": trip.relay.window_s / 60.0,
            "allowed_percent": round(100.0 * trip.relay.highest, 9),
        }
        for trip in outcome.trips
    ]


def provenance(scenario: Scenario) -> dict[str, str]:
    """Versions, platform and time of a run; and the laws of other packages that it used."""
    laws = {"laws": "; ".join(own)} if (own := laws_of(scenario)) else {}
    return {**_versions(), **laws, "created": dt.datetime.now(dt.UTC).isoformat(timespec="seconds")}


@cache
def _versions() -> dict[str, str]:
    """Versions and platform, which take as long to determine as a short run."""
    packages = ("tpss", "numpy", "numba", "xarray")
    return {
        **{f"{name}_version": version(name) for name in packages},
        "python_version": platform.python_version(),
        "platform": platform.platform(),
    }
