"""The recording as an xarray dataset with names, units and coordinates."""

import json
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from tpss.model.build import Layout
from tpss.results.contents import FORMAT, FORMAT_KEY
from tpss.simulation.run import Outcome
from tpss.simulation.state import PENDING, Model

VARIABLES: dict[str, tuple[tuple[str, ...], str, str]] = {
    # name: (dimensions, unit, long name)
    "position": (("time", "train"), "m", "position on the line"),
    "speed": (("time", "train"), "m/s", "speed"),
    "acceleration": (("time", "train"), "m/s2", "acceleration"),
    "tractive_force": (("time", "train"), "N", "tractive force at the wheel rim"),
    "braking_force": (("time", "train"), "N", "braking force"),
    "running_resistance": (("time", "train"), "N", "running resistance"),
    "gradient_force": (("time", "train"), "N", "gradient force, positive uphill"),
    "motor_current": (("time", "train"), "A", "motor current"),
    "pantograph_voltage": (("time", "train"), "V", "voltage at the pantograph"),
    "pantograph_angle": (("time", "train"), "rad", "voltage angle at the pantograph"),
    "active_power": (("time", "train"), "W", "active power drawn at the pantograph"),
    "reactive_power": (("time", "train"), "var", "reactive power drawn at the pantograph"),
    "holding_time": (("time", "train"), "s", "time at constant speed, before braking in the step"),
    "node_voltage": (("time", "node"), "V", "node voltage, at its own level"),
    "node_angle": (("time", "node"), "rad", "node voltage angle"),
    "station_active_power": (("time", "station"), "W", "active power fed into the railway"),
    "station_reactive_power": (("time", "station"), "var", "reactive power fed into the railway"),
    "active_converters": (("time", "station"), "1", "converters running"),
    "converter_loading": (("time", "station"), "1", "loading of the running converters"),
    "network_losses": (("time",), "W", "losses of contact line, transformers, high-voltage line"),
    "branch_current": (("time", "branch"), "A", "current of a branch, at its own level"),
}

TRAIN_STATES = ("waiting", "motoring", "coasting", "braking", "dwelling", "arrived")


def build_dataset(outcome: Outcome, model: Model, layout: Layout) -> xr.Dataset:
    """Dataset of a run.

    State variables (position, speed) hold at the instant; all others from that instant to the next.
    Trains that are not on the line are NaN, and so is the motor current of a train whose motors'
    voltage is not described.
    """
    arrays = _arrays(outcome, layout)
    variables: dict[str, tuple[tuple[str, ...], npt.NDArray[Any], dict[str, Any]]] = {
        name: (dims, arrays[name], {"units": unit, "long_name": label})
        for name, (dims, unit, label) in VARIABLES.items()
    }
    states = {
        "units": "1",
        "long_name": "state of the train; -1: not on the line",
        "flag_values": list(range(len(TRAIN_STATES))),
        "flag_meanings": " ".join(TRAIN_STATES),
    }
    variables["train_state"] = (("time", "train"), outcome.recording.train_state, states)
    variables["load_flow_passes"] = (
        ("time",),
        outcome.recording.passes,
        {"units": "1", "long_name": "evaluations of the network"},
    )
    return xr.Dataset(variables, coords=_coordinates(outcome, model, layout))


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


def _arrays(outcome: Outcome, layout: Layout) -> dict[str, npt.NDArray[np.float64]]:
    recording, plan = outcome.recording, layout.supply
    arrays = {
        name: records[name]
        for records in (recording.trains, recording.nodes, recording.stations)
        for name in records.dtype.names
    }
    for place in ("pantograph", "node"):
        real, imag = arrays[f"{place}_real"], arrays[f"{place}_imag"]
        arrays[f"{place}_voltage"] = np.sqrt(real * real + imag * imag)
        arrays[f"{place}_angle"] = np.arctan2(imag, real)
    arrays["node_voltage"] *= np.array(plan.node_level)
    arrays["network_losses"] = recording.network_losses
    arrays["branch_current"] = recording.branch_current / np.array(plan.branch_levels())
    return arrays


def _coordinates(outcome: Outcome, model: Model, layout: Layout) -> dict[str, object]:
    h, plan, trains = model.options.step_s, layout.supply, outcome.trains
    arrival_s = outcome.arrival_step * h - outcome.stood_s
    arrival_s = np.where(outcome.arrival_step >= 0, arrival_s, np.nan)
    # A train that was on the line at the start has no departure.
    placed = np.array([train.phase != PENDING for train in trains], dtype=bool)
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
