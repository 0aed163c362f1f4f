"""The outcome of a case: what a supply does in a year of a traffic, in physical quantities, no money.

Powers are means over whole periods of the timetable.  Quantities of stations and of the network are
taken by the names with which they are recorded: one that is recorded some day is a column from then on.
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from tpss.audit.verdict import Audit
from tpss.planning.plan import Evaluation
from tpss.planning.steady import FINISHED, SteadyRun, Window, run_steadily
from tpss.results.grid_and_rails import grid_and_rails, has_own_rails, has_phases
from tpss.results.grid_side import sides_of
from tpss.results.key_figures import audit_and_useful_voltage, frame_of
from tpss.results.recorded_energies import grid_side_w
from tpss.run.run import Run, arrivals_s
from tpss.run.run import outcome_of as ended
from tpss.run.stiff import lost_by_train
from tpss.scenario.scenario import Scenario
from tpss.step.recorded import RECORDED
from tpss.step.recording import Memory
from tpss.step.state import TrainState
from tpss.vehicle.train import Phase

Floats = npt.NDArray[np.float64]

_MEGA = {"W": ("mw", 1e-6), "var": ("mvar", 1e-6)}
"""Endings of columns and scales, by recorded units of power."""


def outcome_of(
    scenario: Scenario, evaluation: Evaluation, memory: Memory = np.empty
) -> dict[str, Any]:
    """Outcome of one case, as columns of a row.

    Parameters
    ----------
    scenario : Scenario
        With the outage that applies, if any.
    evaluation : Evaluation
    memory : callable, optional
        Allocates the recording.

    Returns
    -------
    dict
        ``status`` is that of the run, or ``not through``.  Of a run that did not finish there is
        nothing but that and its audit: it has no steady state.

    Raises
    ------
    ScenarioError, TooLargeError
        As of `run_steadily`.
    """
    steady = run_steadily(scenario, evaluation, memory)
    window, run = steady.window, steady.run
    audit, useful_kv = _audit_and_useful_voltage(steady)
    row = {
        "status": steady.status,
        "problem": "; ".join(audit.failures) or None,
        "audit_passed": audit.passed,
        "steps": run.step,
        "period_min": steady.period_min,
    }
    if window is None or steady.status != FINISHED:
        return row
    return {
        **row,
        "window_from_min": window.begin_s / 60.0,
        "window_to_min": window.end_s / 60.0,
        "mean_useful_voltage_kv": useful_kv,
        **_electrical(steady, window),
        **_grid_and_rails(steady, window),
        **dict(_of_services(steady, window)),
    }


def _audit_and_useful_voltage(steady: SteadyRun) -> tuple[Audit, float]:
    """Audit, and lowest mean useful voltage [kV], whose peak window is the one where means are taken."""
    scenario, run, window = steady.scenario, steady.run, steady.window
    frame = frame_of(scenario, steady.layout, steady.start.model)
    if window is not None:
        frame = replace(frame, peak_from_min=window.begin_s / 60.0, peak_to_min=window.end_s / 60.0)
    return audit_and_useful_voltage(run, frame)


def _electrical(steady: SteadyRun, window: Window) -> dict[str, float]:
    """Means of powers, lowest voltage and peak loading in the window."""
    run = steady.run
    weights_s = window.weights_s(run)
    inside = weights_s > 0.0

    def mean(values: Floats) -> Floats:
        return np.asarray(weights_s[inside] @ values[: run.step][inside] / window.per_s)

    stations = np.asarray(run.recording.stations)[: run.step]
    powers = {
        each.name: (mean(stations[each.name]), *_MEGA[each.unit])
        for each in RECORDED
        if each.of == "station" and each.unit in _MEGA
    }
    found = {
        f"station.{station}.{quantity}_{unit}": float(means[s]) * scale
        for quantity, (means, unit, scale) in powers.items()
        for s, station in enumerate(steady.layout.stations)
    }
    whole = {each.name: each for each in RECORDED if not each.of and each.unit in _MEGA}
    for name, each in whole.items():
        unit, scale = _MEGA[each.unit]
        found[f"{name}_{unit}"] = float(mean(getattr(run.recording, each.array))) * scale
    sides = sides_of(steady.scenario)
    lost, drawn, fed_back = (mean(each) * 1e-6 for each in grid_side_w(run, sides))
    described = [s for s, side in enumerate(sides) if side.is_described]
    loading = stations["converter_loading"][inside]
    return {
        "drawn_from_grid_mw": float(drawn.sum()),
        "fed_back_to_grid_mw": float(fed_back.sum()),
        "converter_losses_mw": float(lost[described].sum()) if described else math.nan,
        "lowest_voltage_kv": _lowest_voltage_v(run, inside) / 1e3,
        "peak_loading": float(np.nanmax(loading, initial=0.0)),
        **found,
        **{f"station.{sides[s].name}.converter_losses_mw": float(lost[s]) for s in described},
    }


def _grid_and_rails(steady: SteadyRun, window: Window) -> dict[str, float]:
    """Unbalance of grids, voltages of rails and stray current in the window; nothing without either."""
    run, scenario = steady.run, steady.scenario
    if not (has_phases(scenario) or has_own_rails(scenario)):
        return {}
    inside = np.flatnonzero(window.weights_s(run) > 0.0)
    outcome = ended(run, steady.status, steady.start.studied)
    steps = slice(int(inside[0]), int(inside[-1]) + 1)
    return grid_and_rails(outcome, run.model, steady.layout, scenario, steps)


def _lowest_voltage_v(run: Run, inside: npt.NDArray[np.bool_]) -> float:
    """Lowest voltage at a pantograph that is fed, in some steps; infinite if there is none. [V]"""
    there = run.recording.train_state[: run.step][inside] != TrainState.ABSENT
    trains = np.asarray(run.recording.trains)[: run.step]  # of which two columns are wanted
    real, imaginary = (trains[f"pantograph_{part}"][inside][there] for part in ("real", "imag"))
    voltage_v = np.hypot(real, imaginary)
    return float(np.min(voltage_v, initial=math.inf, where=voltage_v > 0.0))


def _of_services(steady: SteadyRun, window: Window) -> Iterator[tuple[str, Any]]:
    """Trains of each service: how many run, how long they take, how late they are, what they lose."""
    run, scenario = steady.run, steady.scenario
    lost_s = _lost(steady)
    arrived_s = arrivals_s(run)
    hours = window.per_s / 3600.0
    for number, entry in enumerate(scenario.traffic):
        own = _counted(run, number, window, round(trains_per_h(scenario, number, hours) * hours))
        trips_min = [(arrived_s[i] - _departure_s(run, i)) / 60.0 for i in own]
        late_min = [
            max(0.0, trip + run.trains[i].delay_s / 60.0 - entry.arrive_after_min)
            for i, trip in zip(own, trips_min, strict=True)
            if entry.arrive_after_min is not None
        ]
        lost_min = [lost_s[name] / 60.0 for i in own if (name := run.trains[i].name) in lost_s]
        service = f"service.{entry.name}"
        yield f"{service}.train", entry.train
        yield f"{service}.trains_per_h", trains_per_h(scenario, number, hours)
        yield f"{service}.arrived", len(own)
        yield f"{service}.mean_trip_min", _mean(trips_min)
        yield f"{service}.mean_late_min", _mean(late_min)
        yield f"{service}.mean_lost_min", _mean(lost_min)


def _counted(run: Run, number: int, window: Window, count: int) -> list[int]:
    """Trains of a service whose times count: the last so many that have arrived within the window.

    The count is that of departures in the window: an arrival just at its end counts once or not at all.
    """
    arrived_s = arrivals_s(run)
    own = [
        i
        for i, train in enumerate(run.trains)
        if train.route == number and train.phase == Phase.PENDING and arrived_s[i] <= window.end_s
    ]
    return sorted(own, key=lambda i: arrived_s[i])[-max(count, 1) :]


def trains_per_h(scenario: Scenario, number: int, hours: float) -> float:
    """Trains of a service in an hour: by its headway, or those that are listed in so many. [1/h]"""
    entry = scenario.traffic[number]
    if entry.headway_min is not None:
        return 60.0 / entry.headway_min
    listed = entry.listed_departures_min or ()
    return sum(minute < 60.0 * hours - 1e-9 for minute in listed) / hours


def _lost(steady: SteadyRun) -> dict[str, float]:
    """What trains lost to the voltage, by name, where the supply is intact. [s]"""
    scenario = steady.scenario
    if scenario.outage is not None:
        return {}
    voltage_v = 1e3 * max(station.no_load_voltage_kv for station in scenario.supply.stations)
    return lost_by_train(steady.run, steady.start, voltage_v)


def _departure_s(run: Run, i: int) -> float:
    train = run.trains[i]
    return train.departure_step * run.model.options.step_s + train.departure_wait_s


def _mean(values: list[float]) -> float:
    return math.fsum(values) / len(values) if values else math.nan
