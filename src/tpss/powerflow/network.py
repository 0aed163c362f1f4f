"""The supply network as records: fixed nodes, lumped branches, contact-line sections, sources.

Constant parts stand in a `Network`, what a solution finds in a `Flow`.  Records keep what belongs to
one node or section together; to compiled code an array of them is one argument.
"""

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.kernel import blank_records, records
from tpss.physics.constants import BASE_POWER_VA, BASE_VOLTAGE_V
from tpss.physics.converter import CONVERTER_LAW
from tpss.powerflow.block_lu import Pattern, find_pattern

Complexes = npt.NDArray[np.complex128]
Indices = npt.NDArray[np.int64]

TOLERANCE = 1e-10
"""Largest mismatch of a solution, in per unit of base power or base voltage."""

SHORTEST_PIECE_M = 1.0
"""Trains closer than this to each other or to a node count as this far away. [m]"""

EPSILON = float(np.finfo(float).eps)

SECTION = np.dtype(
    [
        ("start_node", np.int64),
        ("end_node", np.int64),
        ("start_m", float),
        ("end_m", float),
        ("impedance_ohm_per_m", complex),
        ("susceptance_s_per_m", float),
        ("block_aa", np.int64),  # places of its blocks: a is the start node, b the end node
        ("block_ab", np.int64),
        ("block_ba", np.int64),
        ("block_bb", np.int64),
        ("gap_weight", float),  # square of the power at its ends that a gap causes, both per unit
    ],
    align=True,
)
"""A stretch of contact line between two fixed nodes, from its smaller to its larger position."""

BRANCH = np.dtype(
    [
        ("start_node", np.int64),
        ("end_node", np.int64),
        ("impedance_ohm", complex),
        ("admittance_s", complex),
    ],
    align=True,
)
"""A lumped impedance."""

SOURCE = np.dtype(
    [
        ("node", np.int64),
        *((name, CONVERTER_LAW[name]) for name in CONVERTER_LAW.names or ()),
        ("installed", np.int64),
        ("controlled", np.bool_),  # whether the number of running converters follows the loading
        ("rating_va", float),  # of one converter
    ],
    align=True,
)
"""A converter station at a fixed node."""

NODE_FLOW = np.dtype(
    [
        ("voltage_v", complex),
        ("leaving_current_a", complex),  # into sections and branches
        ("right_side", complex),  # of the linear system, then its solution
        ("base_v", complex),  # where a Newton step starts
        ("direction_v", complex),  # the whole step
        ("good_v", complex),  # of the last solution that is known to be good
        ("last_v", complex),  # of the last time step, and of the one before
        ("before_v", complex),
    ],
    align=True,
)

SECTION_FLOW = np.dtype(
    [
        ("current_a", complex),  # enters the section at its start
        ("end_current_a", complex),  # leaves it at its end
        ("gap_v", complex),  # between the end of the chain and the end node
        ("inverse_p", complex),  # pair that gives a change of the entering current
        ("inverse_q", complex),
        ("transfer_p", complex),  # pair by which the end voltage follows the start voltage
        ("transfer_q", complex),
        ("base_a", complex),
        ("direction_a", complex),
        ("good_a", complex),
        ("last_a", complex),
        ("before_a", complex),
        ("first", np.int64),  # bounds of its trains in `Flow.standing`
        ("end", np.int64),
        ("closing_m", float),  # line between its last train and its end node
    ],
    align=True,
)

SOURCE_FLOW = np.dtype(
    [
        ("converters", float),  # number of converters that run
        ("loading_sum", float),  # over the steps since the last action of the converter control
    ],
    align=True,
)

BLOCK = np.dtype([("p", complex), ("q", complex)], align=True)
"""A block of the linear system, as a pair."""

STANDING = np.dtype(
    [
        ("train", np.int64),
        ("piece_m", float),  # line between the train and the train or node before it
        ("voltage_v", complex),
    ],
    align=True,
)
"""A train's place in the order along the line."""


class Network(NamedTuple):
    """A supply network; all impedances are referred to the contact line's voltage."""

    sections: Any
    """Records of `SECTION`, by position."""
    branches: Any
    """Records of `BRANCH`."""
    sources: Any
    """Records of `SOURCE`."""
    source_of_node: Indices
    """Index of the source at each node, or -1."""
    pattern: Pattern
    admittance_s: Complexes
    """What the branches put into each block of the linear system. [S]"""
    tolerance: float
    """Largest mismatch of a solution, in per unit of base power or base voltage."""


