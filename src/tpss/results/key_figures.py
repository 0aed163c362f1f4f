"""The key figures of a run, a few hundred bytes, from its recording without dataset or tables."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from tpss.audit.aggregate import Figures, RunFigures, gather, new_figures
from tpss.audit.balances import Balances
from tpss.audit.verdict import JUDGED, Audit, judge, limits_of
from tpss.kernel import plain
from tpss.model.build import Layout
from tpss.powerflow.system import System
from tpss.results.grid_and_rails import grid_and_rails, has_own_rails, has_phases
from tpss.results.grid_side import StationSide, sides_of
from tpss.results.recorded_energies import braking_mwh, grid_side_mwh
from tpss.results.regeneration import have_rheostats
from tpss.results.standards.useful_voltage import LEAST_PRESENCE_S, window_steps
from tpss.results.standards.windows import TOLERANCE
from tpss.results.tables import J_PER_MWH
from tpss.results.thermal.elements import has_ratings
from tpss.results.thermal.figures import thermal_figures
from tpss.run.protection import run_to_end
from tpss.run.run import Clock, Progress, Run, arrivals_s, outcome_of
from tpss.run.start import Start
from tpss.scenario.scenario import Scenario
from tpss.step.model import Model
from tpss.step.recording import Memory
from tpss.step.state import Counter
from tpss.track.leg import leg_of, place_on_line
from tpss.vehicle.train import Phase

Floats = npt.NDArray[np.float64]

LIMITED = tuple(counter.name.lower() for counter in Counter)
"""Names of what is counted, in the order of the recording."""


@dataclass(frozen=True)
class ServiceFigures:
    """Key figures of a service, of its trains that departed and arrived within the run."""

    name: str
    arrived: int
    mean_trip_min: float
    longest_trip_min: float
    """Both NaN if no train has arrived."""


@dataclass(frozen=True)
class StationFigures:
    """Key figures of a feeding station; peaks and means are NaN for a run without a step."""

    name: str
    energy_mwh: float
    reactive_energy_mvarh: float
    peak_power_mw: float
    mean_loading: float
    peak_loading: float


@dataclass(frozen=True)
class LowestVoltage:
    """Lowest voltage at a pantograph: how low, which train, where and when."""

    voltage_kv: float
    train: str
    position_km: float
    time_min: float
    line: str | None
    """Where there are several."""

    def as_dict(self) -> dict[str, Any]:
        """For a summary."""
        return {name: value for name, value in vars(self).items() if value is not None}


@dataclass(frozen=True)
class KeyFigures:
    """Key figures of a run.  Missing ones are NaN or None.

    Attributes
    ----------
    name : str
        Name of the scenario.
    status : str
        ``finished``, ``collapsed``, ``stalled``, ``deadlocked`` or ``interrupted``.
    steps : int
        Steps carried out.
    duration_min : float
        Simulated time; of a run that ended early, when it did.
    carried_share : float
        Share of its load that the line could carry when it collapsed, otherwise 1.
    studied_train : str or None
        First train of the first service, once it has departed.
    trip_time_min, mean_speed_kmh : float
        Of the studied train, from its departure to its arrival.
    services, stations : tuple
        In the order of the scenario.
    losses_mwh : float
        Of the network.
    converter_losses_mwh : float
        Of converter stations, auxiliaries included; NaN unless some describe them.
    drawn_from_grid_mwh : float
        Energy that all stations take from their grids: what they feed and lose; NaN likewise.
    fed_back_to_grid_mwh : float
        Energy that they give back; NaN unless losses are described or trains have electric brakes.
    braking : dict of str to float
        Where the work of all brakes goes, as of `tpss.results.regeneration.fed_back`; empty without any
        electric ones. [MWh]
    thermal : dict of str to float
        What equipment with a rating comes to, as of `tpss.results.thermal.figures`; empty where nothing
        has one, or where a `Result` has it.
    grid_and_rails : dict of str to float
        Unbalance of grids, voltages of rails, and what strays from them, as of
        `tpss.results.grid_and_rails`; empty where a scenario has neither, or where a `Result` has them.
    tripped : tuple of str or None
        What tripped, in the order of time; None where nothing can.
    lowest_voltage : LowestVoltage or None
    mean_useful_voltage_kv : float
        Lowest one of the zones, by EN 50388, in the peak window.
    dimensioning_train_kv : float
        Mean useful voltage of the dimensioning train.
    mean_passes, most_passes : float, int
        Evaluations of the network in a step.
    limited : dict of str to int
        What was limited or left its range, counted in train-steps.
    audit : Audit
    way : str
        How the run was made: ``alone``, or in ``lanes`` with others, see `tpss.lanes`.
    """

    name: str
    status: str
    steps: int
    duration_min: float
    carried_share: float
    studied_train: str | None
    trip_time_min: float
    mean_speed_kmh: float
    services: tuple[ServiceFigures, ...]
    stations: tuple[StationFigures, ...]
    losses_mwh: float
    converter_losses_mwh: float
    drawn_from_grid_mwh: float
    fed_back_to_grid_mwh: float
    braking: dict[str, float]
    thermal: dict[str, float]
    grid_and_rails: dict[str, float]
    tripped: tuple[str, ...] | None
    lowest_voltage: LowestVoltage | None
    mean_useful_voltage_kv: float
    dimensioning_train_kv: float
    mean_passes: float
    most_passes: int
    limited: dict[str, int]
    audit: Audit
    way: str = "alone"

    @cached_property
    def total_energy_mwh(self) -> float:
        """Energy of all feeding stations."""
        return math.fsum(station.energy_mwh for station in self.stations)


@dataclass(frozen=True)
class Frame:
    """Parameters of a scenario by which the key figures of its runs are computed."""

    name: str
    peak_from_min: float
    peak_to_min: float | None
    zones: list[tuple[int, float, float]]
    """Lines and ends [km] of the zones of useful voltage; that of a line's last one is infinite."""
    lines: tuple[str, ...]
    stations: tuple[str, ...]
    at_line_level: npt.NDArray[np.bool_]
    """Whether a node is at the contact line's level."""
    limits: dict[str, float]
    """Of the audit."""
    system: System
    sides: tuple[StationSide, ...]
    """The stations' 50 Hz sides."""
    feeds_back: bool
    """Whether trains have electric brakes."""
    rheostats: npt.NDArray[np.bool_]
    """Whether the trains of a service burn what the line does not take."""
    rated: Scenario | None
    """The scenario, if something in it has a rating."""
    apart: tuple[Scenario, Layout] | None
    """The scenario and its layout, if stations tell their phases, or rails are conductors."""


