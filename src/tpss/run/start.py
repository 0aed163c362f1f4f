"""What a run begins with: who stands on the line, who departs, and how many steps are foreseen."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tpss.record import Records
from tpss.run.already_running import trains_on_line
from tpss.run.limits import demand_room
from tpss.run.relays import Relay, Trip
from tpss.run.services import ScheduledTrain, Service, departing_trains, train_records
from tpss.run.switching import Switching
from tpss.step.model import Model, RunControl
from tpss.step.turns import Turn
from tpss.vehicle.train import Train


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
    switchings: tuple[Switching, ...] = ()
    """Networks that take the place of the model's, in the order of time."""
    turns: Records[Turn] | None = None
    """Planned order at gates, if trains keep one."""
    relays: tuple[Relay, ...] = ()
    """What equipment bears that trips otherwise; none: nothing does."""
    cut: Callable[[Sequence[Trip]], tuple[Switching, ...]] | None = None
    """Gives the switchings of a run in which something trips."""

    def with_trips(self, trips: Sequence[Trip]) -> "Start":
        """The start of a run in which these trip, in the order of time."""
        if self.cut is None:
            raise ValueError("nothing of this run can trip")
        return replace(self, switchings=self.cut(trips))


def demand_room_to_depart(
    model: Model, services: list[Service], steps: int | None
) -> tuple[int, int]:
    """Number of steps that a run is foreseen to have, and of trains that depart in them.

    Parameters are those of `begin`.

    Raises
    ------
    TooLargeError
        The recording of these trains would not fit into memory.
    """
    h = model.options.step_s
    first_s = next(services[0].departure_times_s(math.inf)) + services[0].delay_s(1)
    capacity = steps or foreseen_steps(model, services[0]) + math.ceil(first_s / h)
    departures = sum(service.departures_before(capacity * h) for service in services)
    demand_room(model, capacity, departures)
    return capacity, departures


def begin(
    model: Model,
    services: list[Service],
    steps: int | None,
    switchings: tuple[Switching, ...] = (),
) -> Start:
    """Find out which trains stand on the line at the start, and which depart.

    Parameters
    ----------
    model : Model
    services : list of Service
        The first departure of the first one is the studied train.
    steps : int or None
        Number of steps; None: until the studied train arrives.
    switchings : tuple of Switching, optional
        Networks that take the place of the model's, in the order of time.

    Raises
    ------
    TooLargeError
        The recording would not fit into memory.
    """
    # Too many steps are told before trains run by all of them to find out which are on the line.
    capacity, departures = demand_room_to_depart(model, services, steps)
    on_line = trains_on_line(model, services)
    demand_room(model, capacity, len(on_line) + departures)
    trains = [*on_line, *departing_trains(services, model.options, 0, capacity)]
    names = [train.name for train in trains]
    studied_name = services[0].name_of(1)
    studied = names.index(studied_name) if studied_name in names else -1
    ends_with = studied if steps is None else -1
    types = np.asarray(model.types)
    spares_motors = bool((types["spared"]["continuous_a"] < math.inf).any())
    control = RunControl(
        studied_train=ends_with,
        spares_motors=spares_motors,
        has_stores=bool((types["on_board"]["store"]["capacity_j"] > 0.0).any()),
    )
    model = model._replace(control=control)
    records = train_records(trains, model.network.system.nominal_voltage_v)
    return Start(model, services, steps, capacity, trains, records, studied, switchings)
