"""The recording as an xarray dataset with names, units and coordinates."""

import json
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from tpss.model.build import Layout
from tpss.results.contents import FORMAT, FORMAT_KEY
from tpss.run.run import Outcome
from tpss.step.model import Model
from tpss.step.recorded import RECORDED, Recorded
from tpss.vehicle.train import Phase


def build_dataset(outcome: Outcome, model: Model, layout: Layout) -> xr.Dataset:
    """Dataset of a run.

    State variables (position, speed) hold at the instant; all others from that instant to the next.
    Trains that are not on the line are NaN, and so is the motor current of a train whose motors'
    voltage is not described.
    """
    variables = {
        each.name: (each.dimensions, _values(each, outcome, layout), _described(each))
        for each in RECORDED
    }
    return xr.Dataset(variables, coords=_coordinates(outcome, model, layout))


def _described(each: Recorded) -> dict[str, Any]:
    """Attributes of a variable."""
    described: dict[str, Any] = {"units": each.unit, "long_name": each.words}
    if each.flags:
        described["flag_values"] = list(range(len(each.flags)))
        described["flag_meanings"] = " ".join(each.flags)
    return described


def _values(each: Recorded, outcome: Outcome, layout: Layout) -> npt.NDArray[Any]:
    """Values of a variable; voltages of nodes and currents of branches are those at their own level."""
    recording, plan = outcome.recording, layout.supply
    if each.array:
        values = np.asarray(getattr(recording, each.array))
        own_level = np.array(plan.branch_levels()) if each.of == "branch" else None
        return values if own_level is None else values / own_level
    rows = {"train": recording.trains, "node": recording.nodes, "station": recording.stations}
    parts = [rows[each.of][field] for field in each.fields]
    if not each.phasor:
        return np.asarray(parts[0])
    real, imag = parts
    if each.unit == "rad":
        return np.asarray(np.arctan2(imag, real))
    magnitude = np.sqrt(real * real + imag * imag)
    return np.asarray(magnitude * np.array(plan.node_level) if each.of == "node" else magnitude)


def attributes(summary: dict[str, Any], step_s: float) -> dict[str, Any]:
    """What a dataset says of itself, from the summary of its run."""
    trip_min, energy = summary["trip_time_min"], summary["station_energy_mwh"]
    return {
        FORMAT_KEY: FORMAT,
        "title": summary["name"],
        "status": summary["status"],
        "time_step_s": step_s,
        "trip_time_min": np.nan if trip_min is None else trip_min,
        "station_energy_mwh": np.array(list(energy.values())),
        "losses_mwh": summary["losses_mwh"],
        "audit": json.dumps(summary["audit"]),
        **summary["provenance"],
    }


def _coordinates(outcome: Outcome, model: Model, layout: Layout) -> dict[str, object]:
    h, plan, trains = model.options.step_s, layout.supply, outcome.trains
    arrival_s = outcome.arrival_step * h - outcome.stood_s
    arrival_s = np.where(outcome.arrival_step >= 0, arrival_s, np.nan)
    # A train that was on the line at the start has no departure.
    placed = np.array([train.phase != Phase.PENDING for train in trains], dtype=bool)
    departure_s = np.array([train.departure_step * h for train in trains], dtype=float)

    def of(unit: str, long_name: str) -> dict[str, str]:
        return {"units": unit, "long_name": long_name}

    node_m = np.array(plan.node_km) * 1e3
    return {
        "time": ("time", np.arange(outcome.steps + 1) * h, of("s", "time from the start")),
        "train": ("train", [train.name for train in trains], of("", "train")),
        "service": ("train", [train.service for train in trains], of("", "service of the train")),
        "departure_time": ("train", np.where(placed, np.nan, departure_s), of("s", "departure")),
        "arrival_time": ("train", arrival_s, of("s", "arrival")),
        "node": ("node", plan.nodes, of("", "node")),
        "node_position": ("node", node_m, of("m", "position of the node")),
        "station": ("station", list(layout.stations), of("", "converter station")),
        "station_position": ("station", np.array(layout.station_m), of("m", "position")),
        "branch": ("branch", plan.branch_labels(), of("", "branch")),
        "branch_kind": ("branch", plan.branch_kind_of_each(), of("", "what the branch is")),
        "branch_resistance": (
            "branch",
            np.array(plan.branch_resistance_ohm()),
            of("ohm", "resistance of a lumped branch, at its own level"),
        ),
    }