def frame_of(scenario: Scenario, layout: Layout, model: Model) -> Frame:
    """Parameters of a scenario by which the key figures of its runs are computed."""
    return Frame(
        name=scenario.name,
        peak_from_min=scenario.standards.peak_from_min,
        peak_to_min=scenario.standards.peak_to_min,
        zones=_zones(scenario, layout),
        lines=layout.lines,
        stations=layout.stations,
        at_line_level=layout.supply.at_line_level,
        limits=limits_of(model),
        system=model.network.system,
        sides=sides_of(scenario),
        feeds_back=any(train.regeneration is not None for train in scenario.trains.values()),
        rheostats=have_rheostats([service.name for service in scenario.traffic], scenario),
        rated=scenario if has_ratings(scenario) else None,
        apart=(scenario, layout) if has_phases(scenario) or has_own_rails(scenario) else None,
    )


def run_for_figures(
    start: Start,
    frame: Frame,
    clock: Clock,
    memory: Memory = np.empty,
    interrupted: Sequence[int] | None = None,
    report: Callable[[Progress], None] | None = None,
) -> KeyFigures:
    """Run from a start, and keep only the key figures.

    Parameters
    ----------
    start : Start
    frame : Frame
    clock : callable
        Runs the steps.
    memory : callable, optional
        Allocates the recording.
    interrupted : sequence of int, optional
        The run ends early once it is filled.
    report : callable, optional
        Called several times a second with the `Progress` of the run.

    Raises
    ------
    TooLargeError
        The recording would not fit into memory.
    """
    run, status = run_to_end(start, clock, memory, report, interrupted)
    figures = key_figures_of(run, status, start, frame)
    if frame.rated is not None and run.step:
        figures = replace(figures, thermal=thermal_figures(run, frame.rated))
    if frame.apart is not None and run.step:
        scenario, layout = frame.apart
        outcome = outcome_of(run, status, start.studied)
        found = grid_and_rails(outcome, run.model, layout, scenario)
        figures = replace(figures, grid_and_rails=found)
    return figures


