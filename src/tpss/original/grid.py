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
    """Grid of a step, its trains being the first `count` of `flow.standing`, placed under sections.

    Every piece between neighbours on the contact line is a π-section of its own.
    """
    fixed, branches = flow.nodes.size, network.branches
    start: list[int] = []
    end: list[int] = []
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
        impedance += [section.impedance_ohm_per_m * length_m for length_m in pieces_m]
        susceptance += [section.susceptance_s_per_m * length_m for length_m in pieces_m]
        last_piece.append(branches.size + len(start) - 1)
    return Grid(
        size=fixed + count,
        start=np.concatenate([branches["start_node"], start]).astype(np.int64),
        end=np.concatenate([branches["end_node"], end]).astype(np.int64),
        admittance_s=np.concatenate([1.0 / branches["impedance_ohm"], 1.0 / np.array(impedance)]),
        half_shunt_s=np.concatenate([np.zeros(branches.size), 0.5j * np.array(susceptance)]),
        first_piece=np.array(first_piece),
        last_piece=np.array(last_piece),
    )
