r"""Mismatches of active and reactive power at all nodes, over the unknowns of the original program.

At a node n, with what is generated, consumed and transmitted away,

.. math:: \Delta P_n = P_{G,n} - P_{D,n} - P_n, \quad \Delta Q_n = Q_{G,n} - Q_{D,n} - Q_n .

Unknowns are the angles θ_n and voltages U_n of all nodes, trains included, and the powers P_G and Q_G of
the converter stations.  A train's consumption follows from its voltage (F.5)-(F.28).  The converter law
(2.1)-(2.4), a constraint of the original program, stands beside the mismatches: what it leaves of a
station's voltage and angle is a residual too, and as good as zero at a solution.  All is in per unit of
16.5 kV and 10 MVA, or rad.

References
----------
[Boullanger2009]_, eq. (3.4), (F.35) and (F.36).
"""

from typing import NamedTuple

import numpy as np

from tpss.original.grid import Complexes, Floats, Grid
from tpss.physics.constants import BASE_POWER_VA, BASE_VOLTAGE_V
from tpss.powerflow.external import find_demands, find_terminals
from tpss.powerflow.network import Flow, Loads, Network


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
        self.admittance = grid.admittance_matrix() * (BASE_VOLTAGE_V**2 / BASE_POWER_VA)
        self.size, self.fixed = grid.size, flow.nodes.size
        self.station_node = network.sources.node
        self.demands = np.zeros((self.size - self.fixed, 4))
        self.terminals = np.zeros((self.station_node.size, 5))

    def split(self, x: Floats) -> Unknowns:
        """The unknowns in a vector."""
        stations = self.station_node.size
        return Unknowns(*np.split(x, np.cumsum([self.size, self.size, stations])))

    def demand(self, voltage: Floats) -> tuple[Complexes, Complexes]:
        """P + jQ that the trains draw, and its slope over their voltage. [p.u.]"""
        trains_v = voltage[self.fixed :] * BASE_VOLTAGE_V
        find_demands(trains_v, self.flow.standing, self.loads, self.demands)
        p, q, p_slope, q_slope = self.share * self.demands.T / BASE_POWER_VA
        return p + 1j * q, (p_slope + 1j * q_slope) * BASE_VOLTAGE_V

    def law(self, x: Unknowns) -> Floats:
        """U, θ, dU/dQ, dθ/dP and dθ/dQ of the stations at their powers, a row each. [p.u.], [rad]

        References
        ----------
        [Boullanger2009]_, eq. (2.1)-(2.4).
        """
        power = np.column_stack([x.active, x.reactive]) * BASE_POWER_VA
        find_terminals(power, self.network.sources, self.flow.sources, self.terminals)
        units = [1 / BASE_VOLTAGE_V, 1.0, BASE_POWER_VA / BASE_VOLTAGE_V, *2 * [BASE_POWER_VA]]
        return np.asarray(self.terminals.T * np.array(units)[:, None])

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
        voltage, angle, *_ = self.law(x)
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
        _, _, u_q, theta_p, theta_q = (np.diag(row) for row in self.law(x))
        return np.block(
            [
                [by_angle.real, by_voltage.real, at_station.T, none.T],
                [by_angle.imag, by_voltage.imag, none.T, at_station.T],
                [none, at_station, np.zeros_like(u_q), -u_q],
                [at_station, none, -theta_p, -theta_q],
            ]
        )
