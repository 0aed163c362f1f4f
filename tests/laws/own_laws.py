"""Laws as a package of somebody's own may have them, for tests."""

import math

from tpss.laws import Law, Parameter
from tpss.laws.kinds import CONVERTER, DRIVER, RESISTANCE


def tunnel_resistance_n(speed_m_s, mass_kg, a_n, b_n_s_per_m, c_n_s2_per_m2, factor):
    return a_n + b_n_s_per_m * speed_m_s + factor * c_n_s2_per_m2 * speed_m_s**2


TUNNEL = Law(
    RESISTANCE, "tunnel", tunnel_resistance_n, "A + B v + f C v²", "made up",
    (Parameter("factor", "of the air in a tunnel", default=1.0, least=1.0, most=5.0),),
)  # fmt: skip


def calm_speed_m_s(speed_m_s, limit_m_s, position_m, to_stop_m, share, from_m):
    return share * limit_m_s if to_stop_m < from_m else math.inf


CALM = Law(
    DRIVER, "calm", calm_speed_m_s, "a share of the limit before stops", "made up",
    (
        Parameter("share", "of the limit", least=0.0, most=1.0),
        Parameter("from_m", "distance to the stop from which he is calm", default=4_000.0),
    ),
)  # fmt: skip


def droops(power_w, reactive_power_var, fall_v_per_var, lag_rad_per_w):
    return (
        16_500.0 - fall_v_per_var * reactive_power_var, -lag_rad_per_w * power_w,
        0.0, -fall_v_per_var, -lag_rad_per_w, 0.0,
    )  # fmt: skip


DROOPS = Law(
    CONVERTER, "droops", droops, "linear droops of voltage and angle", "made up",
    (
        Parameter("fall_v_per_var", "fall of the voltage", default=50e-6),
        Parameter("lag_rad_per_w", "lag of the angle", default=3e-8),
    ),
)  # fmt: skip
