"""What stands for a line as one conductor a track: kinds of equivalents, and when each is there."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tpss.conductors.formulas.equivalents import autotransformer_line, return_in_rails
from tpss.conductors.formulas.matrices import membership, of_groups
from tpss.conductors.formulas.vacuum import Complex, Real
from tpss.conductors.geometry import Conductor, Geometry

EARTHED, INSULATED, EARTH = "rails-earthed", "rails-insulated", "earth-return"
AUTOTRANSFORMERS, IN_CELL = "autotransformers", "autotransformers-in-cell"


@dataclass(frozen=True, eq=False)
class Equivalent:
    """Impedance of one conductor a track, its return included."""

    name: str
    meaning: str
    impedance: Complex
    """Of the tracks, and what two of them have in common. [Ω/m]"""

    @property
    def own(self) -> complex:
        """Of a track: the mean over all. [Ω/m]"""
        return complex(np.diag(self.impedance).mean())

    @property
    def mutual(self) -> complex | None:
        """What two tracks have in common: the mean over all pairs; None of a single track. [Ω/m]"""
        pairs = self.impedance[np.triu_indices(len(self.impedance), 1)]
        return complex(pairs.mean()) if pairs.size else None

    @property
    def spread(self) -> float:
        """Farthest that a track is from the mean, as a share of it. [1]"""
        return float(abs(np.diag(self.impedance) - self.own).max() / abs(self.own))


class Asked(NamedTuple):
    """A geometry, as makers of equivalents take it."""

    geometry: Geometry
    impedance: Complex
    """Of all conductors. [Ω/m]"""

    def by(self, number: Callable[[Conductor], int | None]) -> Complex:
        """Impedance of groups by a number for each conductor; -1: at earth, None: without current."""
        conductors = self.geometry.conductors
        numbers = {i: n for i, each in enumerate(conductors) if (n := number(each)) is not None}
        taken = list(numbers)
        part = self.impedance[np.ix_(taken, taken)]
        member = membership(list(numbers.values()))
        return np.asarray(np.linalg.inv(of_groups(part, member)), np.complex128)

    def contact(self, conductor: Conductor) -> int | None:
        """Number of a contact line and of what is connected to it; None of others."""
        if conductor.group not in ("contact", "positive"):
            return None
        return self.geometry.tracks.index(conductor.track)


def equivalents_of(
    geometry: Geometry, impedance: Complex, frequency_hz: float
) -> tuple[Equivalent, ...]:
    """All equivalents that a geometry has, in the order in which they are told."""
    asked = Asked(geometry, impedance)
    rails = geometry.has("rails")
    found: list[Equivalent] = []
    if not rails:
        found.append(_of_earth_return(asked))
    if rails and frequency_hz > 0.0:
        found.append(_of_earthed_rails(asked))
    if rails:
        found.append(_of_insulated_rails(asked))
    if rails and frequency_hz > 0.0 and with_autotransformers(geometry):
        found += _of_autotransformers(asked)
    return tuple(found)


def with_autotransformers(geometry: Geometry) -> bool:
    """Whether every track has a feeder beside its contact line."""
    return all(geometry.has("feeder", track) for track in geometry.tracks)


def _of_earth_return(asked: Asked) -> Equivalent:
    def number(each: Conductor) -> int | None:
        return -1 if each.group == "earth" else asked.contact(each)

    return Equivalent(EARTH, "return through the earth: there are no rails", asked.by(number))


def _of_earthed_rails(asked: Asked) -> Equivalent:
    def number(each: Conductor) -> int | None:
        return -1 if each.group in ("earth", "rails") else asked.contact(each)

    return Equivalent(EARTHED, "rails at the voltage of the earth", asked.by(number))


def _of_insulated_rails(asked: Asked) -> Equivalent:
    impedance = asked.by(lambda each: _with_rails(asked, each))
    return Equivalent(INSULATED, "all return in the rails", return_in_rails(impedance))


def _with_rails(asked: Asked, each: Conductor) -> int | None:
    """Number of a contact line, then that of all rails."""
    if each.group == "earth":
        return -1
    return len(asked.geometry.tracks) if each.group == "rails" else asked.contact(each)


def _of_autotransformers(asked: Asked) -> Sequence[Equivalent]:
    tracks = asked.geometry.tracks

    def number(each: Conductor) -> int | None:
        if each.group == "feeder":
            return len(tracks) + 1 + tracks.index(each.track)
        return _with_rails(asked, each)

    along, in_cell = autotransformer_line(asked.by(number), *_modes(len(tracks)))
    return (
        Equivalent(AUTOTRANSFORMERS, "autotransformers, along the line (zL)", along),
        Equivalent(IN_CELL, "autotransformers, in a train's cell (zs)", in_cell),
    )


def _modes(tracks: int) -> tuple[Real, Real]:
    """Currents of contact lines, rails and feeders: far from a train, and in its cell. [1]"""
    half, nothing = np.eye(tracks) / 2.0, np.zeros((1, tracks))
    return np.vstack([half, nothing, -half]), np.vstack([half, nothing - 1.0, half])
