"""Speed regulation: the force that reaches or keeps the speed limit at the next time step.

The thesis's driver applies full effort more than 15 km/h below the limit, without a look at the next
step; with long steps that overshoots.  Here the smaller of the ideal and the highest force is applied
at any speed, which differs only there.
"""

from tpss.kernel import inlined


@inlined
def wanted_acceleration(speed_m_s: float, wanted_m_s: float, step_s: float) -> float:
    r"""Acceleration that brings a train to the wanted speed at the next step. [m/s²]

    .. math:: a_{ideal} = (v_{lim} - v) / h

    Parameters
    ----------
    speed_m_s, wanted_m_s : float
        Speed now, and speed wanted at the next step. [m/s]
    step_s : float
        Time step. [s]

    References
    ----------
    [Boullanger2009]_, section 2.3.1, figure 2-11.
    """
    return (wanted_m_s - speed_m_s) / step_s


@inlined
def ideal_force(acceleration_m_s2: float, resistance_n: float, inertia_kg: float) -> float:
    r"""Force at the wheel rim that gives an acceleration; negative: the brakes give it. [N]

    .. math:: F_{ideal} = a_{ideal} [m_{adh} + (m - m_{adh})(1 + H)] + F_{res}

    Parameters
    ----------
    acceleration_m_s2 : float
        Wanted acceleration. [m/s²]
    resistance_n : float
        Running resistance and gradient force. [N]
    inertia_kg : float
        Mass with rotating parts. [kg]

    References
    ----------
    [Boullanger2009]_, eq. (2.10), (2.25) and (F.20).
    """
    return acceleration_m_s2 * inertia_kg + resistance_n
