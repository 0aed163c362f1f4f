r"""A slow, obvious load flow: admittance matrix, and all loads raised together from zero.

It shares nothing with `tpss.powerflow` but the trains' demand and the converter law.  With all
voltages V and the admittance matrix Y in per unit, and the share λ of the loads,

    train:                I + λ conj(S(\|V\|) / V) = 0       I = Y V
    node without source:  I = 0
    node with source:     V = f(V conj(I))

The path of solutions from λ = 0 on is followed by its tangent and corrected by Newton's method.  A step
counts if the correction is small and the tangent goes on in the same direction; where it would turn
back, the branch has turned.  So the path cannot jump to another branch, and its end is that of the load
which the line can carry.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from tpss.physics.constants import BASE_POWER_VA, BASE_VOLTAGE_V
from tpss.powerflow.external import find_demands, find_terminals
from tpss.powerflow.network import Flow, Loads, Network
from tpss.powerflow.newton import HIGHEST_VOLTAGE, LOWEST_VOLTAGE

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]

BASE_ADMITTANCE_S = BASE_POWER_VA / BASE_VOLTAGE_V**2
CONVERGED, MOST_ITERATIONS = 1e-9, 8
ROUNDINGS = 4
FIRST_STEP, LARGEST_STEP, SMALLEST_STEP = 0.05, 0.1, 1e-6
LARGEST_CORRECTION = 0.02
SLIGHTLY = 1e-5
"""Of base power: differences of the converter law."""


def admittance_matrix(network: Network, flow: Flow) -> Complexes:
    """Fixed nodes first, then the trains along the line; π-sections between neighbours. [S]"""
    n = network.source_of_node.size
    y = np.zeros((n + flow.standing.size,) * 2, dtype=complex)

    def stamp(i: int, j: int, series: complex, shunt: complex) -> None:
        y[i, i] += series + shunt / 2
        y[j, j] += series + shunt / 2
        y[i, j] -= series
        y[j, i] -= series

    for branch in network.branches:
        stamp(branch.start_node, branch.end_node, 1 / branch.impedance_ohm, 0)
    for section, found in zip(network.sections, flow.sections, strict=True):
        before = section.start_node
        for k in range(found.first, found.end + 1):
            last = k == found.end
            length = found.closing_m if last else flow.standing[k].piece_m
            after = section.end_node if last else n + k
            z, b = section.impedance_ohm_per_m * length, section.susceptance_s_per_m * length
            stamp(before, after, 1 / z, 1j * b)
            before = after
    return y


@dataclass(frozen=True)
class Equations:
    """The equations of a line, in per unit."""

    admittance: Complexes
    network: Network
    loads: Loads
    standing: Any
    """Trains along the line, as in `Flow`."""
    running: Any
    """Converters, as in `Flow.sources`."""

    @classmethod
    def of(cls, network: Network, flow: Flow, loads: Loads) -> "Equations":
        """Equations of a network with the trains placed in `flow`."""
        return cls(
            admittance=admittance_matrix(network, flow) / BASE_ADMITTANCE_S,
            network=network,
            loads=loads,
            standing=flow.standing.copy(),
            running=flow.sources.copy(),
        )

    @property
    def buses(self) -> int:
        return len(self.admittance)

    @property
    def nodes(self) -> int:
        return self.network.source_of_node.size

    @property
    def converged(self) -> float:
        """Mismatch of a solution: over microohms, the rounding of a voltage is a visible one."""
        return max(CONVERGED, ROUNDINGS * np.finfo(float).eps * np.abs(self.admittance).max())

    def demand(self, voltage: Complexes) -> tuple[Complexes, Complexes]:
        """Powers of the trains, and their slopes over the magnitude."""
        found = np.zeros((self.standing.size, 4))
        magnitude_v = BASE_VOLTAGE_V * np.abs(voltage[self.nodes :])
        find_demands(magnitude_v, self.standing, self.loads, found)
        power, slope = found[:, 0] + 1j * found[:, 1], found[:, 2] + 1j * found[:, 3]
        return power / BASE_POWER_VA, slope * BASE_VOLTAGE_V / BASE_POWER_VA

    def law(self, power: Complexes) -> Complexes:
        """Voltages of the sources by their powers."""
        found = np.zeros((power.size, 5))
        powers = BASE_POWER_VA * np.column_stack([power.real, power.imag])
        find_terminals(powers, self.network.sources, self.running, found)
        return found[:, 0] * np.exp(1j * found[:, 1]) / BASE_VOLTAGE_V

    def residual(self, voltage: Complexes, share: float) -> Complexes:
        """What is left of the equations."""
        current = self.admittance @ voltage
        left = current.copy()
        drawn, _ = self.demand(voltage)
        left[self.nodes :] += share * np.conj(drawn / voltage[self.nodes :])
        at = self.network.sources.node
        left[at] = voltage[at] - self.law(voltage[at] * np.conj(current[at]))
        return left

    def jacobian(self, voltage: Complexes, share: float) -> Floats:
        """Derivatives of real parts, then imaginary parts, over real parts, then imaginary parts."""
        by_v, by_conjugate = self.admittance.copy(), np.zeros_like(self.admittance)
        # 1. Trains: conj(S / V) over V and conj(V).
        trains, at_train = np.arange(self.nodes, self.buses), voltage[self.nodes :]
        drawn, slope = self.demand(voltage)
        half = share * np.conj(slope) / (2.0 * np.abs(at_train))
        by_v[trains, trains] += half
        by_conjugate[trains, trains] += (
            half * at_train - share * np.conj(drawn) / at_train.conj()
        ) / at_train.conj()
        # 2. Sources: V - f(S), S = V conj(Y V), with f by differences.
        for s, node in enumerate(self.network.sources.node):
            row = self.admittance[node]
            power = voltage * 0.0
            current = row @ voltage
            power_by_v, power_by_conjugate = power.copy(), voltage[node] * row.conj()
            power_by_v[node] = current.conj()
            f_p, f_q = self._law_slopes(s, voltage[node] * current.conj())
            f_s, f_conjugate = (f_p - 1j * f_q) / 2.0, (f_p + 1j * f_q) / 2.0
            by_v[node] = -(f_s * power_by_v + f_conjugate * power_by_conjugate.conj())
            by_v[node, node] += 1.0
            by_conjugate[node] = -(f_s * power_by_conjugate + f_conjugate * power_by_v.conj())
        plus, minus = by_v + by_conjugate, by_v - by_conjugate
        return np.block([[plus.real, -minus.imag], [plus.imag, minus.real]])

    def _law_slopes(self, s: int, power: complex) -> tuple[complex, complex]:
        """Slopes of a source's voltage over P and Q."""
        powers = np.zeros((4, self.network.sources.size), dtype=complex)
        powers[:, s] = power + SLIGHTLY * np.array([1.0, -1.0, 1j, -1j])
        up_p, down_p, up_q, down_q = (self.law(row)[s] for row in powers)
        return (up_p - down_p) / (2 * SLIGHTLY), (up_q - down_q) / (2 * SLIGHTLY)

    def correct(self, voltage: Complexes, share: float) -> Complexes | None:
        """Newton's method without damping; None if it does not converge."""
        for _ in range(MOST_ITERATIONS):
            with np.errstate(all="ignore"):  # far off, it may divide by nothing
                left = self.residual(voltage, share)
            if not np.isfinite(left).all():
                return None
            if np.abs(left).max() < self.converged:
                return voltage
            voltage = voltage - self._solve(voltage, share, left)
        return None

    def tangent(self, voltage: Complexes, share: float) -> Complexes:
        """dV/dλ of the path."""
        drawn, _ = self.demand(voltage)
        by_share = np.zeros(self.buses, dtype=complex)
        by_share[self.nodes :] = np.conj(drawn / voltage[self.nodes :])
        return -self._solve(voltage, share, by_share)

    def _solve(self, voltage: Complexes, share: float, right: Complexes) -> Complexes:
        found = np.linalg.solve(
            self.jacobian(voltage, share), np.concatenate([right.real, right.imag])
        )
        return found[: self.buses] + 1j * found[self.buses :]


