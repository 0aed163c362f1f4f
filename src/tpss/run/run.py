"""Run a model: put its trains on the line, advance the clock in stretches, keep the recording.

The kernel works in stretches of steps, so that progress can be shown and a run be interrupted; the
recording grows when a run is longer than was foreseen.
"""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tpss.kernel import plain
from tpss.powerflow.network import Network
from tpss.record import Records, copy_of_records
from tpss.run.limits import LONGEST_RUN_S, demand_room, has_room
from tpss.run.relays import Trip
from tpss.run.services import ScheduledTrain, departing_trains, train_records
from tpss.run.start import Start
from tpss.run.switching import Switching, take_over
from tpss.step.advance import advance
from tpss.step.model import Model
from tpss.step.recording import Memory, Recording, lacks_power, new_recording
from tpss.step.state import State, Status, new_state
from tpss.step.turns import Turn
from tpss.vehicle.train import Phase, Train

STRETCH_S = 0.05
"""Time between two reports of progress, about. [s]"""

INTERRUPTED = "interrupted"
STATUS_NAME = {
    Status.FINISHED: "finished",
    Status.COLLAPSED: "collapsed",
    Status.STALLED: "stalled",
    Status.DEADLOCKED: "deadlocked",
}
NOT_CARRIED_OUT = (Status.COLLAPSED, Status.STALLED, Status.DEADLOCKED)
"""How runs end whose last step has begun, but is not carried out."""


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
    arrival_s: npt.NDArray[np.float64]
    """When each train came to stand at its destination, or NaN. [s]"""
    instants_s: npt.NDArray[np.float64]
    """Times of the instants, one more than steps. [s]"""
    recording: Recording
    state: State
    trips: tuple[Trip, ...] = ()
    """What tripped, in the order of time."""


Clock = Callable[[int, int, Model, State, Recording], tuple[int, int]]
"""What runs steps, as `advance` does; a clock with another load flow may take its place."""


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
        turns: Records[Turn] | None = None,
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
        records = copy_of_records(records)
        _fill_stores(records, model)
        self.state = new_state(model, records, turns)
        self.recording = new_recording(model, capacity, len(trains), memory)
        self.networks = [(0, model.network)]
        """Steps from which networks hold, and these."""
        self.trips: tuple[Trip, ...] = ()
        """What tripped, in the order of time."""

    def advance_to(self, step: int) -> None:
        """Advance to a step no further than the capacity, or to the run's end before it."""
        status, self.step = self.clock(self.step, step, self.model, self.state, self.recording)
        self.status = Status(status)

    def switch_to(self, network: Network) -> None:
        """Go on from this step with another network of the same shapes."""
        take_over(self.model.network, network, self.step, self.state)
        self.model = self.model._replace(network=network)
        self.networks.append((self.step, network))

    @property
    def stretches(self) -> list[tuple[int, int, Network]]:
        """Steps from the first to the one before the second that had a network, and that."""
        ends = [*(step for step, _ in self.networks[1:]), self.step]
        found = [
            (first, last, network)
            for (first, network), last in zip(self.networks, ends, strict=True)
            if first < last
        ]
        return found or [(0, 0, self.model.network)]

    @property
    def departed(self) -> int:
        """Number of trains that have been on the line; they come first.

        A train that is due at the last instant has not departed, nor one that would have within the
        last step, had that not ended before.
        """
        begun = self.step + (self.status in NOT_CARRIED_OUT)
        departed = sum(train.departure_step < max(begun, 1) for train in self.trains)
        if begun == 0:
            return departed
        phases = np.asarray(self.state.trains)["motion"]["phase"][:departed]
        pending = phases == Phase.PENDING
        return departed - int(pending.sum())

    @property
    def last_step_s(self) -> float:
        """Length of the step that was carried out last: a shorter one if it ends the run. [s]"""
        shorter = self.status == Status.FINISHED
        return float(self.state.clock[0].last_step_s) if shorter else self.model.options.step_s

    @property
    def instants_s(self) -> npt.NDArray[np.float64]:
        """Times of the instants up to now. [s]"""
        h = self.model.options.step_s
        instants = np.arange(self.step + 1, dtype=np.float64) * h
        if self.last_step_s != h:
            instants[-1] = (self.step - 1) * h + self.last_step_s
        return instants

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
        _fill_stores(records, self.model)
        records[: state.trains.size] = state.trains
        self.state = new_state(self.model, records)
        flow, turns = self.state.flow, self.state.turns
        for old, new in (
            (state.flow.nodes, flow.nodes),
            (state.flow.sections, flow.sections),
            (state.flow.sources, flow.sources),
            (state.flow.stores, flow.stores),
            (state.clock, self.state.clock),
            (state.turns.holdings, turns.holdings[: state.trains.size]),
            (state.turns.uses, turns.uses),
            (state.turns.places, turns.places),
        ):
            new[:] = old
        self.recording = new_recording(self.model, capacity, len(self.trains))
        for name, kept in before._asdict().items():
            getattr(self.recording, name)[tuple(slice(n) for n in kept.shape)] = kept
        self.capacity = capacity


