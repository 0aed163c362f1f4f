"""The mean future of a plan: what someone would plan for who knows the means only.

Prices are the means of each stage.  Mean traffic is simulated nowhere, so that of a stage is the state
of the plan whose trains are nearest to the mean numbers: it was simulated with every configuration.
Where states differ in more than numbers of trains there is no mean, and none is made up.
"""

from dataclasses import dataclass, replace

import numpy as np

from tpss.planning.money import Array
from tpss.planning.served import beside_trains
from tpss.planning.solve import Model, price_of_node
from tpss.planning.tree import Indices
from tpss.planning.yearly_use import trains_of


@dataclass(frozen=True)
class MeanFuture:
    """Means of what may come, as far as they are among what was simulated."""

    states: tuple[Indices, ...]
    """State of each stage, for each area of the shape (stages,)."""
    yearly_cost: tuple[Array, ...]
    """Cost a year, for each area of the shape (stages, configurations)."""


def mean_future_of(model: Model) -> MeanFuture | None:
    """The mean future of a plan.

    None if there is one future only, if some costs are bounds, or if states of traffic differ in more
    than numbers of trains.
    """
    if len(model.tree.names) < 2 or model.has_bounds:
        return None
    means = [_nearest_states(model, number) for number in range(len(model.areas))]
    states = tuple(each for each in means if each is not None)
    if len(states) < len(means):
        return None
    prices = _means(model, price_of_node(model.plan, model.tree))
    costs = tuple(
        replace(served.quantities, state_of_node=own).priced(prices).yearly_cost
        for served, own in zip(model.served, states, strict=True)
    )
    return MeanFuture(states, costs)


def _means(model: Model, of_node: Array) -> Array:
    """Expected values in each stage, shape (stages, ...), of those in each node."""
    of_scenario: Array = of_node[model.tree.node_of]
    return np.asarray(np.einsum("w,ws...->s...", model.tree.scenario_probability, of_scenario))


def _nearest_states(model: Model, number: int) -> Indices | None:
    """State of each stage whose trains are nearest to the mean ones; the first of equal ones."""
    area = model.areas[number]
    if any(beside_trains(s) != beside_trains(area.states.states[0]) for s in area.states.states):
        return None
    trains = [trains_of(model.case_list, number, d) for d in range(len(area.states.states))]
    services = list(dict.fromkeys(name for each in trains for name in each))
    per_h = np.array(
        [[each[name].per_h if name in each else 0.0 for name in services] for each in trains]
    )
    mean = _means(model, per_h[model.served[number].quantities.state_of_node])
    away = np.abs(mean[:, np.newaxis, :] - per_h).sum(axis=2)
    return np.asarray(away.argmin(axis=1))
