"""Energy that trains save with time to spare, alone on their line at nominal voltage."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple, get_args

import pandas as pd

from tpss.model.build import build_model
from tpss.model.spare_time import Leg, Manner, Way, way_that_takes
from tpss.model.traffic import build_services
from tpss.results.standards.windows import table_of
from tpss.results.tables import J_PER_MWH
from tpss.run.services import Service
from tpss.scenario.open_step import with_step
from tpss.scenario.scenario import Scenario
from tpss.step.model import Model

PERCENTS = (2.0, 5.0, 10.0, 15.0, 20.0)
"""Times to spare that are tried, in percent of the technical running time."""

MANNERS: tuple[Manner, ...] = get_args(Manner)


class Saving(NamedTuple):
    """What trains of a service save with a time to spare, by one manner of driving."""

    service: str
    train: str
    alike: int
    """Number of services of such trains on the same way, with the same stops."""
    spare_percent: float
    """Time to spare, of the technical running time."""
    manner: str
    running_min: float
    """Time under way from stop to stop, without the stops."""
    spare_min: float
    energy_mwh: float
    """Energy at the pantograph, less what is fed back."""
    saved_percent: float
    """Of the energy of a train that is as fast as it can be."""


@dataclass(frozen=True)
class _Group:
    """Services whose trains drive alike."""

    first: Service
    train: str
    services: int


def spare_time_savings(
    scenario: Scenario,
    percents: Sequence[float] = PERCENTS,
    report: Callable[[int, int], None] | None = None,
) -> pd.DataFrame:
    """What each service saves by using time to spare: one row per service, time and manner of driving.

    Each way from stop to stop gets the same share of its technical running time.  A train drives it
    alone and at nominal voltage, by a lower held speed, by coasting before the stop, or by both with the
    least energy; see the key ``spare_time`` of a service.

    Parameters
    ----------
    scenario : Scenario
    percents : sequence of float
        Times to spare, in percent of the technical running time, not negative.
    report : callable, optional
        Called with the number of services done, and of all.

    Returns
    -------
    pandas.DataFrame
        Columns are the fields of `Saving`, with units in their names.  Services whose trains drive
        alike are one; a service whose trains do not reach their destination has no rows.
    """
    scenario = with_step(scenario)  # a way from stop to stop is found without one
    model, _ = build_model(scenario)
    groups = list(_groups(scenario, model))
    rows: list[Saving] = []
    for number, group in enumerate(groups, 1):
        rows += _savings(model, group, percents)
        if report is not None:
            report(number, len(groups))
    return table_of(rows, Saving)


def _groups(scenario: Scenario, model: Model) -> Iterator[_Group]:
    services: dict[tuple[object, ...], list[tuple[Service, str]]] = {}
    for service, entry in zip(build_services(scenario, model), scenario.traffic, strict=True):
        key = service.train_type, service.start_m, service.stops_m
        services.setdefault(key, []).append((service, entry.train))
    for alike in services.values():
        yield _Group(*alike[0], len(alike))


def _savings(model: Model, group: _Group, percents: Sequence[float]) -> Iterator[Saving]:
    service = group.first
    legs = [
        Leg(model, service.train_type, *ends_m)
        for ends_m in pairwise((service.start_m, *service.stops_m))
    ]
    fastest = [leg.way() for leg in legs]
    if not all(math.isfinite(way.time_s) for way in fastest):
        return
    technical_s, whole_j = _sums(fastest)
    for percent in percents:
        for manner in MANNERS:
            ways = [
                way_that_takes(leg, way.time_s * (1.0 + percent / 100.0), manner)
                for leg, way in zip(legs, fastest, strict=True)
            ]
            time_s, energy_j = _sums(ways)
            yield Saving(
                service=service.name,
                train=group.train,
                alike=group.services,
                spare_percent=percent,
                manner=manner,
                running_min=time_s / 60.0,
                spare_min=(time_s - technical_s) / 60.0,
                energy_mwh=energy_j / J_PER_MWH,
                saved_percent=100.0 * (1.0 - energy_j / whole_j) if whole_j else math.nan,
            )


def _sums(ways: Sequence[Way]) -> tuple[float, float]:
    """Time [s] and energy [J] of all ways together."""
    return math.fsum(way.time_s for way in ways), math.fsum(way.energy_j for way in ways)
