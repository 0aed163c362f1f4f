"""Bundles: stretches of line of several conductors, such as contact line, rails and feeder, as arrays.

Every conductor of a bundle is a section of the network, from its start node to its end node, and all of
them begin at one place and end at one place.  Trains stand under those that are contact lines, and their
current returns to another conductor.  What is constant stands in `Bundles`; what a solution finds, and
scratch, in `BundleFlow`.  The equations are those of `bundle`.
"""

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import NamedTuple, cast

import numpy as np
import numpy.typing as npt

from tpss.record import Record, Records

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]
Indices = npt.NDArray[np.int64]
Flags = npt.NDArray[np.bool_]

EARTH = -1
"""In place of the conductor to which trains return: the earth."""


class BundlePart(NamedTuple):
    """A bundle as it is given to `assembly.assemble`."""

    sections: tuple[int, ...]
    """Number of the section of each conductor."""
    returns: tuple[int, ...]
    """Conductor to which trains under each of them return; `EARTH`: to none of them."""
    impedance_ohm_per_m: Complexes
    """Series impedance, shape (conductors, conductors). [Ω/m]"""
    admittance_s_per_m: Complexes
    """Shunt admittance to each other and to earth, of the same shape. [S/m]"""


class Bundles(NamedTuple):
    """All bundles of a network; those of fewer conductors than the widest one leave places unused.

    A network without any has an empty tuple in its place, see `kernel.where_any`.
    """

    is_bundled: Flags
    """Whether each section of the network is a conductor of a bundle."""
    size: Indices
    """Number of conductors of each bundle."""
    section: Indices
    """Sections of each bundle, shape (bundles, widest)."""
    returns: Indices
    """Conductors to which trains return, of the same shape."""
    impedance_ohm_per_m: Complexes
    """Series impedance, shape (bundles, widest, widest). [Ω/m]"""
    series_s_m: Complexes
    """Its inverse, in which conductors that no source reaches have no part. [S m]"""
    shunt_s_per_m: Complexes
    """Shunt admittance, as the impedance. [S/m]"""
    place: Indices
    """Places of the blocks of each bundle, shape (bundles, 2 widest, 2 widest): rows and columns are the
    start nodes of its conductors, then their end nodes."""
    flat_pu: Floats
    """Voltage of each node of the network without load, over the base voltage. [1]"""
    inner_ohm: Floats
    """Resistance between the node of each source and its terminals. [Ω]"""


class Point(Record):
    """A train under a bundle."""

    standing: int
    """Its place in `Flow.standing`."""
    conductor: int
    """Conductor under which it stands."""
    piece_m: float
    """Line between the train and the point before it. [m]"""


class BundleFlow(NamedTuple):
    """State of the bundles, and scratch; an empty tuple if there are none.

    Voltages are those of all conductors at each train, shape (trains, widest).
    """

    voltage_v: Complexes
    base_v: Complexes
    """Where a Newton step starts. [V]"""
    direction_v: Complexes
    """The whole step. [V]"""
    good_v: Complexes
    """At the last good point of a path of solutions. [V]"""
    passed_v: Complexes
    """At the point before that. [V]"""
    aside_v: Complexes
    """Of a solution that is put aside while another one is looked for. [V]"""
    last_v: Complexes
    """Of the last time step. [V]"""
    before_v: Complexes
    """Of the one before. [V]"""
    known: Indices
    """Time steps of which the voltages at each train are known, at most two."""
    is_under: Flags
    """Whether each train stands under a bundle."""
    points: Records[Point]
    """Trains under bundles, by bundle and place."""
    first: Indices
    """Where those of each bundle begin, and where the last ones end."""
    closing_m: Floats
    """Line between the last train and the end of each bundle. [m]"""
    next: Indices
    """Next train under each conductor, while they are put in order."""
    solved: Complexes
    """What is left of the equations of each point, shape (trains, widest, 2 widest + 1, 2): a pair each,
    over the start nodes and the point ahead, and the right side."""
    rows: Complexes
    """Equations of the train that is being eliminated, shape (widest, 3 widest + 1, 2)."""
    ahead: Complexes
    """What the start nodes see of the point ahead, shape (2, widest, widest, 2): now, and behind it."""
    rest_a: Complexes
    """Currents that leave each conductor at each point, shape (trains, widest): 0 at a solution. [A]"""
    pair_s: Complexes
    """Derivative of the current of the train at each point, as a pair, shape (trains, 2). [S]"""
    drop_v: Complexes
    """Voltages along a piece, shape (widest,). [V]"""
    lost_w: Floats
    """Losses of each bundle. [W]"""


NO_BUNDLES, NO_BUNDLE_FLOW = cast("Bundles", ()), cast("BundleFlow", ())


def widest_of(bundles: Bundles) -> int:
    """Most conductors of a bundle; 0: there are no bundles."""
    return 0 if bundles == NO_BUNDLES else bundles.section.shape[1]


