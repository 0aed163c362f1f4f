"""What moves from one run to the same run with half its time step."""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

from tpss.results.key_figures import KeyFigures

LARGEST, LARGEST_OF_EXTREMES = 0.01, 0.02
"""Changes beyond which a step is too long: of times and energies, and of the lowest voltage and the
peak loading, which are values of a single step. [1]"""

LEAST_DROP = 0.01
"""A voltage drop less than this share of the voltage without load counts as much as that. [1]"""

FINISHED = "finished"


class Change(NamedTuple):
    """A figure at a step and at half of it."""

    figure: str
    """Name of the figure, as in the summary or the tables."""
    of: str
    """Train, service or station; empty for a figure of the whole run."""
    at_step: float
    at_half_step: float
    share: float
    """Change over the figure; over the drop of a voltage, over the total of energies. [1]"""
    limit: float
    """Largest share of a step that is short enough. [1]"""

    def as_dict(self) -> dict[str, Any]:
        """The change by the names of its parts."""
        return {**self._asdict(), "within": self.within()}

    def within(self, strictness: float = 1.0) -> bool:
        """Whether the change is within its limit, or within a part of it."""
        return abs(self.share) <= self.limit * strictness


def changes_between(
    figures: KeyFigures, finer: KeyFigures, no_load_kv: float
) -> tuple[Change, ...]:
    """Changes of the figures of a run; of two that end early alike, of the time at which they do.

    Parameters
    ----------
    figures : KeyFigures
    finer : KeyFigures
        Of the same scenario at half the step.
    no_load_kv : float
        Highest voltage of a station without load, from which the drop counts. [kV]
    """
    if figures.status != finer.status:
        return ()
    if figures.status != FINISHED:
        found = [_end(figures, finer)]
    else:
        found = [
            *_trips(figures, finer),
            *_energies(figures, finer),
            *_lowest_voltage(figures, finer, no_load_kv),
            *_peak_loading(figures, finer),
        ]
    return tuple(change for change in found if math.isfinite(change.share))


def _of_itself(figure: str, of: str, here: float, finer: float, limit: float = LARGEST) -> Change:
    """A change that is measured by the figure itself; NaN if one of the runs does not have it."""
    if here == 0.0:
        return Change(figure, of, here, finer, finer and math.copysign(1.0, finer), limit)
    return Change(figure, of, here, finer, (finer - here) / abs(here), limit)


def _end(figures: KeyFigures, finer: KeyFigures) -> Change:
    """Of the time at which a run ends early, which is known to a step: to move by one is no fault."""
    here_min, then_min = figures.duration_min, finer.duration_min
    step_min = here_min / figures.steps if figures.steps else 2.0 * then_min / max(finer.steps, 1)
    scale_min = max(here_min, step_min / LARGEST)
    share = (then_min - here_min) / scale_min if scale_min else 0.0
    return Change("duration_min", "", here_min, then_min, share, LARGEST)


def _trips(figures: KeyFigures, finer: KeyFigures) -> Iterator[Change]:
    """Of the studied train, and means of services of which as many trains have arrived."""
    name = figures.studied_train or ""
    yield _of_itself("trip_time_min", name, figures.trip_time_min, finer.trip_time_min)
    for service, other in zip(figures.services, finer.services, strict=True):
        if service.arrived == other.arrived:
            means_min = service.mean_trip_min, other.mean_trip_min
            yield _of_itself("mean_trip_min", service.name, *means_min)


def _energies(figures: KeyFigures, finer: KeyFigures) -> Iterator[Change]:
    """Of all stations and of each; all are measured by what the stations have to do with."""
    total_mwh = math.fsum(abs(station.energy_mwh) for station in figures.stations)
    energies_mwh = [("total_energy_mwh", "", figures.total_energy_mwh, finer.total_energy_mwh)]
    energies_mwh += [
        ("energy_mwh", station.name, station.energy_mwh, other.energy_mwh)
        for station, other in zip(figures.stations, finer.stations, strict=True)
    ]
    for figure, of, here, then in energies_mwh:
        yield _of_itself(figure, of, here, then)._replace(
            share=(then - here) / total_mwh if total_mwh else 0.0
        )


def _lowest_voltage(figures: KeyFigures, finer: KeyFigures, no_load_kv: float) -> Iterator[Change]:
    here, then = figures.lowest_voltage, finer.lowest_voltage
    if here is not None and then is not None:
        drop_kv = max(abs(no_load_kv - here.voltage_kv), LEAST_DROP * no_load_kv)
        yield Change(
            "lowest_voltage_kv",
            here.train,
            here.voltage_kv,
            then.voltage_kv,
            (then.voltage_kv - here.voltage_kv) / drop_kv,
            LARGEST_OF_EXTREMES,
        )


def _peak_loading(figures: KeyFigures, finer: KeyFigures) -> Iterator[Change]:
    """Of the station that is loaded most."""
    loaded = [station for station in figures.stations if math.isfinite(station.peak_loading)]
    if loaded:
        most = max(loaded, key=lambda station: station.peak_loading)
        then = next(station for station in finer.stations if station.name == most.name)
        peaks = most.peak_loading, then.peak_loading
        yield _of_itself("peak_loading", most.name, *peaks, limit=LARGEST_OF_EXTREMES)
