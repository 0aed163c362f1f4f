"""Run a model: put its trains on the line, advance the clock in stretches, keep the recording.

The kernel works in stretches of steps, so that progress can be shown and a run be interrupted; the
recording grows when a run is longer than was foreseen.
"""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tpss.errors import TooLargeError
from tpss.record import Records, copy_of_records
from tpss.run.services import (
    ScheduledTrain,
    Service,
    departing_trains,
    placed_trains,
    train_records,
    trains_at,
)
from tpss.step.advance import advance
from tpss.step.model import Model, RunControl
from tpss.step.recording import Memory, Recording, new_recording, recording_bytes
from tpss.step.state import State, Status, new_state
from tpss.vehicle.train import Phase, Train

STRETCH_S = 0.05
"""Time between two reports of progress, about. [s]"""

LONGEST_RUN_S = 7 * 24 * 3600.0
"""A run that waits for a train to arrive gives up after this simulated time. [s]"""

MOST_MEMORY_BYTES = 8 * 2**30
"""A recording larger than this is refused. [byte]"""

INTERRUPTED = "interrupted"
STATUS_NAME = {
    Status.FINISHED: "finished",
    Status.COLLAPSED: "collapsed",
    Status.STALLED: "stalled",
}


@dataclass(frozen=True)
class Progress:
    """Where a run stands."""

    time_s: float
    trains: int
    """Trains on the line."""
    share: float
    """Share of the run that is done, as far as it can be foreseen."""
    in_check: bool = False
    """Whether it is a run with a shorter step, to check the step."""


@dataclass(frozen=True)
class Outcome:
    """A run that has ended, however it did."""

    status: str
    steps: int
    """Steps carried out; the recording has one row more."""
    trains: tuple[ScheduledTrain, ...]
    studied_train: int
    arrival_step: np.ndarray
    stood_s: np.ndarray
    """Time that each train stood at its destination before the instant of its arrival. [s]"""
    recording: Recording
    state: State


Clock = Callable[[int, int, Model, State, Recording], tuple[int, int]]
"""What runs steps, as `advance` does; a clock with another load flow may take its place."""


def demand_room(model: Model, steps: int, trains: int) -> None:
    """Refuse a run whose recording would not fit into memory.

    Raises
    ------
    TooLargeError
    """
    needed = recording_bytes(model, steps, trains)
    if needed > MOST_MEMORY_BYTES:
        raise TooLargeError(
            f"{steps} steps with {trains} trains need {needed / 2**30:.0f} GiB of memory, more than "
            f"{MOST_MEMORY_BYTES / 2**30:.0f}; take a longer time step, a shorter duration or a longer "
            "headway"
        )


class Run:
    """A run in progress: the state at `step`, and the recording up to it."""

    def __init__(
        self,
        model: Model,
        trains: list[ScheduledTrain],
        capacity: int,
        clock: Clock = advance,
        records: Records[Train] | None = None,
        memory: Memory = np.empty,
        with_journeys: bool = False,
    ) -> None:
        self.model = model
        self.clock = clock
        self.trains = trains
        self.capacity = capacity
        self.step = 0
        demand_room(model, capacity, len(trains))
        self.status = Status.RUNNING
        if records is None:
            records = train_records(trains, model.network.system.nominal_voltage_v)
        self.state = new_state(model, copy_of_records(records))
        self.with_journeys = with_journeys
        self.recording = new_recording(model, capacity, len(trains), memory, with_journeys)

    def advance_to(self, step: int) -> None:
        """Advance to a step no further than the capacity, or to the run's end before it."""
        status, self.step = self.clock(self.step, step, self.model, self.state, self.recording)
        self.status = Status(status)

    @property
    def departed(self) -> int:
        """Number of trains that have been on the line; they come first.

        A train that is due at the last instant has not departed.
        """
        begun = self.step + (self.status in (Status.COLLAPSED, Status.STALLED))
        return sum(train.departure_step < max(begun, 1) for train in self.trains)

    def ends_m(self, route: int) -> tuple[float, float]:
        """Where the trains of a route begin and end. [m]"""
        begin_m = next(train.position_m for train in self.trains if train.route == route)
        return begin_m, float(self.model.stops["position_m"][route, -1])

    def grow(self, capacity: int, departing: list[ScheduledTrain]) -> None:
        """Make room for more steps and for the trains that depart in them."""
        demand_room(self.model, capacity, len(self.trains) + len(departing))
        before, state = self.recording, self.state
        self.trains = [*self.trains, *departing]
        records = train_records(self.trains, self.model.network.system.nominal_voltage_v)
        records[: state.trains.size] = state.trains
        self.state = new_state(self.model, records)
        flow = self.state.flow
        for old, new in (
            (state.flow.nodes, flow.nodes),
            (state.flow.sections, flow.sections),
            (state.flow.sources, flow.sources),
            (state.clock, self.state.clock),
        ):
            new[:] = old
        self.recording = new_recording(
            self.model, capacity, len(self.trains), with_journeys=self.with_journeys
        )
        for name, kept in before._asdict().items():
            getattr(self.recording, name)[tuple(slice(n) for n in kept.shape)] = kept
        self.capacity = capacity


