"""The driver of the original program: full effort, then coasting, then the brakes.

"The former behavior was aggressive, i.e. the driver accelerated the most he could when the speed was
inferior to the speed limit.  Moreover when the speed was below 5 km/h over the speed limit the driver
coasted.  When it was more than 5 km/h the driver braked to reach the speed limit at the next time
step." [Boullanger2009]_, section 2.3.1.

The driver decides by the speed at the start of a step alone; there is no hysteresis, and a train runs
above its limit as a matter of course.
"""

from tpss.kernel import inlined

COASTING_BAND_M_S = 5.0 / 3.6
"""Speed above the limit up to which the driver coasts. [m/s]"""


@inlined
def aggressive_speed(
    speed_m_s: float, limit_m_s: float, fastest_m_s: float, coasting_m_s: float, slowest_m_s: float
) -> float:
    """Speed after this step that the driver aims at. [m/s]

    Where resistance alone slows a train to its limit, the brakes stay off.  The text sets no limit to
    the brakes; here they give no more than the train's highest retardation, which at the thesis's
    steps (3 s and more) brakes 5 km/h away at once.

    Parameters
    ----------
    speed_m_s, limit_m_s : float
        Speed now, and speed limit. [m/s]
    fastest_m_s, coasting_m_s, slowest_m_s : float
        Highest speed after this step that full effort may give; speed after coasting, and after full
        braking. [m/s]

    References
    ----------
    [Boullanger2009]_, eq. (2.11), section 2.3.1.
    """
    if speed_m_s < limit_m_s:
        return fastest_m_s
    if speed_m_s <= limit_m_s + COASTING_BAND_M_S:
        return coasting_m_s
    return min(coasting_m_s, max(limit_m_s, slowest_m_s))


@inlined
def aggressive_force(
    target_m_s: float, fastest_m_s: float, coasting_m_s: float, ideal_n: float, full_effort_n: float
) -> float:
    """Force at the wheel rim that the driver asks for. [N]

    Full effort and coasting unless something ahead, a lower limit or a stop, has lowered the target;
    then, and with the brakes, the force that gives the target.

    Parameters
    ----------
    target_m_s : float
        Speed after this step, as `aggressive_speed` or what lies ahead has it. [m/s]
    fastest_m_s, coasting_m_s : float
        As in `aggressive_speed`.
    ideal_n, full_effort_n : float
        Force that gives the target, negative with the brakes; and all that the machine can. [N]

    References
    ----------
    [Boullanger2009]_, eq. (2.5), (2.11) and (F.19): motor force 0 or F_motor,max.
    """
    if target_m_s == fastest_m_s:
        return full_effort_n
    return 0.0 if target_m_s == coasting_m_s else ideal_n