def _fill_stores(records: Records[Train], model: Model) -> None:
    """Give the stores of trains the energy with which they enter the line."""
    if model.control.has_stores:
        start_j = model.types["on_board"]["start_j"]
        records["stored"]["energy_j"] = start_j[records["train_type"]]


def run_of(start: Start, clock: Clock = advance, memory: Memory = np.empty) -> Run:
    """A run at its start.

    Raises
    ------
    TooLargeError
        The recording would not fit into memory.
    """
    return Run(
        start.model, start.trains, start.capacity, clock, start.records, memory, turns=start.turns
    )


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
    until = 0
    while run.step < last:
        if run.step == run.capacity:
            if steps is None and until == last and _is_stranded(run):
                break
            more = min(last, run.capacity + run.capacity // 2 + 1)
            departing = departing_trains(start.services, run.model.options, run.capacity, more)
            trains = len(run.trains) + len(departing)
            if not has_room(run.model, more, trains):
                break
            run.grow(more, departing)
        started = time.perf_counter()
        until = switch(run, start.switchings, last)
        run.advance_to(min(run.step + stretch, run.capacity, until))
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


def _is_stranded(run: Run) -> bool:
    """Whether the studied train stands without power."""
    step, studied = run.step - 1, run.model.control.studied_train
    row = run.recording.trains[step, studied]
    is_fed = row.pantograph_real != 0.0 or row.pantograph_imag != 0.0
    lacks = plain(lacks_power)(step, studied, run.model.options.step_s, run.recording)
    on_board = run.recording.on_board
    feeds_itself = on_board.size > 0 and on_board[step, studied].train_storage_power < 0.0
    return bool(row.speed == 0.0 and (lacks or not (is_fed or feeds_itself)))


def switch(run: Run, switchings: Sequence[Switching], last: int) -> int:
    """Give a run the network that holds from its step on; return the step until which it does."""
    h = run.model.options.step_s
    due = [each.network for each in switchings if each.step(h) <= run.step]
    if due and due[-1] is not run.model.network:
        run.switch_to(due[-1])
    return min([last, *(step for each in switchings if (step := each.step(h)) > run.step)])


def arrivals_s(run: Run) -> npt.NDArray[np.float64]:
    """When each train came to stand at its destination, or NaN. [s]"""
    timetable = np.asarray(run.state.trains)["timetable"]
    instant = timetable["arrival_step"]
    arrived_s = run.instants_s[np.maximum(instant, 0)] - timetable["stood_s"]
    return np.asarray(np.where(instant >= 0, arrived_s, np.nan), dtype=float)


def are_on_line(state: State) -> npt.NDArray[np.bool_]:
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
    trains = int(are_on_line(run.state).sum())
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
        calls=kept.calls[:count],
        waits_for=kept.waits_for[:rows, :count],
        regeneration=kept.regeneration[:rows, :count],
        without_power_s=kept.without_power_s[:rows, :count],
        links=kept.links[:rows],
        conductors=kept.conductors[:rows, :count],
        rails=kept.rails[:rows, :count],
        stores=kept.stores[:rows],
        on_board=kept.on_board[:rows, :count],
    )
    return Outcome(
        status=status,
        steps=run.step,
        trains=tuple(run.trains[:count]),
        studied_train=studied if studied < count else -1,
        arrival_s=arrivals_s(run)[:count],
        instants_s=run.instants_s,
        recording=recording,
        state=run.state,
        trips=run.trips,
    )
