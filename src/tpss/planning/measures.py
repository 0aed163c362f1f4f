"""Measures, their levels and renewals, and the transitions between configurations that follow."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tpss.errors import PlanError
from tpss.planning.level_transitions import LevelTransitions
from tpss.planning.money import Array, Stages
from tpss.planning.transitions import Transitions
from tpss.planning.tree import Indices

Flags = npt.NDArray[np.bool_]

MOST_IN_TABLE = 256
"""Configurations up to which a table of all pairs is faster than sums over measures."""


@dataclass(frozen=True)
class Measure:
    """What may be built, in one level or several.

    Raises
    ------
    PlanError
        There is no level, the first is not free, or a price is no number.
    """

    name: str
    price: tuple[float, ...]
    """Price of each level from nothing, level 0 first, which is not built and costs 0.  A higher level
    costs the difference to what is there."""
    lifetime_a: float | None = None
    """Lifetime [a]; without one the whole price is charged, whenever it is built."""
    first_stage: int = 0
    """First stage in which it, or a higher level of it, may come into service."""
    last_stage: int | None = None
    """Last such stage; without one it may always."""
    replaces: tuple[int, ...] = ()
    """Measures whose place it takes, by their numbers: they go, and nothing is paid back."""

    def __post_init__(self) -> None:
        if len(self.price) < 2 or self.price[0] != 0.0:
            raise PlanError(f"measure {self.name}: prices of its levels start with 0, not built")
        if not np.isfinite(self.price).all():
            raise PlanError(f"measure {self.name}: a price is missing")

    def may_be_built(self, stage: int) -> bool:
        """Whether it may come into service at the start of a stage."""
        return self.first_stage <= stage and (self.last_stage is None or stage <= self.last_stage)


@dataclass(frozen=True)
class Renewal:
    """What today's equipment costs in a year if it is still there.

    Raises
    ------
    PlanError
        Its cost is no number.
    """

    name: str
    cost: float
    year: float
    unless: tuple[int, ...] = ()
    """Measures that spare it if one of them is in service in that year's stage, by their numbers."""
    lifetime_a: float | None = None
    """Lifetime of what is renewed [a]; without one the whole cost is charged."""
    in_budget: bool = False
    """Whether it counts towards a budget."""

    def __post_init__(self) -> None:
        if not np.isfinite(self.cost):
            raise PlanError(f"renewal {self.name}: its cost is missing")


def allowed(
    levels: Indices,
    excludes: Iterable[tuple[int, int]] = (),
    needs: Iterable[tuple[int, int]] = (),
) -> Flags:
    """Which configurations may be, shape (configurations,).

    Parameters
    ----------
    levels : array
        Level of each measure in each configuration, shape (configurations, measures); 0: not built.
    excludes : pairs of measures, optional
        Those of which only one may be built.
    needs : pairs of measures, optional
        The first may only be built with the second.
    """
    built = levels > 0
    fine = np.ones(len(levels), dtype=np.bool_)
    for one, other in excludes:
        fine &= ~(built[:, one] & built[:, other])
    for one, other in needs:
        fine &= ~built[:, one] | built[:, other]
    return fine


