"""Where a run begins in the time of a file."""

import math
import re
from datetime import datetime
from typing import NamedTuple

from tpss.measured.load import Measured
from tpss.measured.times import CLOCK, DATE, Times
from tpss.scenario.clock import DAY_S


class Begin(NamedTuple):
    """What the time of a file is at minute 0 of a run.

    Attributes
    ----------
    seconds : float
        In seconds of the file. [s]
    known : bool
        Whether it is said, or only where a search for the offset begins.
    notes : tuple of str
    """

    seconds: float
    known: bool
    notes: tuple[str, ...] = ()


def begin_of(
    measured: Measured, run_s: float, starts_s: float | None, given: str | None, searched: bool
) -> Begin:
    """What the time of a file is at minute 0 of a run.

    Parameters
    ----------
    measured : Measured
    run_s : float
        Length of the run. [s]
    starts_s : float, optional
        What the clock shows at its start, by the scenario. [s]
    given : str, optional
        What was said: a time of the clock, a date with one, or minutes of a file that counts.
    searched : bool
        Whether the offset is looked for, so that it need not be known.

    Raises
    ------
    ScenarioError
        What was said does not fit the file, or nothing was said although it must be.
    """
    times = measured.times
    if times.kind == "count":
        return Begin(_counted(measured, given), True)
    if given is not None and times.kind == "date" and re.fullmatch(DATE, given):
        return Begin(_dated(measured, given), True, _about_zone(times))
    clock_s = starts_s if given is None else _clock(measured, given)
    if clock_s is not None:
        day, told = _day(times, clock_s, run_s)
        return Begin(clock_s + DAY_S * day, True, (*_about_zone(times), *told))
    if not searched:
        raise measured.fault(
            "its times are those of a clock, and the scenario does not say what the clock shows at "
            "minute 0",
            "give --begins HH:MM:SS, or starts_at in the scenario's [simulation], or let --find-offset "
            "look for it",
        )
    note = (
        "the scenario has no starts_at: the offset is looked for around a begin at the first time of "
        f"the file, {times.in_words(float(times.seconds[0]))}"
    )
    return Begin(float(times.seconds[0]), False, (note, *_about_zone(times)))


def _about_zone(times: Times) -> tuple[str, ...]:
    if not times.zone:
        return ()
    return (f"the run's clock is taken to show the time of the file's first zone, {times.zone}",)


def _counted(measured: Measured, given: str | None) -> float:
    try:
        minutes = 0.0 if given is None else float(given)
    except ValueError:
        minutes = math.nan
    if not math.isfinite(minutes):
        raise measured.fault(
            f"its times are counted from a start, and {given} is not a number of minutes",
            "give with --begins the minute of the file at which the run begins, or leave it out",
        )
    return 60.0 * minutes


def _clock(measured: Measured, given: str) -> float:
    match = re.fullmatch(CLOCK, given)
    if match is None:
        raise measured.fault(
            f"its times are those of a clock, and {given} is not one",
            "give with --begins HH:MM or HH:MM:SS, and with a date only if the file has dates",
        )
    return (
        3600.0 * int(match[1]) + 60.0 * int(match[2]) + float((match[3] or "0").replace(",", "."))
    )


def _dated(measured: Measured, given: str) -> float:
    times, match = measured.times, re.fullmatch(DATE, given)
    assert match is not None
    if bool(match[3]) != bool(times.zone):
        has = f"the time zone {times.zone}" if times.zone else "no time zone"
        raise measured.fault(
            f"its times have {has}, unlike {given}", "give --begins as the file gives its times"
        )
    try:
        begin = datetime.fromisoformat(f"{match[1]}T{match[2].replace(',', '.')}{match[3] or ''}")
    except ValueError:
        raise measured.fault(f"{given} is no date", "correct --begins") from None
    midnight = datetime.fromisoformat(f"{times.day}T00:00:00{times.zone}")
    return (begin - midnight).total_seconds()


def _day(times: Times, clock_s: float, run_s: float) -> tuple[int, tuple[str, ...]]:
    """Day of the file, counted from 0, on which it shares most time with the run, and a note."""
    first_s, last_s = float(times.seconds[0]), float(times.seconds[-1])
    days = range(
        math.floor((first_s - clock_s - run_s) / DAY_S), math.ceil((last_s - clock_s) / DAY_S) + 1
    )
    shared_s = {
        day: min(last_s, clock_s + DAY_S * day + run_s) - max(first_s, clock_s + DAY_S * day)
        for day in days
    }
    day = max(shared_s, key=lambda each: (shared_s[each], -abs(each)), default=0)
    others = sum(shared > 0.0 for shared in shared_s.values())
    if others < 2:
        return day, ()
    begin = times.in_words(clock_s + DAY_S * day)
    remedy = "; --begins with a date chooses another" if times.kind == "date" else ""
    note = (
        f"the file covers the run's time of the clock on {others} days; the run is put at {begin}"
    )
    return day, (f"{note}{remedy}",)
