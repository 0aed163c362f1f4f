r"""Mismatches of active and reactive power at all nodes, over the unknowns of the original program.

At a node n, with what is generated, consumed and transmitted away,

.. math:: \Delta P_n = P_{G,n} - P_{D,n} - P_n, \quad \Delta Q_n = Q_{G,n} - Q_{D,n} - Q_n .

Unknowns are the angles θ_n and voltages U_n of all nodes, trains included, and the powers P_G and Q_G of
the converter stations.  A train's consumption follows from its voltage (F.5)-(F.28).  The converter law
(2.1)-(2.4), a constraint of the original program, stands beside the mismatches: what it leaves of a
station's voltage and angle is a residual too, zero at a solution but for rounding.  All is in per unit
of the base voltage and the base power, or rad.

References
----------
[Boullanger2009]_, eq. (3.4), (F.35) and (F.36).
"""

from typing import NamedTuple

import numpy as np

from tpss.original.grid import Complexes, Floats, Grid
from tpss.powerflow.network import Flow, Loads, Network
from tpss.powerflow.outside import find_demands, find_residuals


class Unknowns(NamedTuple):
    """The unknowns of a step by their meaning."""

    angle: Floats
    voltage: Floats
    active: Floats
    """Power fed by each station."""
    reactive: Floats

    @property
    def phasor(self) -> Complexes:
        """Voltages as complex numbers. [p.u.]"""
        return np.asarray(self.voltage * np.exp(1j * self.angle))


class Mismatch:
    """Mismatches of one step at a share of all loads, and their derivatives.

    Parameters
    ----------
    grid : Grid
    network : Network
    flow : Flow
        Gives the order of the trains and the converters that run.
    loads : Loads
    share : float
        Factor on all loads. [1]
    """

    def __init__(
        self, grid: Grid, network: Network, flow: Flow, loads: Loads, share: float
    ) -> None:
        self.network, self.flow, self.loads, self.share = network, flow, loads, share
        self.base_v, self.base_va = network.system.base_voltage_v, network.system.base_power_va
        self.admittance = grid.admittance_matrix() * (self.base_v**2 / self.base_va)
        self.size, self.fixed = grid.size, flow.nodes.size
        self.station_node = network.sources["node"]
        self.demands = np.zeros((self.size - self.fixed, 4))
        self.laws = np.zeros((self.station_node.size, 5), dtype=complex)

    def split(self, x: Floats) -> Unknowns:
        """The unknowns in a vector."""
        stations = self.station_node.size
        return Unknowns(*np.split(x, np.cumsum([self.size, self.size, stations])))

    def demand(self, voltage: Floats) -> tuple[Complexes, Complexes]:
        """P + jQ that the trains draw, and its slope over their voltage. [p.u.]"""
        trains_v = voltage[self.fixed :] * self.base_v
        find_demands(trains_v, self.flow.standing, self.loads, self.demands)
        p, q, p_slope, q_slope = self.share * self.demands.T / self.base_va
        return p + 1j * q, (p_slope + 1j * q_slope) * self.base_v

    def law(self, x: Unknowns) -> tuple[Floats, Floats]:
        """Voltage and angle that the stations' laws ask for, and their derivatives. [p.u.], [rad]

        Returns
        -------
        asked : Floats, shape (2, stations)
            Voltage, then angle.
        derivatives : Floats, shape (2, 4, stations)
            Over angle, voltage, active and reactive power of the own node.
        """
        volts = x.phasor[self.station_node] * self.base_v
        amperes = ((x.active + 1j * x.reactive) * self.base_va / volts).conj()
        find_residuals(volts, amperes, self.network.sources, self.flow.sources, self.laws)
        residual, v_p, v_q, j_p, j_q = self.laws.T
        unit = volts / np.abs(volts) * self.base_v
        zero = np.zeros_like(volts)
        changes = [  # of voltage and current, by each of the four
            (1j * volts, 1j * amperes),
            (unit, -amperes * self.base_v / np.abs(volts)),
            (zero, self.base_va / volts.conj()),
            (zero, -1j * self.base_va / volts.conj()),
        ]
        asked = volts - residual
        relative = np.array(
            [
                (dv - (v_p * dv + v_q * dv.conj() + j_p * dj + j_q * dj.conj())) / asked
                for dv, dj in changes
            ]
        )
        size = np.abs(asked) / self.base_v
        return np.array([size, np.angle(asked)]), np.array([size * relative.real, relative.imag])

    def residuals(self, vector: Floats) -> Floats:
        """ΔP and ΔQ at all nodes, then the gaps of the stations' voltages and angles.

        References
        ----------
        [Boullanger2009]_, eq. (3.4).
        """
        x = self.split(vector)
        mismatch = -x.phasor * (self.admittance @ x.phasor).conj()
        mismatch[self.fixed :] -= self.demand(x.voltage)[0]
        mismatch[self.station_node] += x.active + 1j * x.reactive
        (voltage, angle), _ = self.law(x)
        gaps = x.voltage[self.station_node] - voltage, x.angle[self.station_node] - angle
        return np.concatenate([mismatch.real, mismatch.imag, *gaps])

    def jacobian(self, vector: Floats) -> Floats:
        """Derivatives of the residuals, a row each."""
        x = self.split(vector)
        own = np.diag(x.phasor * (self.admittance @ x.phasor).conj())
        mutual = x.phasor[:, None] * (self.admittance * x.phasor).conj()
        by_angle, by_voltage = -1j * (own - mutual), -(own + mutual) / x.voltage
        trains = np.arange(self.fixed, self.size)
        by_voltage[trains, trains] -= self.demand(x.voltage)[1]
        at_station = np.eye(self.size)[self.station_node]
        none = np.zeros_like(at_station)
        _, derivatives = self.law(x)
        (u_theta, u_u, u_p, u_q), (theta_theta, theta_u, theta_p, theta_q) = (
            [np.diag(row) for row in rows] for rows in derivatives
        )
        return np.block(
            [
                [by_angle.real, by_voltage.real, at_station.T, none.T],
                [by_angle.imag, by_voltage.imag, none.T, at_station.T],
                [-u_theta @ at_station, at_station - u_u @ at_station, -u_p, -u_q],
                [at_station - theta_theta @ at_station, -theta_u @ at_station, -theta_p, -theta_q],
            ]
        )
