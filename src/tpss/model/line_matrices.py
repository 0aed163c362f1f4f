r"""Matrices of the conductors of a stretch of line, from those of its catenary.

Conductors of tracks that are tied everywhere have one voltage, and their currents add up: with S, which
adds up those of each kind,

.. math:: Z = (S Z_a^{-1} S^T)^{-1}, \qquad Y = S Y_a S^T .

A catenary of one track says nothing of what two tracks have in common; then that is nothing.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.model.contact_line import Stretch
from tpss.scenario.supply import Catenary

Complexes = npt.NDArray[np.complex128]

CONTACT, RAILS, FEEDER = "contact", "rails", "feeder"
KINDS = (CONTACT, RAILS, FEEDER)
"""Kinds of conductors, in the order of those of a track."""


class Described(NamedTuple):
    """Conductors with their matrices, track by track; those of a track in the order of `KINDS`."""

    kinds: tuple[str, ...]
    tracks: tuple[int, ...]
    """Track of each, from 0."""
    impedance_ohm_per_m: Complexes
    admittance_s_per_m: Complexes


def matrices_of(stretch: Stretch, leakage_s_per_m: float) -> Described:
    """Conductors of a stretch: those of each of its tracks, or of all tracks that are tied together.

    Parameters
    ----------
    stretch : Stretch
    leakage_s_per_m : float
        Conductance between the rails of a track and the earth. [S/m]
    """
    own = _of_catenary(stretch.catenary)
    described = own if max(own.tracks) > 0 else _repeated(own, stretch.tracks)
    leaks = np.diag([leakage_s_per_m * (kind == RAILS) for kind in described.kinds])
    described = described._replace(admittance_s_per_m=described.admittance_s_per_m + leaks)
    return described if stretch.conductors == stretch.tracks else _tied(described)


def _of_catenary(catenary: Catenary) -> Described:
    """Conductors that a catenary describes."""
    if catenary.conductors is None:
        contact_ohm, rails_ohm = catenary.direct_conductors_ohm_per_km or (np.nan, np.nan)
        impedance = np.diag([contact_ohm / 1e3, rails_ohm / 1e3]).astype(complex)
        return Described((CONTACT, RAILS), (0, 0), impedance, np.zeros_like(impedance))
    given = catenary.conductors
    parts = [name.partition(" ") for name in given.names]
    order = sorted(range(len(parts)), key=lambda i: (parts[i][2], KINDS.index(parts[i][0])))
    chosen = np.ix_(order, order)
    return Described(
        tuple(parts[i][0] for i in order),
        tuple(int(parts[i][2] or 1) - 1 for i in order),
        given.impedance_ohm_per_m[chosen],
        given.susceptance_s_per_m[chosen],
    )


def _repeated(one: Described, tracks: int) -> Described:
    """Several tracks like one, which have nothing in common."""
    several = np.eye(tracks)
    return Described(
        one.kinds * tracks,
        tuple(track for track in range(tracks) for _ in one.kinds),
        np.asarray(np.kron(several, one.impedance_ohm_per_m), dtype=np.complex128),
        np.asarray(np.kron(several, one.admittance_s_per_m), dtype=np.complex128),
    )


def _tied(all_tracks: Described) -> Described:
    """The conductors of each kind as one."""
    kinds = tuple(kind for kind in KINDS if kind in all_tracks.kinds)
    sums = np.array([[float(each == kind) for each in all_tracks.kinds] for kind in kinds])
    inverse = sums @ np.linalg.inv(all_tracks.impedance_ohm_per_m) @ sums.T
    return Described(
        kinds,
        (0,) * len(kinds),
        np.linalg.inv(inverse),
        sums @ all_tracks.admittance_s_per_m @ sums.T,
    )