class Flow(NamedTuple):
    """State of a load flow, and scratch; the unknowns are node voltages and entering currents."""

    nodes: Any
    """Records of `NODE_FLOW`."""
    sections: Any
    """Records of `SECTION_FLOW`."""
    standing: Any
    """Records of `STANDING`: trains on the line by position, then the others in any order."""
    sources: Any
    """Records of `SOURCE_FLOW`."""
    blocks: Any
    """Records of `BLOCK`."""
    sensitivity: Complexes
    """Of a chain's voltage and current to its start voltage and current, shape (2, 2, 2)."""


class Loads(NamedTuple):
    """The trains, as far as the load flow is concerned."""

    trains: Any
    """Records with the fields of `DEMAND`, and `train_type`."""
    types: Any
    """Records of `TRAIN_TYPE`."""
    machine: Any
    """One record of `MACHINE`."""


def resolution_va(impedance_ohm: float) -> float:
    """Power mismatch that the rounding of voltages causes at the ends of an impedance. [VA]

    A voltage is known to 2⁻⁵² of itself, so the current through an impedance z, and with it the power,
    to a few 2⁻⁵² V²/z: a tenth of a volt-ampere over a microohm.
    """
    return float(4.0 * EPSILON * BASE_VOLTAGE_V**2 / impedance_ohm)


def gap_weight(start_m: float, end_m: float, impedance_ohm_per_m: complex) -> float:
    """Square of the power that a gap of the base voltage causes at a section's ends. [p.u.]"""
    impedance_ohm = abs(impedance_ohm_per_m) * max(SHORTEST_PIECE_M, end_m - start_m)
    return float((BASE_VOLTAGE_V**2 / impedance_ohm / BASE_POWER_VA) ** 2)


_pattern = lru_cache(maxsize=64)(find_pattern)
"""Patterns by the edges of networks, which share them; nobody changes one."""


def assemble(
    n_nodes: int,
    sections: list[tuple[int, int, float, float, complex, float]],
    branches: list[tuple[int, int, complex]],
    sources: Any,
) -> Network:
    """Network from its parts.

    Parameters
    ----------
    n_nodes : int
        Number of fixed nodes.
    sections : list of (start node, end node, start_m, end_m, impedance_ohm_per_m, susceptance_s_per_m)
    branches : list of (start node, end node, impedance_ohm)
    sources : records of `SOURCE`
        At most one a node.
    """
    ends = [(a, b) for a, b, *_ in sections] + [(a, b) for a, b, _ in branches]
    pattern, place = _pattern(n_nodes, tuple(ends))
    impedances = [abs(z) for *_, z in branches]
    impedances += [abs(z) * max(SHORTEST_PIECE_M, b - a) for _, _, a, b, z, _ in sections]
    rounding = max(map(resolution_va, impedances)) / BASE_POWER_VA
    source_of_node = np.full(n_nodes, -1, dtype=np.int64)
    source_of_node[sources["node"]] = np.arange(sources.size)

    def blocks(a: int, b: int) -> tuple[int, int, int, int]:
        return place[a, a], place[a, b], place[b, a], place[b, b]

    admittance_s = np.zeros(len(place), dtype=complex)
    for a, b, z in branches:
        admittance_s[list(blocks(a, b))] += np.array([1.0, -1.0, -1.0, 1.0]) / z

    return Network(
        sections=records(
            [(*each, *blocks(*each[:2]), gap_weight(*each[2:5])) for each in sections], SECTION
        ),
        branches=records([(a, b, z, 1.0 / z) for a, b, z in branches], BRANCH),
        sources=sources,
        source_of_node=source_of_node,
        pattern=pattern,
        admittance_s=admittance_s,
        tolerance=max(TOLERANCE, rounding),
    )


def new_flow(network: Network, n_trains: int) -> Flow:
    """State of a load flow with room for `n_trains`, all converters running."""
    flow = Flow(
        nodes=blank_records(network.source_of_node.size, NODE_FLOW),
        sections=blank_records(network.sections.size, SECTION_FLOW),
        standing=blank_records(n_trains, STANDING),
        sources=blank_records(network.sources.size, SOURCE_FLOW),
        blocks=blank_records(network.admittance_s.size, BLOCK),
        sensitivity=np.zeros((2, 2, 2), dtype=complex),
    )
    flow.sources["converters"] = network.sources["installed"]
    flow.standing["train"] = np.arange(n_trains)
    return flow