def edges_of_bundles(
    parts: Sequence[BundlePart], sections: Sequence[tuple[int, int]]
) -> list[tuple[int, int]]:
    """Pairs of nodes that bundles couple; `sections` as of `bundles_of`."""
    nodes = [sorted(set(nodes_of(part, sections))) for part in parts]
    return [pair for each in nodes for pair in combinations(each, 2)]


def nodes_of(part: BundlePart, sections: Sequence[tuple[int, int]]) -> list[int]:
    """Start nodes of a bundle's conductors, then their end nodes."""
    return [sections[s][end] for end in (0, 1) for s in part.sections]


def bundles_of(
    parts: Sequence[BundlePart],
    sections: Sequence[tuple[int, int]],
    place: Mapping[tuple[int, int], int],
    flat_pu: Floats,
    inner_ohm: Floats,
) -> Bundles:
    """Bundles from their parts.

    Parameters
    ----------
    parts : sequence of BundlePart
    sections : sequence of (int, int)
        Start and end node of each section of the network.
    place : mapping
        Place of the block of each two nodes.
    flat_pu, inner_ohm : Floats
        As in `Bundles`.
    """
    if not parts:
        return NO_BUNDLES
    count, widest = len(parts), max(len(part.sections) for part in parts)
    section = np.zeros((count, widest), dtype=np.int64)
    returns = np.full((count, widest), EARTH, dtype=np.int64)
    impedance, series, shunt = (np.zeros((count, widest, widest), dtype=complex) for _ in range(3))
    places = np.zeros((count, 2 * widest, 2 * widest), dtype=np.int64)
    for g, part in enumerate(parts):
        n, nodes = len(part.sections), nodes_of(part, sections)
        section[g, :n], returns[g, :n] = part.sections, part.returns
        impedance[g, :n, :n] = part.impedance_ohm_per_m
        series[g, :n, :n] = np.linalg.inv(part.impedance_ohm_per_m)
        shunt[g, :n, :n] = part.admittance_s_per_m
        places[g, : 2 * n, : 2 * n] = [[place[a, b] for b in nodes] for a in nodes]
    return Bundles(
        is_bundled=np.isin(np.arange(len(sections)), [s for part in parts for s in part.sections]),
        size=np.array([len(part.sections) for part in parts], dtype=np.int64),
        section=section,
        returns=returns,
        impedance_ohm_per_m=impedance,
        series_s_m=series,
        shunt_s_per_m=shunt,
        place=places,
        flat_pu=flat_pu,
        inner_ohm=inner_ohm,
    )


def without_dead_conductors(bundles: Bundles, dead: Flags) -> Bundles:
    """The bundles, of which conductors that no source reaches carry nothing, and nothing is induced.

    They are open somewhere.  What is left of their equations holds their voltage, which is 0.

    Parameters
    ----------
    dead : Flags, shape (sections,)
        Whether no source reaches a section.
    """
    if bundles == NO_BUNDLES:
        return bundles
    series = np.zeros_like(bundles.series_s_m)
    for g, n in enumerate(bundles.size.tolist()):
        impedance, off = bundles.impedance_ohm_per_m[g, :n, :n], dead[bundles.section[g, :n]]
        impedance = np.where(off[:, None] | off[None, :], 0.0, impedance) + np.diag(
            np.where(off, np.diag(impedance), 0.0)
        )
        series[g, :n, :n] = np.linalg.inv(impedance)
    return bundles._replace(series_s_m=series)


def new_bundle_flow(bundles: Bundles, n_trains: int) -> BundleFlow:
    """State of bundles before anything is known of them."""
    if bundles == NO_BUNDLES:
        return NO_BUNDLE_FLOW
    count, widest = bundles.section.shape

    def of_trains() -> Complexes:
        return np.zeros((n_trains, widest), dtype=complex)

    return BundleFlow(
        voltage_v=of_trains(),
        base_v=of_trains(),
        direction_v=of_trains(),
        good_v=of_trains(),
        passed_v=of_trains(),
        aside_v=of_trains(),
        last_v=of_trains(),
        before_v=of_trains(),
        known=np.zeros(n_trains, dtype=np.int64),
        is_under=np.zeros(n_trains, dtype=np.bool_),
        points=Point.blank(n_trains),
        first=np.zeros(count + 1, dtype=np.int64),
        closing_m=np.zeros(count),
        next=np.zeros(widest, dtype=np.int64),
        solved=np.zeros((n_trains, widest, 2 * widest + 1, 2), dtype=complex),
        rows=np.zeros((widest, 3 * widest + 1, 2), dtype=complex),
        ahead=np.zeros((2, widest, widest, 2), dtype=complex),
        rest_a=of_trains(),
        pair_s=np.zeros((n_trains, 2), dtype=complex),
        drop_v=np.zeros(widest, dtype=complex),
        lost_w=np.zeros(count),
    )