def trains_already_running(model: Model, service: Service) -> list[ScheduledTrain]:
    """Trains of a service as if it had run for ever: those that departed before the start.

    The n-th stands where a lone train at nominal voltage is n headways after its departure, with its
    speed and its progress in a dwell or a braking plan.
    """
    h = model.options.step_s
    control = RunControl(model.network.system.nominal_voltage_v, studied_train=0)
    lone = departing_trains([replace(service, first_s=0.0)], h, 0, 1)
    capacity = foreseen_steps(model, service)
    run = Run(model._replace(control=control), lone, capacity, with_journeys=True)
    run.advance_to(capacity)
    while run.status == Status.RUNNING and run.step * h < LONGEST_RUN_S:
        run.grow(2 * run.capacity, [])
        run.advance_to(run.capacity)
    last = run.step - 1 if run.status == Status.FINISHED else run.step
    most = math.ceil((last * h + service.first_s) / service.headway_s) + 1
    steps = (round((n * service.headway_s - service.first_s) / h) for n in range(1, most + 1))
    passed = [step for step in steps if 1 <= step <= last]
    return trains_at(run.recording.journeys[passed, 0], lone[0])


def trains_on_line(model: Model, services: list[Service]) -> list[ScheduledTrain]:
    """Trains that stand along the line at the start."""
    return [
        train
        for service in services
        for train in (
            trains_already_running(model, service)
            if service.already_running
            else placed_trains(service)
        )
    ]


def foreseen_steps(model: Model, service: Service) -> int:
    """Steps that a train of a service takes if little slows it down, with some to spare."""
    fastest = min(
        float(model.limits.value.max()), float(model.types[service.train_type].highest_speed_m_s)
    )
    travel_s = (service.stops_m[-1] - service.start_m) / fastest
    dwell = int(model.stops["dwell_steps"][service.route].sum())
    return (
        int(1.1 * travel_s / model.options.step_s) + dwell + math.ceil(600 / model.options.step_s)
    )


@dataclass(frozen=True)
class Start:
    """All that a run begins with; the same start may be run again and again."""

    model: Model
    """With its studied train, if the run ends with the arrival of one."""
    services: list[Service]
    steps: int | None
    """Number of steps; None: until the studied train arrives."""
    capacity: int
    """Steps that are foreseen."""
    trains: list[ScheduledTrain]
    """Those on the line, then those that depart within the capacity."""
    records: Records[Train]
    """Their state at the start."""
    studied: int
    """Place of the studied train among them, or -1."""


