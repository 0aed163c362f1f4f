"""Bundles in the slow audit: currents of all conductors from their impedance matrix, piece by piece."""

from typing import Any

import numpy as np
import numpy.typing as npt

from tpss.powerflow.bundles import EARTH, NO_BUNDLES
from tpss.powerflow.network import SHORTEST_PIECE_M, UNFED, Network

Complexes = npt.NDArray[np.complex128]


def bundled_sections(network: Network) -> set[int]:
    """Sections that are conductors of bundles."""
    if network.bundles == NO_BUNDLES:
        return set()
    return set(np.flatnonzero(network.bundles.is_bundled).tolist())


def add_bundles(
    section: Any, place_m: Any, volts: Complexes, node_v: Complexes, network: Network,
    drawn_a: Complexes, leaving_a: Complexes,
) -> float:  # fmt: skip
    """Add the currents of bundles at an instant to those of their trains and nodes.

    Conductors that no source reaches have no part in them.  Return the power that goes astray: at a
    train, of the conductors that are none of its own, and between its current and what returns. [VA]
    """
    astray_va = 0.0
    for g, n in enumerate(network.bundles.size):
        sections = network.bundles.section[g, :n]
        starts = network.sections.start_node[sections]
        ends = network.sections.end_node[sections]
        fed = np.flatnonzero(network.source_of_node[starts] != UNFED)
        part = network.sections[sections[0]]
        under = np.flatnonzero(np.isin(section, sections[fed]) & np.isfinite(volts[:, 0]))
        under = under[np.argsort(place_m[under], kind="stable")]
        points_m = [part.start_m, *place_m[under], part.end_m]
        at_points = [node_v[starts], *volts[under, :n], node_v[ends]]
        left = np.zeros((len(points_m), n), dtype=complex)
        z = network.bundles.impedance_ohm_per_m[g][np.ix_(fed, fed)]
        y = network.bundles.shunt_s_per_m[g][:n, :n]
        for k in range(len(points_m) - 1):
            length_m = max(SHORTEST_PIECE_M, points_m[k + 1] - points_m[k])
            drop = (at_points[k] - at_points[k + 1])[fed]
            current = np.linalg.solve(z * length_m, drop)
            left[k, fed] += current
            left[k + 1, fed] -= current
            for end in (k, k + 1):
                left[end] += y @ at_points[end] * (length_m / 2.0)
        np.add.at(leaving_a, starts, left[0])
        np.add.at(leaving_a, ends, left[-1])
        for i, out in zip(under, left[1:-1], strict=True):
            c = int(np.flatnonzero(sections == section[i])[0])
            drawn_a[i] = -out[c]
            rest = out.copy()
            rest[c] = 0.0
            returns = network.bundles.returns[g, c]
            voltage = volts[i, c]
            if returns != EARTH:
                rest[returns] += out[c]
                voltage -= volts[i, returns]
            astray_va = max(astray_va, float(np.abs(voltage * rest).max()))
    return astray_va