def key_figures_of(
    run: Run, status: str, start: Start, frame: Frame, gathered: Figures | None = None
) -> KeyFigures:
    """Key figures of a run that has ended with a status, but for those that take their time.

    These are `thermal` and `grid_and_rails`.

    Parameters
    ----------
    run : Run
    status : str
        How it ended.
    start : Start
    frame : Frame
    gathered : Figures, optional
        Figures of its steps, where they were gathered as it ran; by default they are from its recording.
    """
    figures = _gather(run, frame) if gathered is None else gathered
    whole = _of_whole_run(figures)
    studied = start.studied if start.studied < run.departed else -1
    trip_min, speed_kmh = _studied_trip(run, studied, figures)
    sides = grid_side_mwh(run, frame.sides, frame.feeds_back)
    return KeyFigures(
        name=frame.name,
        status=status,
        steps=run.step,
        duration_min=float(run.instants_s[-1]) / 60.0,
        carried_share=float(run.state.clock[0].carried_share),
        studied_train=run.trains[studied].name if studied >= 0 else None,
        trip_time_min=trip_min,
        mean_speed_kmh=speed_kmh,
        services=_services(run, start),
        stations=_stations(run, frame, figures),
        losses_mwh=whole["losses_j"] / J_PER_MWH,
        converter_losses_mwh=sides["converter_losses_mwh"],
        drawn_from_grid_mwh=sides["drawn_from_grid_mwh"],
        fed_back_to_grid_mwh=sides["fed_back_to_grid_mwh"],
        braking=braking_mwh(run, frame.sides, frame.rheostats),
        thermal={},
        grid_and_rails={},
        tripped=tuple(trip.protected.name for trip in run.trips) if start.relays else None,
        lowest_voltage=_lowest_voltage(run, whole, frame),
        mean_useful_voltage_kv=_lowest_zone_kv(figures),
        dimensioning_train_kv=_dimensioning_train_kv(figures, run.model.options.step_s),
        mean_passes=whole["passes"] / max(run.step, 1),
        most_passes=whole["most_passes"],
        limited=dict(zip(LIMITED, run.recording.counters.tolist(), strict=True)),
        audit=_audit(run, figures, whole, frame),
    )


def audit_and_useful_voltage(run: Run, frame: Frame) -> tuple[Audit, float]:
    """Audit of a run that has ended, and the lowest mean useful voltage of the zones [kV].

    They are those of `key_figures_of`, for many runs of which no more is asked.
    """
    figures = _gather(run, frame)
    return _audit(run, figures, _of_whole_run(figures), frame), _lowest_zone_kv(figures)


def _of_whole_run(figures: Figures) -> dict[str, Any]:
    return dict(zip(RunFigures.dtype.names or (), figures.run.tolist()[0], strict=True))


def _gather(run: Run, frame: Frame) -> Figures:
    h, model = run.model.options.step_s, run.model
    window = window_steps(run.step, h, frame.peak_from_min, frame.peak_to_min)
    begin, end = (0, 0) if window is None else (window.start, window.stop)
    figures = new_figures(model, run.departed, frame.zones)
    trains = run.state.trains
    for first, last, network in run.stretches:
        gather(
            first, last, run.step, run.last_step_s, begin, end, frame.at_line_level,
            trains, model._replace(network=network), run.recording, figures,
        )  # fmt: skip
    return figures


def _zones(scenario: Scenario, layout: Layout) -> list[tuple[int, float, float]]:
    """Lines and ends of the zones of useful voltage; a line's end belongs to the last zone before it."""
    lines = scenario.lines_by_name
    zones = [
        (layout.lines.index(scenario.line_of(zone)), zone.from_km, zone.to_km)
        for zone in scenario.standards.zones
    ]
    if not zones:
        for index, line in enumerate(lines.values()):
            stations = zip(layout.station_line, layout.station_m, strict=True)
            own_km = (m / 1e3 for owner, m in stations if owner == index)
            points = sorted({line.begins_at_km, line.end_km, *own_km})
            zones += [(index, *ends) for ends in zip(points, points[1:], strict=False)]
    end_km = [line.end_km for line in lines.values()]
    return [(line, begin, math.inf if end >= end_km[line] else end) for line, begin, end in zones]


