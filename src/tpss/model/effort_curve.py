"""What the machine of a train gives over its speed, and what it takes to move it, outside a run."""

import numpy as np
import numpy.typing as npt

from tpss.kernel import plain
from tpss.model.resistance import resistance_of
from tpss.model.routes import Running
from tpss.model.trains import build_train_types
from tpss.numerics.curve import curve_at
from tpss.numerics.series import SCRATCH_SHAPE
from tpss.physics.adhesion import Rail, adhesion_limit
from tpss.physics.constants import GRAVITY_M_S2
from tpss.scenario.rolling_stock import Train
from tpss.scenario.simulation import Simulation
from tpss.vehicle.demand import FULL_EFFORT_N, update_speed_terms, wheel_force
from tpss.vehicle.terms import Demand

Floats = npt.NDArray[np.float64]


def machine_limit(train: Train, speed_m_s: Floats, voltage_v: float) -> Floats:
    """Highest force at the wheel rim by machine and line current, on level track. [N]"""
    types, points = build_train_types([Running(train)])
    kind, demand, scratch = types[0], Demand.blank(1)[0], np.empty(SCRATCH_SHAPE)
    demand.force_cap_n = demand.adhesion_n = FULL_EFFORT_N
    demand.voltage_v, demand.terms_speed_m_s, demand.free_band_v = voltage_v, -1.0, -1.0
    force, resistance_n = np.empty_like(speed_m_s), level_resistance(train, speed_m_s)
    for k, speed in enumerate(speed_m_s):
        demand.resistance_n = resistance_n[k]
        update_speed_terms(speed, kind, demand, points, scratch)
        force[k], _ = wheel_force(voltage_v, kind, demand, scratch)
    return force


def level_resistance(train: Train, speed_m_s: Floats) -> Floats:
    """Running resistance on level track. [N]"""
    kind = build_train_types([Running(train)])[0][0]
    return np.array([resistance_of(speed, kind) for speed in speed_m_s])


def adhesion(train: Train, speed_m_s: Floats, simulation: Simulation) -> Floats:
    """Force that the rails pass on. [N]"""
    if train.adhesion is not None:
        types, points = build_train_types([Running(train)])
        curve, weight_n = types[0].adhesion, types[0].adhesive_mass_kg * GRAVITY_M_S2
        return np.array(
            [weight_n * plain(curve_at)(v, curve.first, curve.points, points) for v in speed_m_s]
        )
    rail = Rail[simulation.rail.upper()]
    factor = 1.0 if simulation.adhesion_speed_unit == "m/s" else 3.6
    return np.array(
        [plain(adhesion_limit)(train.adhesive_mass_t * 1e3, v * factor, rail) for v in speed_m_s]
    )
