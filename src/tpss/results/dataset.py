"""The recording as an xarray dataset with names, units and coordinates."""

import json
from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr
from xarray.indexes import PandasIndex

from tpss.model.build import Layout
from tpss.results.contents import FORMAT, FORMAT_KEY
from tpss.results.places import WAITS_FOR, WITHOUT_POWER
from tpss.run.run import Outcome
from tpss.run.services import ScheduledTrain
from tpss.step.model import Model
from tpss.step.recorded import (
    LINKED,
    ON_BOARD,
    RECORDED,
    REGENERATED,
    RETURNED,
    STORED,
    Recorded,
)
from tpss.step.recording import ROUNDING
from tpss.step.state import Floats, TrainState
from tpss.vehicle.train import Phase

NODE_KIND = {"units": "", "long_name": "what the node is"}
"""Attributes of the variable with the kinds of nodes."""


def build_dataset(outcome: Outcome, model: Model, layout: Layout) -> xr.Dataset:
    """Dataset of a run.

    State variables (position, speed) hold at the instant; all others from that instant to the next.
    Trains that are not on the line are NaN, and so is the motor current of a train whose motors'
    voltage is not described.
    """
    arrays = _arrays(outcome, layout)
    variables = {
        each.name: xr.Variable(each.dimensions, arrays[each.name], described(each))
        for each in RECORDED
    }
    variables |= _lines_and_tracks(outcome, layout)
    if outcome.recording.waits_for.size:
        words = {"units": "1", "long_name": "index of the train that it waits for; -1: none"}
        waits_for = outcome.recording.waits_for
        variables[WAITS_FOR] = xr.Variable(("time", "train"), waits_for, words)
    if outcome.recording.regeneration.size:
        rows = np.asarray(outcome.recording.regeneration)
        variables |= {
            each.name: xr.Variable(each.dimensions, rows[each.name], described(each))
            for each in REGENERATED
        }
    if outcome.recording.links.size:
        polar = _polar(np.asarray(outcome.recording.links), "link", ...)
        variables |= {
            each.name: xr.Variable(each.dimensions, values, described(each))
            for each, values in zip(LINKED, polar, strict=True)
        }
    if outcome.recording.rails.size:
        polar = _polar(np.asarray(outcome.recording.rails), "rail", ...)
        variables |= {
            each.name: xr.Variable(each.dimensions, values, described(each))
            for each, values in zip(RETURNED, polar, strict=True)
        }
    if outcome.recording.stores.size:
        rows = np.asarray(outcome.recording.stores)
        variables |= {
            each.name: xr.Variable(each.dimensions, rows[each.name], described(each))
            for each in STORED
        }
    if outcome.recording.on_board.size:
        rows = np.asarray(outcome.recording.on_board)
        variables |= {
            each.name: xr.Variable(each.dimensions, rows[each.name], described(each))
            for each in ON_BOARD
        }
    if (off_s := outcome.recording.without_power_s).size:
        words = {"units": "s", "long_name": "time with the power off, because of neutral sections"}
        variables[WITHOUT_POWER] = xr.Variable(("time", "train"), off_s, words)
    return xr.Dataset(variables, coords=_indexed(_coordinates(outcome, model, layout)))


def _lines_and_tracks(outcome: Outcome, layout: Layout) -> dict[str, xr.Variable]:
    """On which lines and tracks trains are, where there are several; -1: they are not there."""
    along_m = np.asarray(outcome.recording.trains)["route_position"]
    leg = legs_at(along_m, outcome.trains, layout)
    told = {
        "train_line": ("line", "index of the line of the train", len(layout.lines) > 1),
        "train_track": ("track", "track of the train", layout.most_tracks > 1),
    }
    found = {}
    for name, (field, words, several) in told.items():
        if several:
            values = np.where(np.isfinite(along_m), leg[field], -1).astype(np.int16)
            described = {"units": "1", "long_name": f"{words}; -1: it is not there"}
            found[name] = xr.Variable(("time", "train"), values, described)
    return found


def _indexed(coordinates: dict[str, Any]) -> xr.Coordinates:
    """Coordinates with an index for each dimension."""
    variables = {name: xr.Variable(*each) for name, each in coordinates.items()}
    indexes = {}
    for name, variable in list(variables.items()):
        if variable.dims == (name,):
            is_text = variable.dtype.kind == "U"
            index = _index(name, tuple(variable.values)) if is_text else _new_index(name, variable)
            indexes[name] = index
            variables.update(index.create_variables({name: variable}))
    return xr.Coordinates(variables, indexes)


@lru_cache(maxsize=64)
def _index(dimension: str, names: tuple[str, ...]) -> PandasIndex:
    """Index of names, shared by runs of the same line: creating one takes as long as twenty steps."""
    return _new_index(dimension, xr.Variable(dimension, list(names)))


