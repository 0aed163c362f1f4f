r"""A slow, obvious load flow: admittance matrix, and all loads raised together from zero.

It shares nothing with `tpss.powerflow` but the trains' demand and the sources' laws.  With all
voltages V and the admittance matrix Y in per unit, and the share λ of the loads,

    train:                I + λ conj(S(\|V\|) / V) = 0       I = Y V
    node without source:  I = 0
    node with source:     V = f(V, I)

The path of solutions from λ = 0 on is followed by its tangent and corrected by Newton's method.  A step
counts if the correction is small and the tangent goes on in the same direction; where it would turn
back, the branch has turned.  So the path cannot jump to another branch, and its end is that of the load
which the line can carry.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from tpss.powerflow.groups import sections_of
from tpss.powerflow.links import ends_of
from tpss.powerflow.network import Flow, Loads, Network
from tpss.powerflow.outside import find_demands, find_residuals
from tpss.powerflow.shared_grids import NO_SHARED_GRIDS
from tpss.powerflow.system import System

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]

CONVERGED, MOST_ITERATIONS = 1e-9, 8
ROUNDINGS = 4
FIRST_STEP, LARGEST_STEP, SMALLEST_STEP = 0.05, 0.1, 1e-6
LARGEST_CORRECTION = 0.02
SAME_PLACE_M = 1e-9
"""Points of conductors side by side that are closer are one. [m]"""

SLIGHTLY = 1e-6
"""Of base voltage and base current: differences of the sources' laws. [p.u.]"""

CHANGES = SLIGHTLY * np.array([1.0, -1.0, 2.0, -2.0, 1.0j, -1.0j, 2.0j, -2.0j])
"""Forth, back and twice as far, of the real part, then of the imaginary part. [p.u.]"""


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
        stamp(branch.start_node, branch.end_node, branch.admittance_s, 0)  # 0 of one that is out
    for k, (nodes, weights) in enumerate(ends_of(network.links)):
        y[np.ix_(nodes, nodes)] += network.links.admittance_s[k] * np.outer(weights, weights)
    coupled = {s for group in sections_of(network.groups) for s in group}
    for s, (section, found) in enumerate(zip(network.sections, flow.sections, strict=True)):
        before = section.start_node
        for k in range(found.first, found.end + 1):
            last = k == found.end
            length = found.closing_m if last else flow.standing[k].piece_m
            after = section.end_node if last else n + k
            z, b = section.impedance_ohm_per_m * length, section.susceptance_s_per_m * length
            stamp(before, after, 0 if s in coupled else 1 / z, 1j * b)
            before = after
    for group in sections_of(network.groups):
        y += coupled_matrix(group, len(y), network, flow)
    return y


def points_of(s: int, network: Network, flow: Flow) -> list[tuple[float, int]]:
    """Nodes of a section, the trains under it among them, and how far each is from its start. [m]"""
    section, found = network.sections[s], flow.sections[s]
    pieces_m = [*flow.standing["piece_m"][found.first : found.end], found.closing_m]
    trains = range(len(flow.nodes) + found.first, len(flow.nodes) + found.end)
    return list(
        zip(
            np.cumsum([0.0, *pieces_m]).tolist(),
            [int(section.start_node), *trains, int(section.end_node)],
            strict=True,
        )
    )


def coupled_matrix(group: list[int], size: int, network: Network, flow: Flow) -> Complexes:
    """Series admittances of sections side by side, whose currents induce voltages in each other. [S]

    Every conductor has a node at every point of all of them; on a piece between two such points the
    conductors have a matrix of impedances.  Nodes at which nothing is connected are eliminated.
    """
    points = [points_of(s, network, flow) for s in group]
    cuts = sorted(m for each in points for m, _ in each)
    cuts = [m for i, m in enumerate(cuts) if i == 0 or m - cuts[i - 1] > SAME_PLACE_M]
    own = [{_nearest(m, cuts): node for m, node in each} for each in points]
    count, node = size, []
    for each in own:
        last = max(each)
        node.append([each.get(i, count + i) for i in range(last + 1)])
        count += last + 1
    y = np.zeros((count, count), dtype=complex)
    section = network.sections[group[0]]
    for i, (begin_m, end_m) in enumerate(pairwise(cuts)):
        there = [k for k in range(len(group)) if i + 1 < len(node[k])]
        z = np.full((len(there),) * 2, network.groups.mutual_ohm_per_m[group[0]])
        np.fill_diagonal(z, section.impedance_ohm_per_m)
        piece = np.linalg.inv(z * (end_m - begin_m))
        a, b = ([node[k][j] for k in there] for j in (i, i + 1))
        for rows, columns, sign in ((a, a, 1), (b, b, 1), (a, b, -1), (b, a, -1)):
            np.add.at(y, (np.array(rows)[:, None], np.array(columns)[None, :]), sign * piece)
    used = np.flatnonzero(np.abs(y).sum(axis=1) > 0.0)
    inner = used[used >= size]
    outer = np.arange(size)
    if inner.size == 0:
        return y[:size, :size]
    through = np.linalg.solve(y[np.ix_(inner, inner)], y[np.ix_(inner, outer)])
    return np.asarray(y[:size, :size] - y[np.ix_(outer, inner)] @ through)


