r"""Sources that feed from one three-phase grid, each of which feels the currents of the others.

A current J_j that one of them takes from the grid moves its voltages, and so those behind all others,

.. math:: U_k = E_k - Z_{kk} J_k - \sum_{j \ne k} z_{kj} J_j

with what law k asks for without others, and impedances z_kj, complex and not symmetrical, as every
source counts its phasors from its own voltage without load (see `physics.three_phase`).  The solver
takes the same equations the other way round: with Y the inverse of the matrix of all Z,

.. math:: J_k + \sum_j Y_{kj} (U_j - E_j) = 0

is the current balance of a node with constant admittances, which stand among those of the branches.
What works on them stands in `sharing`.

Limits of validity: the laws of sources that share a grid are linear, as that of `sources.grid`.
"""

from collections.abc import Mapping
from typing import NamedTuple, cast

import numpy as np
import numpy.typing as npt

from tpss.record import Records
from tpss.sources.kinds import Source

Complexes = npt.NDArray[np.complex128]
Floats = npt.NDArray[np.float64]


class SharedGrids(NamedTuple):
    """What sources of common grids do to each other; an empty tuple if there are none."""

    mutual_ohm: Complexes
    """Voltage that a source loses over the current of another one, shape (sources, sources): row k is
    the one that loses it; 0 on the diagonal and between sources of different grids. [Ω]"""
    admittance_s: Complexes
    """Inverse of the impedances of those in service, of the same shape; 0 elsewhere. [S]"""


NO_SHARED_GRIDS = cast("SharedGrids", ())


def shared_grids(
    mutual_ohm: Complexes | None, sources: Records[Source], inner_ohm: Floats | None = None
) -> SharedGrids:
    """Common grids from what their sources do to each other, None if there are none.

    Parameters
    ----------
    mutual_ohm : array of complex, shape (sources, sources), or None
        As `SharedGrids.mutual_ohm`. [Ω]
    sources : records of Source
        Those in service have units; all that share a grid are transformer stations.
    inner_ohm : array, shape (sources,), optional
        What of the impedance of each lies between its node and the line already, see `Bundles`; none
        by default. [Ω]
    """
    if mutual_ohm is None:
        return NO_SHARED_GRIDS
    admittance_s = np.zeros_like(mutual_ohm)
    serving = sources["installed"] > 0
    coupled = mutual_ohm.any(axis=0) | mutual_ohm.any(axis=1)
    sharing = np.flatnonzero(serving & coupled)
    if sharing.size:
        among = np.ix_(sharing, sharing)
        laws, units = sources["grid"][sharing], sources["installed"][sharing]
        own_ohm = laws["grid_impedance_ohm"] + laws["transformer_impedance_ohm"] / units
        if inner_ohm is not None:
            own_ohm = own_ohm - inner_ohm[sharing]
        admittance_s[among] = np.linalg.inv(mutual_ohm[among] + np.diag(own_ohm))
    return SharedGrids(mutual_ohm, admittance_s)


def stamp_shared(
    blocks_s: Complexes,
    shared: SharedGrids,
    sources: Records[Source],
    place: Mapping[tuple[int, int], int],
) -> None:
    """Add the admittances of common grids to those of the blocks of the linear system. [S]"""
    if shared == NO_SHARED_GRIDS:
        return
    node = sources["node"].tolist()
    for k, j in zip(*np.nonzero(shared.admittance_s), strict=True):
        block = node[k] if k == j else place[node[k], node[j]]
        blocks_s[block] += shared.admittance_s[k, j]


def edges_of_shared(mutual_ohm: Complexes | None, nodes: list[int]) -> list[tuple[int, int]]:
    """Pairs of nodes that common grids couple, of sources at these nodes.

    They are those of all sources of a grid: two that do nothing to each other do so by a third one.
    """
    if mutual_ohm is None:
        return []
    near = (mutual_ohm != 0.0) | np.eye(len(nodes), dtype=bool)
    coupled = np.linalg.matrix_power(near.astype(float), len(nodes)) > 0.0
    pairs = zip(*np.nonzero(np.triu(coupled, 1)), strict=True)
    return [(nodes[k], nodes[j]) for k, j in pairs]
