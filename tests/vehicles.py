"""Trains of the short line with a machine of one's own, and their demand, for tests of the vehicle."""

from typing import Any

import numpy as np

from tpss.model.routes import Running
from tpss.model.trains import build_train_types
from tpss.numerics.curve import Points
from tpss.numerics.series import SCRATCH_SHAPE
from tpss.vehicle.demand import update_speed_terms
from tpss.vehicle.terms import Demand
from tpss.vehicle.train_type import TrainType

from scenarios import short_line

SCRATCH = np.zeros(SCRATCH_SHAPE)


def kind_of(**changes: Any) -> tuple[TrainType, Points]:
    """A freight train with some values changed: its record, and the points of its curves."""
    scenario = short_line({f"trains.freight.{name}": value for name, value in changes.items()})
    kinds, points = build_train_types([Running(scenario.trains["freight"])])
    return kinds[0], points


NETWORKS = kind_of()[0].networks
"""The three networks of the Rc4."""


def demand_at(speed_kmh: float, kind: TrainType, points: Points, run=update_speed_terms, **terms):
    """A train at a speed, its terms evaluated; the machine's limit is evaluated at every voltage."""
    demand = Demand.blank(1)[0]
    demand.voltage_v, demand.driven_share = 15e3, 1.0
    for name, value in terms.items():
        demand[name] = value
    demand.terms_speed_m_s = demand.free_band_v = -1.0
    run(speed_kmh / 3.6, kind, demand, points, SCRATCH)
    return demand