def make_transitions(
    stages: Stages,
    levels: Indices,
    measures: Sequence[Measure],
    renewals: Sequence[Renewal] = (),
    initial: int = 0,
    most_in_table: int = MOST_IN_TABLE,
) -> Transitions | LevelTransitions:
    """Transitions between configurations of measures.

    Measures stay once they are built, except where another takes their place.

    Parameters
    ----------
    stages : Stages
    levels : array
        Level of each measure in each configuration, shape (configurations, measures).
    measures : sequence of Measure
    renewals : sequence of Renewal, optional
    initial : int
        Configuration that is there before the first stage.
    most_in_table : int
        Up to so many configurations all pairs are one table.

    Raises
    ------
    PlanError
        Levels do not fit the measures, a renewal lies outside the plan, or there are too many levels.
    """
    _check(levels, measures)
    extra = np.zeros((2, len(stages), len(levels)))
    for renewal in renewals:
        _renew(renewal, stages, levels, *extra)
    if len(levels) <= most_in_table:
        built = _built(stages, levels, measures)
        cost, outlay = (
            table + more[:, np.newaxis, :] for table, more in zip(built, extra, strict=True)
        )
        return Transitions(cost, outlay, initial)
    axes, places = [], []
    for together in _replacing_each_other(measures):
        own, place = np.unique(levels[:, together], axis=0, return_inverse=True)
        of_axis = [_on_axis(measures[m], together) for m in together]
        axes.append(Transitions(*_built(stages, own, of_axis)))
        places.append(place.reshape(-1))
    return LevelTransitions(axes, np.stack(places, axis=1), extra[0], extra[1], initial)


def _built(stages: Stages, levels: Indices, measures: Sequence[Measure]) -> tuple[Array, Array]:
    """What changes of levels are charged and spend, each of the shape (stages, from, to)."""
    shape = (len(stages), len(levels), len(levels))
    cost, outlay = np.zeros(shape), np.zeros(shape)
    for m, measure in enumerate(measures):
        before, after = levels[:, m][:, np.newaxis], levels[:, m][np.newaxis, :]
        price = np.asarray(measure.price, dtype=np.float64)
        rise = np.where(after > before, price[after] - price[before], 0.0)
        stays = (after >= before) | ((after == 0) & _taken_over(m, levels, measures))
        for s in range(len(stages)):
            possible = stays & ((after <= before) | measure.may_be_built(s))
            outlay[s] += rise
            cost[s] += np.where(possible, stages.share(s, measure.lifetime_a) * rise, np.inf)
    return cost, outlay


def _replacing_each_other(measures: Sequence[Measure]) -> list[list[int]]:
    """Measures in groups, of which none takes the place of one in another group."""
    group = list(range(len(measures)))
    for m, measure in enumerate(measures):
        for other in measure.replaces:
            old, new = group[other], group[m]
            group = [new if each == old else each for each in group]
    return [[m for m, each in enumerate(group) if each == g] for g in sorted(set(group))]


def _on_axis(measure: Measure, together: list[int]) -> Measure:
    """A measure that knows others by their numbers among those of its axis."""
    return replace(measure, replaces=tuple(together.index(m) for m in measure.replaces))


def _check(levels: Indices, measures: Sequence[Measure]) -> None:
    if levels.ndim != 2 or levels.shape[1] != len(measures):
        raise PlanError(f"{len(measures)} measures, and levels of the shape {levels.shape}")
    highest = np.array([len(measure.price) - 1 for measure in measures])
    if (levels < 0).any() or (levels > highest).any():
        raise PlanError("a configuration has a level that its measure does not have")


def _taken_over(m: int, levels: Indices, measures: Sequence[Measure]) -> Flags:
    """Where a measure's place is taken by another that is new, shape (from, to)."""
    taken = np.zeros((len(levels), len(levels)), dtype=np.bool_)
    for k, measure in enumerate(measures):
        if m in measure.replaces:
            taken |= (levels[:, k] == 0)[:, np.newaxis] & (levels[:, k] > 0)[np.newaxis, :]
    return taken


def _renew(renewal: Renewal, stages: Stages, levels: Indices, cost: Array, outlay: Array) -> None:
    """Add a renewal to what configurations cost that do not spare it."""
    stage = stages.stage_of(renewal.year)
    if stage is None:
        raise PlanError(f"renewal {renewal.name}: {renewal.year:g} is no year of the plan")
    due = ~(levels[:, list(renewal.unless)] > 0).any(axis=1)
    charged = renewal.cost * stages.share_in(renewal.year, renewal.lifetime_a)
    cost[stage] += np.where(due, charged, 0.0)
    if renewal.in_budget:
        outlay[stage] += np.where(due, renewal.cost, 0.0)
