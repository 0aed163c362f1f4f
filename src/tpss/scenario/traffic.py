"""The traffic: which trains run from where to where, and when."""

from itertools import pairwise
from typing import Annotated, Any, Literal, Self

from pydantic import ConfigDict, Field, model_validator

from tpss.scenario.clock import Moment
from tpss.scenario.fields import (
    Flag,
    Name,
    Part,
    Position,
    Real,
    Whole,
    ascending,
    either_or,
    fault,
    name_of_line,
    one_of,
)
from tpss.scenario.line import TrackNumber

Times = Annotated[
    tuple[Moment, ...],
    Field(min_length=1),
    ascending("departures_min"),
]


Supplement = Annotated[Real, Field(ge=0, le=200)]
"""A supplement to running times."""

SpareTime = Literal["held-speed", "coasting", "least-energy"]
"""How trains use the time that they have to spare."""


def spare_time() -> Any:
    """The field of a service, or of a timetable."""
    return Field(
        default=None,
        description="How trains use the time between two stops that their supplement leaves them, or "
        "without one their scheduled times: by a lower `held-speed`, by `coasting` before the stop, or "
        "by both, with the `least-energy`. Leave it out: supplements by a held speed, and scheduled "
        "times by waiting at the stops.",
    )


DEPARTURES = ("headway_min", "departures_min", "departure_min")
"""Keys that say when trains depart, of which a service has one."""


def track_from_here() -> Any:
    """Field with the number of the track on which a train goes on from a station."""
    return Field(
        default=None,
        description="Number of the track of the line on which the train goes on from here; leave it "
        "out: the one that was given last, see `track` of the service.",
    )


class Stop(Part):
    """An intermediate stop."""

    station: Name = Field(description="Station where it is.")
    track: TrackNumber | None = track_from_here()
    dwell_min: Real = Field(
        ge=0,
        le=100_000,
        description="Duration of the stop; the least one, where a departure is scheduled.",
    )
    turn_min: Real | None = Field(
        default=None,
        ge=0,
        le=100_000,
        description="Time to turn round, where the train goes back on the line on which it came; it "
        "stands there as long at least.",
    )
    arrive_after_min: Real | None = Field(
        default=None,
        gt=0,
        le=100_000,
        description="Scheduled arrival, counted from the train's own departure at its origin; its "
        "lateness is judged by it.",
    )
    depart_after_min: Real | None = Field(
        default=None,
        gt=0,
        le=100_000,
        description="Scheduled departure, counted likewise: a train does not leave before.",
    )

    @model_validator(mode="after")
    def _departs_after_it_arrives(self) -> Self:
        arrival, departure = self.arrive_after_min, self.depart_after_min
        if arrival is not None and departure is not None and departure < arrival:
            raise fault(
                f"the scheduled departure, after {departure:g} min, lies before the arrival, after "
                f"{arrival:g} min",
                "give the times in the order of travel",
            )
        return self


class Pass(Part):
    """A station where a train does not stop, for the time at which it passes, or for its track."""

    station: Name = Field(description="Station of the line.")
    track: TrackNumber | None = track_from_here()
    after_min: Real | None = Field(
        default=None,
        ge=0,
        le=100_000,
        description="Scheduled time, counted from the train's own departure at its origin; its lateness "
        "is judged by it, and no train waits for it.",
    )


class Delays(Part):
    """Departures that are later than scheduled, drawn for each train; its other times stay scheduled.

    A delay depends on seed and name of its train only. Trains that run already at the start have none.
    """

    mean_min: Real = Field(
        gt=0,
        le=1_000,
        description="Mean delay of the trains that are delayed, distributed exponentially.",
    )
    share: Real = Field(default=1.0, gt=0, le=1, description="Share of trains that are delayed.")
    seed: Whole = Field(
        default=0,
        ge=0,
        le=2**53,
        description="Number that decides which trains are delayed, and by what.",
    )


class InitialTrain(Part):
    """A train that is on its way when the simulation begins, heading for its next stop."""

    line: Name | None = name_of_line()
    position_km: Position = Field(description="Position on its line.")
    speed_kmh: Real = Field(ge=0, le=500, description="Speed.")


