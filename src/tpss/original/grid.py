"""The network of one step as the thesis has it: nodes, trains included, and an admittance matrix."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

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

    def admittance_matrix(self) -> Complexes:
        """Nodal admittance matrix, dense. [S]"""
        matrix = np.zeros((self.size, self.size), dtype=complex)
        own = self.admittance_s + self.half_shunt_s
        np.add.at(matrix, (self.start, self.start), own)
        np.add.at(matrix, (self.end, self.end), own)
        np.add.at(matrix, (self.start, self.end), -self.admittance_s)
        np.add.at(matrix, (self.end, self.start), -self.admittance_s)
        return matrix

    def section_currents_a(self, voltage_v: Complexes) -> tuple[Complexes, Complexes]:
        """Current that enters each section at its start, and that leaves it at its end. [A]"""
        first, last = self.first_piece, self.last_piece
        through = self.admittance_s * (voltage_v[self.start] - voltage_v[self.end])
        entering = through + self.half_shunt_s * voltage_v[self.start]
        leaving = through - self.half_shunt_s * voltage_v[self.end]
        return entering[first], leaving[last]


def lay_out(count: int, network: Network, flow: Flow) -> Grid:
    """Grid of a step, its trains being the first `count` of `flow.standing`, placed on sections.

    Every piece between neighbours on the contact line is a π-section of its own.
    """
    fixed, sections, found = flow.nodes.size, network.sections, flow.sections
    pieces = found.end - found.first + 1
    last = np.cumsum(pieces) - 1
    first = last - pieces + 1
    # Along the line trains follow each other, interrupted by the sections' end nodes.
    length_m = np.insert(flow.standing.piece_m[:count], found.end, found.closing_m)
    end = np.insert(fixed + np.arange(count), found.end, sections.end_node)
    start = np.roll(end, 1)
    start[first] = sections.start_node
    impedance = np.repeat(sections.impedance_ohm_per_m, pieces) * length_m
    susceptance = np.repeat(sections.susceptance_s_per_m, pieces) * length_m
    branches = network.branches
    return Grid(
        size=fixed + count,
        start=np.concatenate([branches.start_node, start]),
        end=np.concatenate([branches.end_node, end]),
        admittance_s=np.concatenate([1.0 / branches.impedance_ohm, 1.0 / impedance]),
        half_shunt_s=np.concatenate([np.zeros(branches.size), 0.5j * susceptance]),
        first_piece=branches.size + first,
        last_piece=branches.size + last,
    )