def _services(run: Run, start: Start) -> tuple[ServiceFigures, ...]:
    h = start.model.options.step_s
    trips_min = [list[float]() for _ in start.services]
    for train, arrival_s in zip(run.trains, arrivals_s(run).tolist(), strict=True):
        if arrival_s >= 0 and train.phase == Phase.PENDING:
            departure_s = train.departure_step * h + train.departure_wait_s
            trips_min[train.route].append(arrival_s / 60.0 - departure_s / 60.0)
    return tuple(
        ServiceFigures(
            name=service.name,
            arrived=len(trips),
            mean_trip_min=math.fsum(trips) / len(trips) if trips else math.nan,
            longest_trip_min=max(trips, default=math.nan),
        )
        for service, trips in zip(start.services, trips_min, strict=True)
    )


def _studied_trip(run: Run, studied: int, figures: Figures) -> tuple[float, float]:
    """Trip time [min] and mean speed [km/h] of the studied train, NaN if it has not arrived."""
    if studied < 0:
        return math.nan, math.nan
    timetable, h = run.state.trains[studied].timetable, run.model.options.step_s
    arrival = int(timetable.arrival_step)
    if arrival < 0:
        return math.nan, math.nan
    trip_s = (arrival - run.trains[studied].departure_step) * h
    trip_s -= float(timetable.stood_s) + run.trains[studied].departure_wait_s
    if arrival == run.step:
        trip_s -= h - run.last_step_s
    distance_m = figures.trains[studied].last_m - figures.trains[studied].first_m
    return trip_s / 60.0, float(distance_m) / trip_s * 3.6


def _stations(run: Run, frame: Frame, figures: Figures) -> tuple[StationFigures, ...]:
    steps = max(run.step, 1)
    return tuple(
        StationFigures(
            name=name,
            energy_mwh=energy / J_PER_MWH,
            reactive_energy_mvarh=reactive / J_PER_MWH,
            peak_power_mw=_number(peak) / 1e6,
            mean_loading=loading / steps,
            peak_loading=_number(highest),
        )
        for name, (energy, reactive, peak, loading, highest) in zip(
            frame.stations, figures.stations.tolist(), strict=True
        )
    )


def _number(value: float) -> float:
    """A number; NaN for an infinite one, which is the extreme of an empty set."""
    return value if math.isfinite(value) else math.nan


def _lowest_voltage(run: Run, whole: dict[str, Any], frame: Frame) -> LowestVoltage | None:
    if not math.isfinite(whole["lowest_voltage_v"]):
        return None
    train = run.trains[whole["lowest_voltage_train"]]
    leg = leg_of(whole["lowest_voltage_m"], train.route, run.model.legs)
    return LowestVoltage(
        voltage_kv=whole["lowest_voltage_v"] / 1e3,
        train=train.name,
        position_km=plain(place_on_line)(whole["lowest_voltage_m"], leg) / 1e3,
        line=frame.lines[leg.line] if len(frame.lines) > 1 else None,
        time_min=whole["lowest_voltage_step"] * run.model.options.step_s / 60.0,
    )


def _lowest_zone_kv(figures: Figures) -> float:
    means = [total / steps for *_, steps, total in figures.zones.tolist() if steps]
    return min(means, default=math.nan) / 1e3


def _dimensioning_train_kv(figures: Figures, step_s: float) -> float:
    """The lowest mean useful voltage of the trains that are present long enough."""
    h, trains = step_s / 60.0, figures.trains
    means = [
        total / pulling
        for present, pulling, total in zip(
            trains["useful_steps"].tolist(),
            trains["pulling_steps"].tolist(),
            trains["pulling_voltage_v"].tolist(),
            strict=True,
        )
        if present * h >= LEAST_PRESENCE_S / 60.0 - TOLERANCE and pulling
    ]
    return min(means, default=math.nan) / 1e3


def _audit(run: Run, figures: Figures, whole: dict[str, Any], frame: Frame) -> Audit:
    measured = dict(
        zip(Balances.dtype.names or (), figures.audit.balances.tolist()[0], strict=True)
    )
    measured["stop_error_m"] = float(run.state.clock[0].stop_error_m)
    audited = {name: measured[name] for name in JUDGED}
    lowest = min(whole["lowest_voltage_v"], whole["lowest_node_v"])
    if not math.isfinite(lowest):
        return judge(audited, None, None, frame.limits, frame.system)
    return judge(audited, lowest, whole["highest_voltage_v"], frame.limits, frame.system)
