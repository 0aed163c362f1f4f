"""The summary of a run: the figures that a reader asks for first."""

import datetime as dt
import platform
from importlib.metadata import version
from typing import Any

import numpy as np
import xarray as xr

from tpss.results.audit import Audit
from tpss.results.explain import explain
from tpss.results.tables import J_PER_MWH
from tpss.scenario.scenario import Scenario
from tpss.simulation.run import Outcome
from tpss.simulation.state import Counter, Model


def summarise(
    scenario: Scenario, outcome: Outcome, model: Model, dataset: xr.Dataset, audit: Audit
) -> dict[str, Any]:
    """Summary of a run, of plain types only."""
    h = model.options.step_s
    energy = np.nansum(dataset.station_active_power.to_numpy(), axis=0) * h / J_PER_MWH
    losses = float(np.nansum(dataset.network_losses.to_numpy()) * h / J_PER_MWH)
    return {
        "name": scenario.name,
        "description": scenario.description,
        "status": outcome.status,
        **explain(outcome, model),
        "time_step_min": h / 60.0,
        "duration_min": outcome.steps * h / 60.0,
        **_studied_trip(outcome, h),
        "station_energy_mwh": dict(
            zip(dataset.station.to_numpy().tolist(), energy.tolist(), strict=True)
        ),
        "total_energy_mwh": float(energy.sum()),
        "losses_mwh": losses,
        "lowest_voltage": lowest_voltage(dataset),
        "load_flow_passes": {
            "mean": float(outcome.recording.passes[: max(outcome.steps, 1)].mean()),
            "most": int(outcome.recording.passes.max()),
        },
        "limited": {
            counter.name.lower(): int(outcome.recording.counters[counter]) for counter in Counter
        },
        "audit": audit.as_dict(),
    }


def _studied_trip(outcome: Outcome, step_s: float) -> dict[str, Any]:
    i = outcome.studied_train
    if i < 0:
        return {"studied_train": None, "trip_time_min": None}
    arrival = int(outcome.arrival_step[i])
    steps = arrival - outcome.trains[i].departure_step
    trip = (steps * step_s - float(outcome.stood_s[i])) / 60.0 if arrival >= 0 else None
    return {"studied_train": outcome.trains[i].name, "trip_time_min": trip}


def lowest_voltage(dataset: xr.Dataset) -> dict[str, Any] | None:
    """Lowest pantograph voltage of a run: how low, which train, where and when."""
    voltage = dataset.pantograph_voltage.to_numpy()
    if not np.isfinite(voltage).any():
        return None
    k, i = np.unravel_index(np.nanargmin(voltage), voltage.shape)
    return {
        "voltage_kv": float(voltage[k, i]) / 1e3,
        "train": str(dataset.train.to_numpy()[i]),
        "position_km": float(dataset.position.to_numpy()[k, i]) / 1e3,
        "time_min": float(dataset.time.to_numpy()[k]) / 60.0,
    }


def provenance() -> dict[str, str]:
    """Versions, platform and time of a run."""
    packages = ("tpss", "numpy", "numba", "xarray")
    return {
        **{f"{name}_version": version(name) for name in packages},
        "python_version": platform.python_version(),
        "platform": platform.platform(),
        "created": dt.datetime.now(dt.UTC).isoformat(timespec="seconds"),
    }