def begin(model: Model, services: list[Service], steps: int | None) -> Start:
    """Find out which trains stand on the line at the start, and which depart.

    Parameters
    ----------
    model : Model
    services : list of Service
        The first departure of the first one is the studied train.
    steps : int or None
        Number of steps; None: until the studied train arrives.

    Raises
    ------
    TooLargeError
        The recording would not fit into memory.
    """
    h = model.options.step_s
    on_line = trains_on_line(model, services)
    first_s = next(services[0].departure_times_s(math.inf))
    capacity = steps or foreseen_steps(model, services[0]) + math.ceil(first_s / h)
    departures = sum(service.departures_before(capacity * h) for service in services)
    demand_room(model, capacity, len(on_line) + departures)
    trains = [*on_line, *departing_trains(services, h, 0, capacity)]
    names = [train.name for train in trains]
    studied_name = f"{services[0].name} 1"
    studied = names.index(studied_name) if studied_name in names else -1
    ends_with = studied if steps is None else -1
    model = model._replace(control=RunControl(studied_train=ends_with))
    records = train_records(trains, model.network.system.nominal_voltage_v)
    return Start(model, services, steps, capacity, trains, records, studied)


def run_of(start: Start, clock: Clock = advance, memory: Memory = np.empty) -> Run:
    """A run at its start.

    Raises
    ------
    TooLargeError
        The recording would not fit into memory.
    """
    return Run(start.model, start.trains, start.capacity, clock, start.records, memory)


def advance_to_end(
    run: Run,
    start: Start,
    report: Callable[[Progress], None] | None = None,
    interrupted: Sequence[int] | None = None,
) -> str:
    """Advance until the run ends, by stretches if anybody looks; return the name of its status."""
    h, steps = run.model.options.step_s, start.steps
    last = steps if steps is not None else int(LONGEST_RUN_S / h)
    watched = report is not None or interrupted is not None
    stretch = 32 if watched else last
    while run.step < last:
        if run.step == run.capacity:
            more = min(last, run.capacity + run.capacity // 2 + 1)
            departing = departing_trains(start.services, h, run.capacity, more)
            trains = len(run.trains) + len(departing)
            if recording_bytes(run.model, more, trains) > MOST_MEMORY_BYTES:
                break
            run.grow(more, departing)
        started = time.perf_counter()
        run.advance_to(min(run.step + stretch, run.capacity, last))
        elapsed = time.perf_counter() - started
        if watched:
            stretch = int(np.clip(stretch * STRETCH_S / max(elapsed, 1e-4), 1, 4096))
        if report is not None:
            report(_progress(run, steps))
        if run.status != Status.RUNNING:
            return STATUS_NAME[run.status]
        if interrupted:
            return INTERRUPTED
    return STATUS_NAME[Status.FINISHED if steps is not None else Status.STALLED]


def on_line(state: State) -> npt.NDArray[np.bool_]:
    """Whether each train is on the line, shape (trains,)."""
    phases = (Phase.DRIVING, Phase.PLANNED, Phase.DWELLING)
    return np.isin(state.trains["motion"]["phase"], phases)


def _progress(run: Run, steps: int | None) -> Progress:
    studied = run.model.control.studied_train
    share = run.step / (steps or run.capacity)
    if steps is None:
        train = run.state.trains[studied]
        begin_m, end_m = run.ends_m(train.route)
        share = (train.motion.position_m - begin_m) / (end_m - begin_m)
    trains = int(on_line(run.state).sum())
    time_s = run.step * run.model.options.step_s
    return Progress(time_s=time_s, trains=trains, share=min(1.0, float(share)))


def outcome_of(run: Run, status: str, studied: int) -> Outcome:
    """The run as it ended, its recording cut to the steps carried out."""
    rows, count = run.step + 1, run.departed
    kept = run.recording
    recording = Recording(
        trains=kept.trains[:rows, :count],
        train_state=kept.train_state[:rows, :count],
        nodes=kept.nodes[:rows],
        stations=kept.stations[:rows],
        branch_current=kept.branch_current[:rows],
        network_losses=kept.network_losses[:rows],
        passes=kept.passes[:rows],
        counters=kept.counters,
        journeys=kept.journeys,
    )
    return Outcome(
        status=status,
        steps=run.step,
        trains=tuple(run.trains[:count]),
        studied_train=studied if studied < count else -1,
        arrival_step=run.state.trains.timetable.arrival_step[:count].copy(),
        stood_s=run.state.trains.timetable.stood_s[:count].copy(),
        recording=recording,
        state=run.state,
    )