def carry(
    equations: Equations, most: float = 1.0, highest: float = HIGHEST_VOLTAGE
) -> tuple[float, Complexes]:
    """Follow the path; return the share of the loads at its end (at `most`), and the voltages there.

    It ends where a voltage leaves the plausible band, whose upper bound is `highest`. [p.u.]
    """
    share, step = 0.0, FIRST_STEP
    voltage = equations.correct(np.ones(equations.buses, dtype=complex), 0.0)
    assert voltage is not None, "no solution without load"
    tangent = equations.tangent(voltage, 0.0)
    while share < most and step > SMALLEST_STEP:
        target = min(most, share + step)
        predicted = voltage + (target - share) * tangent
        found = equations.correct(predicted, target)
        if found is not None and _goes_on(found, predicted, highest):
            following = equations.tangent(found, target)
            if np.vdot(following, tangent).real > 0.0:
                share, voltage, tangent = target, found, following
                step = min(LARGEST_STEP, 1.5 * step)
                continue
        step /= 2.0
    return share, voltage


def _goes_on(found: Complexes, predicted: Complexes, highest: float) -> bool:
    """Whether a corrected point is near to its prediction, and within the plausible band."""
    size = np.abs(found)
    within = size.min() >= LOWEST_VOLTAGE and size.max() <= highest
    return bool(within and np.abs(found - predicted).max() < LARGEST_CORRECTION)
