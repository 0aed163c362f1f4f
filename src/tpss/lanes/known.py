"""What lanes cover: the one place that says it.

A rule tells what is so of every case that lanes cover, and which conditions of the kernels that decides.
The conversion leaves out what hangs on these, so a case for which a rule does not hold runs alone.
Numbers that are the same in all cases of a batch stand here too: by them kernels may branch.
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from tpss.api import Prepared
from tpss.driving.data import Braking, MotionModel
from tpss.powerflow.following import FOLLOWS
from tpss.powerflow.network import UNFED, Network
from tpss.sources.kinds import SourceKind
from tpss.step.advance import advance
from tpss.step.separation import Separation
from tpss.vehicle.effort.kinds import EffortKind


def _is_single(network: Network) -> bool:
    """Whether a network has no part that most lack; see `kernel.where_any`."""
    parts: tuple[Any, ...] = (network.groups, network.links, network.bundles, network.shared)
    return all(part == () for part in parts)


class Rule(NamedTuple):
    """Something that is so of every case that lanes cover."""

    words: str
    holds: Callable[[Prepared], bool]
    decides: Mapping[str, bool]
    """Conditions as they stand in kernels, or functions of one, and what they are then."""


def _types(case: Prepared) -> Any:
    return np.asarray(case.start.model.types)


LEAST_STEPS = 300
"""A shorter run takes no longer alone than its case takes to join others, and to part from them."""

RULES = (
    Rule(
        "runs are long enough to be worth it",
        lambda case: (case.start.steps or case.start.capacity) >= LEAST_STEPS,
        {},
    ),
    Rule(
        "trains move in steps",
        lambda case: case.start.model.options.motion == MotionModel.STEPPED,
        {
            "options.motion == MotionModel.CONTINUOUS": False,
            "decision.course == Course.PASSAGE": False,
            "decision.course != Course.PASSAGE": True,
        },
    ),
    Rule(
        # Forces of courses that end within a step are roundings where there is none, and decide by their
        # sign whether a train pulls in a step: figures that count such steps would differ.
        "trains brake in whole steps",
        lambda case: case.start.model.options.braking == Braking.WHOLE_STEPS,
        {"options.braking == Braking.WITHIN_STEP": False, "brakes_within_step": False},
    ),
    Rule(
        "all trains have one type and one route, along one line",
        # There may be types without a train: one that runs down the line has another than one up it.
        lambda case: (
            len({service.train_type for service in case.start.services}) == 1
            and case.start.model.legs.shape == (1, 1)
            and case.start.model.stops.shape[0] == 1
        ),
        {},
    ),
    Rule(
        "trains do not look out for each other",
        lambda case: case.start.model.signalling.separation == Separation.NONE,
        {"signalling.separation != Separation.NONE": False},
    ),
    Rule(
        "trains always have power",
        lambda case: case.start.model.neutral.from_m.shape[1] == 1,
        {"without_power_s.shape[0] > 0": False, "off_s.shape[0] > 0": False},
    ),
    Rule(
        "a network gives the effort of motors, and nothing limits the line current",
        lambda case: bool(
            (_types(case)["effort"]["kind"] == EffortKind.NETWORK).all()
            and np.isinf(_types(case)["line_current"]["highest_current_a"]).all()
        ),
        {
            "effort.kind == EffortKind.NETWORK": True,
            "effort.kind == EffortKind.TABLE": False,
            "effort.kind == EffortKind.LIMITS": False,
            "line_current.highest_current_a < math.inf": False,
        },
    ),
    Rule(
        "no electric brakes, no stores, no efficiency that follows the load",
        lambda case: bool(
            (_types(case)["regeneration"]["highest_force_n"] <= 0.0).all()
            and (_types(case)["over_load"]["count"] == 0).all()
            and not case.start.model.control.has_stores
            and case.start.model.network.stores.size == 0
        ),
        {
            "asks_more": False,
            "has_store": False,
            "control.has_stores": False,
            "stores.size > 0": False,
            "over_load.count > 0": False,
            "works_beyond_loads": False,
            "regeneration.shape[0] > 0": False,
            "on_board.shape[0] > 0": False,
        },
    ),
    Rule(
        "no law of somebody's own, no driver who spares motors",
        lambda case: bool(
            (_types(case)["own_resistance"]["address"] == 0).all()
            and (_types(case)["driver"]["address"] == 0).all()
            and not case.start.model.control.spares_motors
        ),
        {"own_resistance.address != 0": False, "driver.address != 0": False},
    ),
    Rule(
        "every station has converters of one law, and feeds at all times",
        lambda case: bool(
            (np.asarray(case.start.model.network.sources)["kind"] == SourceKind.CONVERTER).all()
            and not case.start.relays
            and not case.start.switchings
        ),
        {
            "source.kind == SourceKind.CONVERTER": True,
            "source.kind == SourceKind.GRID": False,
            "source.kind == SourceKind.MIXED": False,
            "source.kind == SourceKind.BOUNDED": False,
            "source.kind == SourceKind.RECTIFIER": False,
            "source.kind == SourceKind.OWN": False,
        },
    ),
    Rule(
        "conductors are single, and every node is fed and stands for itself",
        lambda case: bool(
            _is_single(case.start.model.network)
            and (case.start.model.network.source_of_node > max(UNFED, FOLLOWS)).all()
        ),
        {
            "s == UNFED": False,
            "source_of_node[at(n)] == UNFED": False,
            "s <= FOLLOWS": False,
            "is_unfed": False,
            "clock[0].unfed > 0": False,
        },
    ),
    Rule(
        "all key figures follow from the figures of steps",
        lambda case: (
            case.frame.rated is None
            and case.frame.apart is None
            and not case.frame.feeds_back
            and not any(side.is_described or side.no_load_w for side in case.frame.sides)
        ),
        {},
    ),
    Rule(
        "the load flow is the usual one",
        lambda case: case.clock is advance and case.start.model.control.fixed_voltage_v <= 0.0,
        {"fixed_voltage_v <= 0.0": True, "fixed_v > 0.0": False},
    ),
)  # fmt: skip
"""What is so of every case that lanes cover."""

DECIDED = {
    "studied >= 0": False,  # the studied train is looked after by `lanes.step`
    **{condition: value for rule in RULES for condition, value in rule.decides.items()},
}
"""Conditions of kernels that are decided, and what they are."""

SAME_PARAMETERS = frozenset({
    "derivatives", "start", "with_slopes", "warm", "step", "step_s", "time_s", "scale", "number", "s",
    "n", "i",
})  # fmt: skip
"""Parameters of kernels that are the same in all cases of a batch."""

SAME_FIELDS = frozenset({
    "size", "shape", "kind", "reactive_model", "voltage_model", "current_model", "profile", "train_type",
    "route", "leg", "place.train", "efficiency.points", "efficiency.first", "adhesion.points",
    "power_factor.points", "curve.points", "curve.first", "start_node", "end_node", "block_aa",
    "block_ab", "block_ba", "block_bb", "node", "upper", "lower", "pivot.first", "pivot.end", "update",
    "controlled", "installed", "line", "once", "tolerance", "options.step_s", "options.mean_power",
    "options.mean_gradient", "options.adhesion_in_km_h", "options.rail",
    "options.driver", "control.studied_train",
})  # fmt: skip
"""Fields of which the same holds, by the last part of what they are fields of where that matters."""

SAME_ARRAYS = frozenset({"is_once", "shape", "source_of_node", "places", "row_start"})
"""Arrays of which the same holds."""


def covers(case: Prepared) -> bool:
    """Whether lanes cover a case."""
    return all(rule.holds(case) for rule in RULES)


def not_covered(case: Prepared) -> list[str]:
    """What is so of all cases that lanes cover, but not of this one; none: it is covered."""
    return [rule.words for rule in RULES if not rule.holds(case)]
