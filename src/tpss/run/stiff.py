"""Time that trains lose to the voltage: the same run once more, at the supply's voltage without load.

At that voltage everywhere, whatever trains draw, they meet the same line, limits and stops; what they
are later by in the run itself is what the supply takes from them.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tpss.run.run import INTERRUPTED, Progress, Run, advance_to_end, arrivals_s, run_of
from tpss.run.start import Start


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
    other = run_of(stiff)
    if advance_to_end(other, stiff, report, interrupted) == INTERRUPTED:
        return {}
    arrived = _arrivals_by_name(other)
    return {
        name: time_s - arrived[name]
        for name, time_s in _arrivals_by_name(run).items()
        if name in arrived
    }


def _arrivals_by_name(run: Run) -> dict[str, float]:
    """When the trains came to stand at their destinations that did. [s]"""
    arrived_s = zip(run.trains, arrivals_s(run), strict=True)
    return {train.name: float(time_s) for train, time_s in arrived_s if math.isfinite(time_s)}
