r"""Protection: equipment that passes what it may carry trips, and the run goes on without it.

A station, a transformer or a section of contact line bears the r.m.s. load :math:`k_m` over each window
of m minutes.  It trips at the first instant t at which

.. math:: \frac{1}{m} \int_{t - m}^{t} K^2 \, dt > k_m^2

holds for one of its windows, K being its load over the rated one; before the run there was no load.  The
units of a station share a load and are at one busbar: they trip together, if one of them passes what it
bears.

What happened before an instant does not depend on what trips then.  So the run is made again from its
start, without the equipment from that instant on, until nothing more trips: the sequence is the one that
would be seen, and each run of it is a whole one.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from tpss.physics.rectifier_bridge import current_at_power
from tpss.run.relays import Relay, Trip
from tpss.run.run import INTERRUPTED, Clock, Progress, Run, advance_to_end, run_of
from tpss.run.start import Start
from tpss.sources.mixed import TYPES, split_all
from tpss.step.recording import Memory

Floats = npt.NDArray[np.float64]

ROUNDING = 1e-9
"""A load above what is allowed by less than this share of it is not. [1]"""


def run_to_end(
    start: Start,
    clock: Clock,
    memory: Memory = np.empty,
    report: Callable[[Progress], None] | None = None,
    interrupted: Sequence[int] | None = None,
) -> tuple[Run, str]:
    """Run until the end, again for each trip; return the last run and its status.

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
        out = {trip.protected for trip in run.trips}
        trip = first_trip(run, [relay for relay in start.relays if relay.protected not in out])
        if trip is None:
            break
        start, trips = start.with_trips((*run.trips, trip)), (*run.trips, trip)
        run = run_of(start, run.clock, memory)
        run.trips = trips
        status = advance_to_end(run, start, report, interrupted)
    return run, status


def first_trip(run: Run, relays: Sequence[Relay]) -> Trip | None:
    """The first that passes what it may carry, if any does; of several the most loaded one."""
    found: list[Trip] = []
    for relay in relays:
        over = _means(_load(run, relay) ** 2, run.instants_s, relay.window_s)
        passed = np.flatnonzero(over > relay.highest**2 * (1.0 + ROUNDING))
        if passed.size:
            step = int(passed[0])
            time_s = float(run.instants_s[step + 1])
            found.append(Trip(relay.protected, time_s, float(over[step]) ** 0.5, relay))
    return min(found, key=lambda t: (t.time_s, -t.load / t.relay.highest), default=None)


def _load(run: Run, relay: Relay) -> Floats:
    """Load in each step, over the rated one. [1]"""
    if relay.current >= 0:
        return (
            np.nan_to_num(run.recording.branch_current[: run.step, relay.current]) / relay.rated_a
        )
    s, rows = relay.protected.station, np.asarray(run.recording.stations)[: run.step]
    if relay.group_current_a:
        points = np.array(relay.group_current_a), np.array(relay.group_voltage_v)
        groups = np.maximum(rows["active_converters"][:, s], 1.0)
        each_w = np.nan_to_num(rows["station_active_power"][:, s]) / groups
        return current_at_power(each_w, *points) / relay.rated_a
    if relay.type_number < 0:
        return np.asarray(rows["converter_loading"][:, s])
    powers_va = rows["station_active_power"][:, s] + 1j * rows["station_reactive_power"][:, s]
    shared = np.zeros((run.step, len(TYPES)), dtype=complex)
    split_all(np.nan_to_num(powers_va), run.model.network.sources[s].mixed, shared)
    return np.abs(shared[:, relay.type_number]) / relay.rated_va


def _means(values: Floats, instants_s: Floats, window_s: float) -> Floats:
    """Means over the window before each instant but the first; before the run they are 0."""
    integral = np.append(0.0, np.cumsum(values * np.diff(instants_s)))
    before: Any = np.interp(instants_s[1:] - window_s, instants_s, integral, left=0.0)
    return np.asarray((integral[1:] - before) / window_s)