class Traffic(Part):
    """A service: trains of one type from one station to another."""

    model_config = ConfigDict(json_schema_extra=one_of(*DEPARTURES))

    name: Name = Field(
        description="Name, from which the names of its trains are derived, or that of a single train."
    )
    train: Name = Field(description="One of the scenario's trains.")
    origin: Name = Field(alias="from", description="Station where the trains begin.")
    destination: Name = Field(alias="to", description="Station where they leave the line.")
    via: tuple[Name, ...] = Field(
        default=(),
        description="Stations that they pass, in order; needed where the shortest way is not meant.",
    )
    track: TrackNumber | None = Field(
        default=None,
        description="Number of the track of the line on which the trains run from their origin, counted "
        "from the left as seen in rising kilometres, until a stop or pass gives another one or the line "
        "ends for them; leave it out: that of their direction, as where the line has no such track.",
    )
    headway_min: Real | None = Field(
        default=None, ge=0.01, le=100_000, description="Time between departures."
    )
    departures_min: Times | None = Field(
        default=None, description="Times of departure, in place of a headway."
    )
    departure_min: Moment | None = Field(
        default=None,
        description="Time of departure of a single train, in place of a headway; its name is that of "
        "the service.",
    )
    first_departure_min: Moment = Field(
        default=0.0, description="Time of the first departure, with a headway."
    )
    already_running: Flag = Field(
        default=False,
        description="Whether trains are distributed along the line at the start, as if the "
        "service had always run.",
    )
    delays: Delays | None = Field(
        default=None, description="Delays of departures; leave it out: none."
    )
    supplement_percent: Supplement = Field(
        default=0.0,
        description="Supplement to the technical running time between stops: trains hold less speed.",
    )
    supplement_min_per_100km: Supplement = Field(
        default=0.0, description="Supplement for each 100 km, alone or in addition."
    )
    spare_time: SpareTime | None = spare_time()
    initial_trains: tuple[InitialTrain, ...] = Field(
        default=(), description="Trains on the line at the start."
    )
    stops: tuple[Stop, ...] = Field(default=(), description="Intermediate stops, in order.")
    passes: tuple[Pass, ...] = Field(
        default=(),
        description="Stations on the way without a stop whose times are wanted, or where the trains "
        "change to another track, in order.",
    )
    arrive_after_min: Real | None = Field(
        default=None,
        gt=0,
        le=100_000,
        description="Scheduled arrival at the destination, counted from each train's own departure.",
    )

    @property
    def listed_departures_min(self) -> tuple[float, ...] | None:
        """Departures, if they are listed or that of a single train; None with a headway. [min]"""
        return self.departures_min if self.departure_min is None else (self.departure_min,)

    @property
    def departs_by_schedule(self) -> bool:
        """Whether its trains have a scheduled departure, from which their other times count.

        Without it they count from each train's departure, whenever that is.
        """
        return self.departure_min is not None or self.delays is not None

    @property
    def has_supplement(self) -> bool:
        """Whether its trains take longer than they might."""
        return self.supplement_percent > 0.0 or self.supplement_min_per_100km > 0.0

    @property
    def uses_spare_time(self) -> bool:
        """Whether its trains take longer than they might, from stop to stop."""
        return self.has_supplement or self.spare_time is not None

    @property
    def scheduled_running_min(self) -> tuple[float | None, ...]:
        """Scheduled time from each stop to the next one; None where it is not known. [min]"""
        arrivals = [*(stop.arrive_after_min for stop in self.stops), self.arrive_after_min]
        departures: list[float | None] = [0.0]
        for stop in self.stops:
            departure, arrival = stop.depart_after_min, stop.arrive_after_min
            if departure is None and arrival is not None:
                departure = arrival + max(stop.dwell_min, stop.turn_min or 0.0)
            departures.append(departure)
        return tuple(
            None if begin is None or end is None else end - begin
            for begin, end in zip(departures, arrivals, strict=True)
        )

    @property
    def is_scheduled(self) -> bool:
        """Whether lateness is judged: with delays, or times on the way or at the destination."""
        if self.delays is not None:
            return True
        times = [self.arrive_after_min, *(each.after_min for each in self.passes)]
        times += [time for s in self.stops for time in (s.arrive_after_min, s.depart_after_min)]
        return any(time is not None for time in times)

    @model_validator(mode="after")
    def _scheduled_times_grow(self) -> Self:
        scheduled = [
            (stop.station, minutes)
            for stop in self.stops
            for minutes in (stop.arrive_after_min, stop.depart_after_min)
        ]
        given = [(name, time) for name, time in scheduled if time is not None]
        if self.arrive_after_min is not None:
            given.append((self.destination, self.arrive_after_min))
        for (before, early), (name, late) in pairwise(given):
            if late < early:
                raise fault(
                    f"{name} is scheduled after {late:g} min, before {before}, after {early:g} min",
                    "give the times in the order of travel, each from the departure at the origin",
                )
        return self

    @model_validator(mode="after")
    def _departures_are_given_once(self) -> Self:
        if sum(getattr(self, key) is not None for key in DEPARTURES) != 1:
            raise either_or(*DEPARTURES)
        if self.already_running and (self.headway_min is None or self.initial_trains):
            raise fault(
                "already_running needs headway_min, and replaces initial_trains",
                "leave already_running out, or use it with headway_min alone",
            )
        if self.uses_spare_time and self.initial_trains:
            raise fault(
                "initial_trains may be faster than trains that take a supplement hold",
                "leave initial_trains out, or the supplement and spare_time",
            )
        known = self.has_supplement or any(m is not None for m in self.scheduled_running_min)
        if self.spare_time is not None and not known:
            raise fault(
                "spare_time, but no time to spare is known",
                "give a supplement, or scheduled times of departure and arrival",
            )
        if self.headway_min is None and self.first_departure_min:
            raise fault(
                "first_departure_min belongs to headway_min; the departures are given",
                "leave first_departure_min out",
            )
        return self
