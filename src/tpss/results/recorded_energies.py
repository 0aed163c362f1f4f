"""Energies of a run from its recording: what stations take from their grids, and what trains brake."""

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from tpss.results.grid_side import StationSide, powers_of
from tpss.results.regeneration import OWN_STORAGE, RECORDED_POWERS
from tpss.results.regeneration import powers_of as braking_powers
from tpss.results.standards.windows import Floats
from tpss.results.tables import J_PER_MWH
from tpss.run.run import Run


def grid_side_mwh(run: Run, sides: Sequence[StationSide], feeds_back: bool) -> dict[str, float]:
    """Energies on the grids' side of all stations, NaN where they are not described. [MWh]

    Parameters
    ----------
    run : Run
    sides : sequence of StationSide
    feeds_back : bool
        Whether trains have electric brakes: what stations give back is told then.
    """
    lost = drawn = fed_back = math.nan
    described = any(side.is_described for side in sides)
    told = described or any(side.no_load_w for side in sides)
    if told or feeds_back:
        found, duration_s = grid_side_w(run, sides), _duration_s(run)
        energies = [math.fsum(each.sum(axis=1) * duration_s) / J_PER_MWH for each in found]
        fed_back = energies[2]
        if told:
            drawn = energies[1]
        if described:
            lost = energies[0]
    return {
        "converter_losses_mwh": lost,
        "drawn_from_grid_mwh": drawn,
        "fed_back_to_grid_mwh": fed_back,
    }


def braking_mwh(
    run: Run, sides: Sequence[StationSide], rheostats: npt.NDArray[np.bool_]
) -> dict[str, float]:
    """Where the work of all brakes goes; empty without electric brakes. [MWh]

    Parameters
    ----------
    run : Run
    sides : sequence of StationSide
        What stations do with what is fed back.
    rheostats : array of bool, shape (services,)
        Whether the trains of a service burn what the line does not take.
    """
    if not run.recording.regeneration.size:
        return {}
    rows = np.asarray(run.recording.regeneration)[: run.step]
    trains = np.asarray(run.recording.trains)[: run.step]
    own = set(rows.dtype.names or ())
    recorded = {name: (rows if name in own else trains)[name] for name in RECORDED_POWERS}
    stations = np.asarray(run.recording.stations)[: run.step]
    of_trains = rheostats[[train.route for train in run.trains]]
    if run.recording.on_board.size:
        recorded[OWN_STORAGE] = np.asarray(run.recording.on_board)[OWN_STORAGE][: run.step]
    stored_w = np.asarray(run.recording.stores)[: run.step]["store_power"]
    powers = braking_powers(recorded, stations["station_active_power"], sides, of_trains, stored_w)
    duration_s = _duration_s(run)
    return {name: float((duration_s @ w).sum()) / J_PER_MWH for name, w in powers.items()}


def _duration_s(run: Run) -> Floats:
    """Length of each step, of which the last may end with an arrival. [s]"""
    duration_s = np.full(run.step, run.model.options.step_s)
    duration_s[-1:] = run.last_step_s
    return duration_s


def grid_side_w(run: Run, sides: Sequence[StationSide]) -> tuple[Floats, Floats, Floats]:
    """Losses of converters, power from the grid, power to it, of each step and station. [W]"""
    rows = np.asarray(run.recording.stations)[: run.step]
    # What transformer stations lose is recorded, and acts on the railway.
    active = rows["station_active_power"] + np.nan_to_num(rows["station_losses"])
    reactive, running = rows["station_reactive_power"], rows["active_converters"]
    found = [
        powers_of(active[:, s], reactive[:, s], running[:, s], side) for s, side in enumerate(sides)
    ]
    lost, drawn, fed_back = (
        np.stack(each, axis=1)
        for each in (
            [powers.losses for powers in found],
            [powers.from_grid for powers in found],
            [powers.to_grid for powers in found],
        )
    )
    return lost, drawn, fed_back
