"""The network of one step as the thesis has it: nodes, trains included, and an admittance matrix."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tpss.powerflow.groups import sections_of
from tpss.powerflow.network import Flow, Network

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]
Indices = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Grid:
    """Elements between nodes; trains are the nodes after the fixed ones, by position.

    Attributes
    ----------
    size : int
        Number of nodes.
    start, end : Indices
        Nodes of each element: lumped branches first, then pieces of contact line by position.
    admittance_s, half_shunt_s : Complexes
        Series admittance of each element, and the shunt admittance at either end. [S]
    coupled : tuple of (Indices, Complexes)
        Elements that induce voltages in each other, and their admittance matrix; their own series
        admittances in `admittance_s` are 0.
    first_piece, last_piece : Indices
        Elements with which each contact-line section begins and ends.
    """

    size: int
    start: Indices
    end: Indices
    admittance_s: Complexes
    half_shunt_s: Complexes
    first_piece: Indices
    last_piece: Indices
    coupled: tuple[tuple[Indices, Complexes], ...]

    def admittance_matrix(self) -> Complexes:
        """Nodal admittance matrix, dense. [S]"""
        matrix = np.zeros((self.size, self.size), dtype=complex)
        own = self.admittance_s + self.half_shunt_s
        np.add.at(matrix, (self.start, self.start), own)
        np.add.at(matrix, (self.end, self.end), own)
        np.add.at(matrix, (self.start, self.end), -self.admittance_s)
        np.add.at(matrix, (self.end, self.start), -self.admittance_s)
        for elements, between_s in self.coupled:
            a, b = self.start[elements], self.end[elements]
            for rows, columns, sign in ((a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)):
                np.add.at(matrix, (rows[:, None], columns[None, :]), sign * between_s)
        return matrix

    def through_a(self, voltage_v: Complexes) -> Complexes:
        """Current through the series admittance of each element. [A]"""
        drop_v = voltage_v[self.start] - voltage_v[self.end]
        through = self.admittance_s * drop_v
        for elements, between_s in self.coupled:
            through[elements] = between_s @ drop_v[elements]
        return through

    def coupled_losses_w(self, voltage_v: Complexes) -> list[float]:
        """Losses of the coupled elements that belong together. [W]"""
        drop_v, through_a = voltage_v[self.start] - voltage_v[self.end], self.through_a(voltage_v)
        return [float((drop_v[i] @ through_a[i].conj()).real) for i, _ in self.coupled]

    def section_currents_a(self, voltage_v: Complexes) -> tuple[Complexes, Complexes]:
        """Current that enters each section at its start, and that leaves it at its end. [A]"""
        first, last = self.first_piece, self.last_piece
        through = self.through_a(voltage_v)
        entering = through + self.half_shunt_s * voltage_v[self.start]
        leaving = through - self.half_shunt_s * voltage_v[self.end]
        return entering[first], leaving[last]


def lay_out(count: int, network: Network, flow: Flow) -> Grid:
    """Grid of a step, its trains being the first `count` of `flow.standing`, placed under sections.

    Every piece between neighbours on the contact line is a π-section of its own.
    """
    fixed, branches = flow.nodes.size, network.branches
    start: list[int] = []
    end: list[int] = []
    length: list[float] = []
    impedance: list[complex] = []
    susceptance: list[float] = []
    first_piece: list[int] = []
    last_piece: list[int] = []
    for s in range(network.sections.size):
        section, solution = network.sections[s], flow.sections[s]
        trains = [fixed + k for k in range(solution.first, solution.end)]
        points = [section.start_node, *trains, section.end_node]
        pieces_m = [*flow.standing["piece_m"][solution.first : solution.end], solution.closing_m]
        first_piece.append(branches.size + len(start))
        start += points[:-1]
        end += points[1:]
        length += pieces_m
        impedance += [section.impedance_ohm_per_m * length_m for length_m in pieces_m]
        susceptance += [section.susceptance_s_per_m * length_m for length_m in pieces_m]
        last_piece.append(branches.size + len(start) - 1)
    series_s = np.concatenate([1.0 / branches["impedance_ohm"], 1.0 / np.array(impedance)])
    bounds = list(zip(first_piece, last_piece, strict=True))
    coupled = _coupled(bounds, np.concatenate([np.zeros(branches.size), length]), network)
    for elements, _ in coupled:
        series_s[elements] = 0.0
    return Grid(
        size=fixed + count,
        start=np.concatenate([branches["start_node"], start]).astype(np.int64),
        end=np.concatenate([branches["end_node"], end]).astype(np.int64),
        admittance_s=series_s,
        half_shunt_s=np.concatenate([np.zeros(branches.size), 0.5j * np.array(susceptance)]),
        first_piece=np.array(first_piece),
        last_piece=np.array(last_piece),
        coupled=coupled,
    )


def _coupled(
    bounds: Sequence[tuple[int, int]], length_m: Floats, network: Network
) -> tuple[tuple[Indices, Complexes], ...]:
    """Elements of each group of sections side by side, and their admittance matrix. [S]

    Two of them have the impedance in common of the length along which they lie beside each other.

    Parameters
    ----------
    bounds : sequence of (int, int)
        First and last element of each section.
    length_m : Floats
        Length of each element of the grid. [m]
    network : Network
    """
    found: list[tuple[Indices, Complexes]] = []
    for group in sections_of(network.groups):
        section = network.sections[group[0]]
        each = [np.arange(bounds[s][0], bounds[s][1] + 1) for s in group]
        elements = np.concatenate(each)
        ends_m = np.concatenate([np.cumsum(length_m[part]) for part in each])
        begins_m = ends_m - length_m[elements]
        beside_m = np.minimum.outer(ends_m, ends_m) - np.maximum.outer(begins_m, begins_m)
        track = np.repeat(group, [part.size for part in each])
        beside_m[(beside_m < 0.0) | (track[:, None] == track)] = 0.0
        impedance = network.groups.mutual_ohm_per_m[group[0]] * beside_m
        np.fill_diagonal(impedance, section.impedance_ohm_per_m * length_m[elements])
        found.append((elements, np.asarray(np.linalg.inv(impedance), dtype=np.complex128)))
    return tuple(found)