def _nearest(place_m: float, cuts: list[float]) -> int:
    return int(np.argmin(np.abs(np.array(cuts) - place_m)))


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
    mutual: Complexes
    """Voltage that each source loses over the currents of others that share its grid."""

    @classmethod
    def of(cls, network: Network, flow: Flow, loads: Loads) -> "Equations":
        """Equations of a network with the trains placed in `flow`; stations that are out ask nothing."""
        system = network.system
        base_admittance_s = system.base_power_va / system.base_voltage_v**2
        serves = network.sources["installed"] > 0
        mutual_ohm = np.zeros((serves.size,) * 2, dtype=complex)
        if network.shared != NO_SHARED_GRIDS:
            mutual_ohm = network.shared.mutual_ohm
        return cls(
            admittance=admittance_matrix(network, flow) / base_admittance_s,
            network=network._replace(sources=network.sources[serves]),
            loads=loads,
            standing=flow.standing.copy(),
            running=flow.sources[serves],
            mutual=mutual_ohm[np.ix_(serves, serves)] * base_admittance_s,
        )

    @property
    def system(self) -> System:
        return self.network.system

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
        base_v, base_va = self.system.base_voltage_v, self.system.base_power_va
        magnitude_v = base_v * np.abs(voltage[self.nodes :])
        find_demands(magnitude_v, self.standing, self.loads, found)
        power, slope = found[:, 0] + 1j * found[:, 1], found[:, 2] + 1j * found[:, 3]
        return power / base_va, slope * base_v / base_va

    def law(self, voltage: Complexes, current: Complexes) -> Complexes:
        """Voltages that the sources ask for at their voltages and the currents that they feed.

        Of all sources once, or several times one after another.
        """
        found = np.zeros((voltage.size, 5), dtype=complex)
        base_v, base_va = self.system.base_voltage_v, self.system.base_power_va
        sources, running = self.network.sources, self.running
        if voltage.size != sources.size:
            each = np.arange(voltage.size) % sources.size
            sources, running = sources[each], running[each]
        find_residuals(base_v * voltage, base_va / base_v * current, sources, running, found)
        return voltage - found[:, 0] / base_v

    def residual(self, voltage: Complexes, share: float) -> Complexes:
        """What is left of the equations."""
        current = self.admittance @ voltage
        left = current.copy()
        drawn, _ = self.demand(voltage)
        left[self.nodes :] += share * np.conj(drawn / voltage[self.nodes :])
        at = self.network.sources.node
        left[at] = voltage[at] - self.law(voltage[at], current[at]) + self.mutual @ current[at]
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
        # 2. Sources: V - f(V, Y V), with f by differences.
        at = self.network.sources.node
        (f_v, f_v_conjugate), (f_i, f_i_conjugate) = self._law_slopes(
            voltage[at], self.admittance[at] @ voltage
        )
        for s, node in enumerate(at):
            row = self.admittance[node]
            by_v[node], by_conjugate[node] = -f_i[s] * row, -f_i_conjugate[s] * row.conj()
            by_v[node] += self.mutual[s] @ self.admittance[at]
            by_v[node, node] += 1.0 - f_v[s]
            by_conjugate[node, node] -= f_v_conjugate[s]
        plus, minus, n = by_v + by_conjugate, by_v - by_conjugate, self.buses
        jacobian = np.empty((2 * n, 2 * n))
        jacobian[:n, :n], jacobian[:n, n:] = plus.real, -minus.imag
        jacobian[n:, :n], jacobian[n:, n:] = plus.imag, minus.real
        return jacobian

    def _law_slopes(
        self, voltage: Complexes, current: Complexes
    ) -> tuple[tuple[Complexes, Complexes], tuple[Complexes, Complexes]]:
        """Slopes of the sources' laws over voltages and over currents, and over their conjugates."""
        # All in one call of the laws: they are asked for at every iteration of every point of a path.
        n, changes = voltage.size, np.repeat(CHANGES, voltage.size)
        voltages, currents = np.tile(voltage, 2 * len(CHANGES)), np.tile(current, 2 * len(CHANGES))
        voltages[: changes.size] += changes
        currents[changes.size :] += changes
        found = self.law(voltages, currents).reshape(2, 2, 4, n)

        def slopes(laws: Complexes) -> tuple[Complexes, Complexes]:
            # Through five points: where a load angle has hardly a triangle left, its slope changes fast.
            by_real, by_imaginary = (
                (8 * (forth - back) - farther + farther_back) / (12 * SLIGHTLY)
                for forth, back, farther, farther_back in laws
            )
            return (by_real - 1j * by_imaginary) / 2.0, (by_real + 1j * by_imaginary) / 2.0

        return slopes(found[0]), slopes(found[1])

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
    equations: Equations, most: float = 1.0, highest: float | None = None
) -> tuple[float, Complexes]:
    """Follow the path; return the share of the loads at its end (at `most`), and the voltages there.

    It ends where a voltage leaves the plausible band, whose upper bound is `highest`, by default
    that of the system. [p.u.]
    """
    system = equations.system
    lowest = system.lowest_voltage_v / system.base_voltage_v
    highest = system.highest_voltage_v / system.base_voltage_v if highest is None else highest
    share, step = 0.0, FIRST_STEP
    voltage = equations.correct(np.ones(equations.buses, dtype=complex), 0.0)
    assert voltage is not None, "no solution without load"
    tangent = equations.tangent(voltage, 0.0)
    while share < most and step > SMALLEST_STEP:
        target = min(most, share + step)
        predicted = voltage + (target - share) * tangent
        found = equations.correct(predicted, target)
        if found is not None and _goes_on(found, predicted, lowest, highest):
            following = equations.tangent(found, target)
            if np.vdot(following, tangent).real > 0.0:
                share, voltage, tangent = target, found, following
                step = min(LARGEST_STEP, 1.5 * step)
                continue
        step /= 2.0
    return share, voltage


def _goes_on(found: Complexes, predicted: Complexes, lowest: float, highest: float) -> bool:
    """Whether a corrected point is near to its prediction, and within the plausible band."""
    size = np.abs(found)
    within = size.min() >= lowest and size.max() <= highest
    return bool(within and np.abs(found - predicted).max() < LARGEST_CORRECTION)
