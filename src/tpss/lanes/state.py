"""Models and states of eight cases as one of lanes, and back.

In lanes the row of a train is its place in the order along the line, whichever train of a case that is:
so the kernels find the trains of all cases in one place.  `join_state` tells whose row it is.
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from tpss.driving.data import Profiles
from tpss.lanes.records import LaneArray, join, new_lanes, words_of
from tpss.numerics.series import SCRATCH_SHAPE
from tpss.powerflow.network import Flow, Network
from tpss.step.model import Model
from tpss.step.state import State
from tpss.vehicle.train import Phase, Train

SAME = frozenset({"*"})
"""Of records of a model: all their whole numbers are the same in all cases."""

OF_TRAIN = frozenset({"train_type", "route", "leg"})
OF_STANDING = frozenset({"train"})


def word_of(dtype: Any, *path: str) -> int:
    """Word of a field of a record, of one within it."""
    offset = 0
    for name in path:
        dtype, inner = dtype.fields[name][:2]
        offset += inner
    return offset // 8


OF_STEPPED = (
    slice(0, word_of(Train.dtype, "passage")),
    slice(word_of(Train.dtype, "allowed_current_a"), None),
)
"""Words of a train, but for its passage, which one that moves in steps has not."""


def join_model(models: Sequence[Model]) -> Model:
    """A model of lanes; what is no number of a record is that of the first case."""
    first = models[0]

    def joined(name: str) -> LaneArray:
        return join([getattr(each, name) for each in models], SAME)

    def profiles(name: str) -> Profiles:
        given = [getattr(each, name) for each in models]
        from_m = join([each.from_m for each in given], fill=math.inf)
        return Profiles(from_m, join([each.value for each in given]))

    staircases = {each: profiles(each) for each in ("gradients", "limits", "neutral", "coasting")}
    records = {each: joined(each) for each in ("stops", "types", "points", "legs")}
    network = _join_network([each.network for each in models])
    changed: Any = {**staircases, **records, "network": network}
    return first._replace(**changed)


def _join_network(networks: Sequence[Network]) -> Network:
    parts = ("sections", "branches", "sources", "admittance_s")
    changed: Any = {name: join([getattr(each, name) for each in networks], SAME) for name in parts}
    return networks[0]._replace(**changed)


def join_state(states: Sequence[State]) -> tuple[State, LaneArray]:
    """A state of lanes, and the numbers of the trains in its rows; -1: there is none."""
    orders = [np.asarray(each.flow.standing["train"]) for each in states]
    rows = max(order.size for order in orders)
    numbers = join([np.append(each, np.full(rows - each.size, -1)) for each in orders])
    trains = new_lanes(Train.dtype, (rows,), OF_TRAIN)
    trains.words[:, word_of(Train.dtype, "motion", "phase")] = Phase.GONE
    # All trains have one type, so rows without one too: kernels read it from the first lane.
    types = np.concatenate([np.asarray(each.trains)["train_type"] for each in states])
    trains.words[:, word_of(Train.dtype, "train_type")] = types.max(initial=0)
    for lane, (each, order) in enumerate(zip(states, orders, strict=True)):
        words = words_of(each.trains)
        for columns in OF_STEPPED:
            trains.words[: order.size, columns, lane] = words[order, columns]
    changed: Any = {
        "trains": trains,
        "scratch": new_lanes(np.float64, SCRATCH_SHAPE),
        "flow": _join_flow([each.flow for each in states]),
        "clock": join([each.clock for each in states]),
    }
    return states[0]._replace(**changed), numbers


def part_trains(trains: LaneArray, numbers: LaneArray, lane: int, target: Any) -> None:
    """Write the trains of one case into its own records."""
    order, words = numbers.words[:, 0, lane], words_of(target)
    known = np.flatnonzero(order >= 0)
    for columns in OF_STEPPED:
        words[order[known], columns] = trains.words[:, columns, lane][known]


def _join_flow(flows: Sequence[Flow]) -> Flow:
    parts = ("nodes", "sections", "sources", "blocks", "sensitivity", "search")
    changed: Any = {name: join([getattr(each, name) for each in flows]) for name in parts}
    changed["standing"] = join([each.standing for each in flows], OF_STANDING)
    rows = changed["standing"].shape[0]
    changed["standing"].words[:, 0] = np.arange(rows)[:, None]
    return flows[0]._replace(**changed)