def _new_index(dimension: str, values: xr.Variable) -> PandasIndex:
    return PandasIndex.from_variables({dimension: values}, options={})


def described(each: Recorded) -> dict[str, Any]:
    """Attributes of a variable."""
    described: dict[str, Any] = {"units": each.unit, "long_name": each.words}
    if each.flags:
        described["flag_values"] = list(range(len(each.flags)))
        described["flag_meanings"] = " ".join(each.flags)
    return described


def _arrays(outcome: Outcome, layout: Layout) -> dict[str, npt.NDArray[Any]]:
    """Values of the variables by name; those of nodes and branches are at their own voltage levels."""
    recording, plan = outcome.recording, layout.supply
    rows = {
        "train": np.asarray(recording.trains),
        "node": np.asarray(recording.nodes),
        "station": np.asarray(recording.stations),
    }
    there = {"train": recording.train_state != TrainState.ABSENT}
    polar = {
        phasor: _polar(rows[of], phasor, there.get(of, ...))
        for phasor, of in dict.fromkeys((each.phasor, each.of) for each in RECORDED if each.phasor)
    }
    arrays: dict[str, npt.NDArray[Any]] = {}
    for each in RECORDED:
        if each.array:
            arrays[each.name] = getattr(recording, each.array)
        elif each.phasor:
            arrays[each.name] = polar[each.phasor][each.unit == "rad"]
        elif not each.derived:
            arrays[each.name] = rows[each.of][each.name]
    leg = legs_at(arrays["route_position"], outcome.trains, layout)
    arrays["position"] = _places(arrays["route_position"], leg)
    if recording.without_power_s.size:
        arrays["pantograph_voltage"][_lacking(outcome)] = 0.0
    if plan.rails_beside:
        _measure_to_rails(arrays, rows["node"], plan.rails_beside)
    arrays["node_voltage"] *= np.array(plan.node_level)
    arrays["branch_current"] = arrays["branch_current"] / np.array(plan.branch_levels())
    return arrays


def _measure_to_rails(
    arrays: dict[str, npt.NDArray[Any]], rows: Any, rails_beside: dict[int, int]
) -> None:
    """Give nodes of the contact line their voltage to the rails there, as that of trains."""
    nodes, rails = (list(each) for each in zip(*rails_beside.items(), strict=True))
    volts = rows["node_real"] + 1j * rows["node_imag"]
    between = volts[:, nodes] - volts[:, rails]
    arrays["node_voltage"][:, nodes] = np.abs(between)
    arrays["node_angle"][:, nodes] = np.angle(between)


def _lacking(outcome: Outcome) -> npt.NDArray[np.bool_]:
    """Trains and steps all through which they have their power off, shape (instants, trains)."""
    lasts_s = np.append(np.diff(outcome.instants_s), np.inf)
    return np.asarray(outcome.recording.without_power_s >= lasts_s[:, None] * (1.0 - ROUNDING))


def _places(along_m: Floats, leg: Any) -> Floats:
    """Places of the trains on their lines, those of the kilometre posts. [m]"""
    return np.asarray(leg["sign"] * along_m + leg["offset_m"])


def legs_at(along_m: Floats, trains: Sequence[ScheduledTrain], layout: Layout) -> Any:
    """Legs of trains at positions along their routes, shape (..., trains) or (trains,). [m]"""
    routes = np.array([train.route for train in trains], dtype=int)
    legs = np.asarray(layout.legs)
    if legs.shape[1] == 1:
        return legs[routes, 0]
    with np.errstate(invalid="ignore"):  # where there is no train
        passed = along_m[..., None] >= legs["from_m"][routes]
    number = np.maximum(passed.sum(axis=-1) - 1, 0)
    return legs[np.broadcast_to(routes, along_m.shape), number]


def _polar(rows: Any, place: str, there: Any) -> tuple[Floats, Floats]:
    """Magnitude and angle of recorded phasors, only where they are `there`: reading takes most time."""
    _, offset = rows.dtype.fields[f"{place}_real"]
    phasors = rows.getfield(np.complex128, offset)[there]
    magnitude, angle = np.full(rows.shape, np.nan), np.full(rows.shape, np.nan)
    magnitude[there] = np.sqrt(phasors.real * phasors.real + phasors.imag * phasors.imag)
    angle[there] = np.arctan2(phasors.imag, phasors.real)
    return magnitude, angle


