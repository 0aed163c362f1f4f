r"""Protection: stations that pass what they may carry trip, and the run goes on without them.

A station bears the r.m.s. load :math:`k_m` over each window of m minutes.  It trips at the first
instant t at which

.. math:: \frac{1}{m} \int_{t - m}^{t} K^2 \, dt > k_m^2

holds for one of its windows, K being the apparent power of a running unit over its rating; before the
run there was no load.  Its units are alike and share the load, so they trip together.

What happened before an instant does not depend on what trips then.  So the run is made again from its
start, without the station from that instant on, until nothing more trips: the sequence is the one that
would be seen, and each run of it is a whole one.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from tpss.powerflow.following import following, leaders_of
from tpss.powerflow.in_service import in_service
from tpss.powerflow.network import Network
from tpss.run.relays import Relay, Trip
from tpss.run.run import INTERRUPTED, Clock, Progress, Run, advance_to_end, run_of
from tpss.run.start import Start
from tpss.run.switching import Switching
from tpss.step.recording import Memory

ROUNDING = 1e-9
"""A load above what is allowed by less than this share of it is not. [1]"""


def run_to_end(
    start: Start,
    clock: Clock,
    memory: Memory = np.empty,
    report: Callable[[Progress], None] | None = None,
    interrupted: Sequence[int] | None = None,
) -> tuple[Run, str]:
    """Run until the end, again for each station that trips; return the last run and its status.

    Parameters
    ----------
    start : Start
        With its relays.
    clock : callable
        Runs the steps.
    memory : callable, optional
        Allocates the recording.
    report, interrupted
        As of `advance_to_end`.
    """
    return run_on(run_of(start, clock, memory), start, memory, report, interrupted)


def run_on(
    run: Run,
    start: Start,
    memory: Memory = np.empty,
    report: Callable[[Progress], None] | None = None,
    interrupted: Sequence[int] | None = None,
) -> tuple[Run, str]:
    """`run_to_end` of a run that may have come some way, but for fewer steps."""
    if run.trips:
        run = run_of(start, run.clock, memory)
    status = advance_to_end(run, start, report, interrupted)
    while start.relays and status != INTERRUPTED:
        out = {trip.station for trip in run.trips}
        trip = first_trip(run, [relay for relay in start.relays if relay.station not in out])
        if trip is None:
            break
        start, trips = without_station(start, trip), (*run.trips, trip)
        run = run_of(start, run.clock, memory)
        run.trips = trips
        status = advance_to_end(run, start, report, interrupted)
    return run, status


def first_trip(run: Run, relays: Sequence[Relay]) -> Trip | None:
    """The first station that passes what it may carry, if one does; of several the most loaded one."""
    loading = run.recording.stations[: run.step]["converter_loading"]
    found: list[Trip] = []
    for relay in relays:
        over = _means(loading[:, relay.station] ** 2, run.instants_s, relay.window_s)
        passed = np.flatnonzero(over > relay.highest**2 * (1.0 + ROUNDING))
        if passed.size:
            step = int(passed[0])
            time_s = float(run.instants_s[step + 1])
            found.append(Trip(relay.station, time_s, float(over[step]) ** 0.5, relay))
    return min(found, key=lambda t: (t.time_s, -t.load / t.relay.highest), default=None)


def _means(
    values: npt.NDArray[np.float64], instants_s: npt.NDArray[np.float64], window_s: float
) -> npt.NDArray[np.float64]:
    """Means over the window before each instant but the first; before the run they are 0."""
    integral = np.append(0.0, np.cumsum(values * np.diff(instants_s)))
    before: Any = np.interp(instants_s[1:] - window_s, instants_s, integral, left=0.0)
    return np.asarray((integral[1:] - before) / window_s)


def without_station(start: Start, trip: Trip) -> Start:
    """The start of a run in which a station is out from its trip on."""
    whole = [Switching(-np.inf, start.model.network), *start.switchings]
    kept = [each for each in whole if each.time_s < trip.time_s]
    after = [each for each in whole if each.time_s >= trip.time_s]
    later = [Switching(trip.time_s, kept[-1].network), *after]
    cut = [Switching(each.time_s, _without(each.network, trip.station)) for each in later]
    return replace(start, switchings=(*kept[1:], *cut))


def _without(network: Network, station: int) -> Network:
    """A network with a station out of service; nodes that follow others do so again."""
    leaders = leaders_of(network)
    source_of_node = network.source_of_node.copy()
    source_of_node[list(leaders)] = -1
    alone = network._replace(source_of_node=source_of_node)
    return following(in_service(alone, {station: 0}, ()), leaders)
