"""Time that trains lose to the voltage: the same run once more, at the supply's voltage without load.

At that voltage everywhere, whatever trains draw, they meet the same line, limits and stops; what they
are later by in the run itself is what the supply takes from them.
"""

import math
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from tpss.kept import Kept, content_of
from tpss.kernel import plain
from tpss.run.run import INTERRUPTED, Progress, Run, advance_to_end, arrivals_s, run_of
from tpss.run.start import Start
from tpss.step.model import driving_data
from tpss.step.recording import is_kept_apart


@dataclass(frozen=True)
class LostTime:
    """What trains that have arrived lost to the voltage."""

    voltage_v: float
    """Voltage that they are compared at. [V]"""
    trains: int
    """Number of trains that have arrived in both runs."""
    total_s: float
    """Sum over these trains. [s]"""
    worst_s: float
    """Largest of a train. [s]"""
    worst_train: str

    def as_dict(self) -> dict[str, Any]:
        """For a summary, in engineering units."""
        return {
            "voltage_kv": self.voltage_v / 1e3,
            "trains": self.trains,
            "total_min": self.total_s / 60.0,
            "worst_min": self.worst_s / 60.0,
            "worst_train": self.worst_train,
        }


def lost_to_voltage(
    run: Run,
    start: Start,
    voltage_v: float,
    report: Callable[[Progress], None] | None = None,
    interrupted: Sequence[int] | None = None,
) -> LostTime | None:
    """Make a run again at one voltage, for as many steps, and compare the arrivals.

    Parameters
    ----------
    run : Run
        One that has ended.
    start : Start
        From which it began.
    voltage_v : float
        Voltage at every pantograph. [V]
    report, interrupted
        As of `advance_to_end`.

    Returns
    -------
    LostTime or None
        None if no train has arrived, or the comparison was interrupted.
    """
    lost_s = lost_by_train(run, start, voltage_v, report, interrupted)
    if not lost_s:
        return None
    worst = max(lost_s, key=lambda name: lost_s[name])
    return LostTime(voltage_v, len(lost_s), math.fsum(lost_s.values()), lost_s[worst], worst)


def lost_by_train(
    run: Run,
    start: Start,
    voltage_v: float,
    report: Callable[[Progress], None] | None = None,
    interrupted: Sequence[int] | None = None,
) -> dict[str, float]:
    """What each train lost to the voltage that has arrived in the run and in one at one voltage. [s]

    Parameters are those of `lost_to_voltage`; there is none if that was interrupted.
    """
    if run.step == 0 or not np.isfinite(arrivals_s(run)).any():
        return {}
    control = start.model.control._replace(fixed_voltage_v=voltage_v, studied_train=-1)
    model = start.model._replace(control=control)
    stiff = replace(start, model=model, steps=run.step, switchings=())
    arrived = _stiff_arrivals(stiff, run.step, report, interrupted)
    if arrived is None:
        return {}
    return {
        name: time_s - arrived[name]
        for name, time_s in _arrivals_by_name(run).items()
        if name in arrived
    }


class _Stiff(NamedTuple):
    """When trains came to stand at their destinations in a run at one voltage."""

    steps: int
    """Length of the run."""
    arrivals: dict[str, tuple[int, float]]
    """Instant and time of each train. [s]"""

    def within(self, steps: int) -> dict[str, float]:
        """Those of a run of no more steps. [s]"""
        return {name: time_s for name, (step, time_s) in self.arrivals.items() if step <= steps}


_kept = Kept[_Stiff](256)


def _stiff_arrivals(
    start: Start,
    steps: int,
    report: Callable[[Progress], None] | None,
    interrupted: Sequence[int] | None,
) -> dict[str, float] | None:
    """When trains of a run at one voltage came to stand, by name; None: it was interrupted. [s]

    Where trains do not look out for each other they do not know the supply: cases with the same trains
    on the same line have these runs in common.
    """
    key = _known_to_trains(start) if not is_kept_apart(start.model) else None
    known = None if key is None else _kept.get(key)
    if known is None or known.steps < steps:
        other = run_of(start)
        if advance_to_end(other, start, report, interrupted) == INTERRUPTED:
            return None
        instants = other.state.trains["timetable"]["arrival_step"].tolist()
        times_s = _arrivals_by_name(other)
        names = zip(other.trains, instants, strict=True)
        known = _Stiff(
            other.step,
            {each.name: (n, times_s[each.name]) for each, n in names if each.name in times_s},
        )
        if key is not None:
            _kept.put(key, known)
    return known.within(steps)


def _known_to_trains(start: Start) -> Hashable:
    """What drivers know, the voltages and the trains: all that decides about a run at one voltage."""
    model = start.model
    known = (*plain(driving_data)(model), model.points)
    voltages_v = model.control.fixed_voltage_v, model.network.system.nominal_voltage_v
    return content_of(known), voltages_v, tuple(start.trains), tuple(start.services)


def _arrivals_by_name(run: Run) -> dict[str, float]:
    """When the trains came to stand at their destinations that did. [s]"""
    arrived_s = zip(run.trains, arrivals_s(run), strict=True)
    return {train.name: float(time_s) for train, time_s in arrived_s if math.isfinite(time_s)}