def attributes(summary: dict[str, Any], step_s: float, last_step_s: float) -> dict[str, Any]:
    """Attributes of a dataset, from the summary of its run and the length of its steps. [s]"""
    trip_min, energy = summary["trip_time_min"], summary["station_energy_mwh"]
    return {
        FORMAT_KEY: FORMAT,
        "title": summary["name"],
        "status": summary["status"],
        "time_step_s": step_s,
        "last_step_s": last_step_s,
        "trip_time_min": np.nan if trip_min is None else trip_min,
        "station_energy_mwh": np.array(list(energy.values())),
        "losses_mwh": summary["losses_mwh"],
        "audit": json.dumps(summary["audit"]),
        **summary["provenance"],
    }


def _coordinates(outcome: Outcome, model: Model, layout: Layout) -> dict[str, object]:
    return {
        **_of_lines(layout),
        **_of_links_and_stores(layout),
        "time": ("time", outcome.instants_s, _words("s", "time from the start")),
        **_of_trains(outcome, model),
        **_of_calls(outcome),
        **_of_supply(layout),
    }


def _words(unit: str, long_name: str) -> dict[str, str]:
    return {"units": unit, "long_name": long_name}


def _of_lines(layout: Layout) -> dict[str, object]:
    """Coordinates of lines, if there are several."""
    if len(layout.lines) == 1:
        return {}
    index = _words("1", "index of its line")
    return {
        "line": ("line", list(layout.lines), _words("", "line")),
        "node_line": ("node", np.array(layout.supply.node_line), index),
        "station_line": ("station", np.array(layout.station_line), index),
    }


def _of_links_and_stores(layout: Layout) -> dict[str, object]:
    """Coordinates of what few supplies have."""
    found: dict[str, object] = {}
    plan = layout.supply
    if plan.links:
        words = _words("", "transformer between several nodes")
        found["link"] = ("link", plan.link_names, words)
        found["link_kind"] = ("link", plan.link_kinds, _words("", "what it is"))
    if layout.stores:
        words = _words("", "store of energy at the line")
        found["store"] = ("store", list(layout.stores), words)
        found["store_position"] = ("store", np.array(layout.store_m), _words("m", "position"))
        if len(layout.lines) > 1:
            words = _words("1", "index of its line")
            found["store_line"] = ("store", np.array(layout.store_line), words)
    return found


def _of_trains(outcome: Outcome, model: Model) -> dict[str, object]:
    """Coordinates of trains; one that was on the line at the start has no departure."""
    h, trains = model.options.step_s, outcome.trains
    placed = np.array([train.phase != Phase.PENDING for train in trains], dtype=bool)
    departure_s = np.array(
        [train.departure_step * h + train.departure_wait_s for train in trains], dtype=float
    )
    delay_s = np.where(placed, np.nan, [train.delay_s for train in trains])
    late = "departure later than scheduled, where scheduled times do not follow it"
    departure = ("train", np.where(placed, np.nan, departure_s), _words("s", "departure"))
    return {
        "train": ("train", [train.name for train in trains], _words("", "train")),
        "service": (
            "train",
            [train.service for train in trains],
            _words("", "service of the train"),
        ),
        "departure_time": departure,
        "departure_delay": ("train", delay_s, _words("s", late)),
        "arrival_time": ("train", outcome.arrival_s, _words("s", "arrival")),
    }


def _of_calls(outcome: Outcome) -> dict[str, object]:
    """Coordinates of stops on the routes of the trains."""
    calls = np.asarray(outcome.recording.calls)
    arrival = _words("s", "arrival at the stop, if the train moves continuously")
    departure = _words("s", "departure from the stop, if the train moves continuously")
    return {
        "call": ("call", np.arange(calls.shape[1]), _words("", "stop on the route of the train")),
        "call_arrival_time": (("train", "call"), calls["arrival_s"], arrival),
        "call_departure_time": (("train", "call"), calls["departure_s"], departure),
    }


def _of_supply(layout: Layout) -> dict[str, object]:
    """Coordinates of nodes, feeding stations and branches."""
    plan, of_branches = layout.supply, "resistance of a lumped branch, at its own level"
    resistance_ohm, node_m = np.array(plan.branch_resistance_ohm()), np.array(plan.node_km) * 1e3
    return {
        "node": ("node", plan.nodes, _words("", "node")),
        "node_kind": ("node", plan.node_kinds, NODE_KIND),
        "node_position": ("node", node_m, _words("m", "position of the node")),
        "station": ("station", list(layout.stations), _words("", "feeding station")),
        "station_position": ("station", np.array(layout.station_m), _words("m", "position")),
        "branch": ("branch", plan.branch_labels(), _words("", "branch")),
        "branch_kind": ("branch", plan.branch_kind_of_each(), _words("", "what the branch is")),
        "branch_resistance": ("branch", resistance_ohm, _words("ohm", of_branches)),
    }
