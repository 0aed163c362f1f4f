"""Paths of solutions followed along their arc, past their turns: what a search may have missed.

The equations are those of `continuation`, which share nothing with `tpss.powerflow` but the trains'
demand and the sources' laws.  A share t is raised: that of the loads, or that by which the stations,
alike at t = 0, are what they are.  Beyond a turn t falls, and the path is followed all the same, so it
is known why it does not get to t = 1.
"""

import cmath
import math
from dataclasses import dataclass, replace
from enum import Enum
from typing import TYPE_CHECKING

import numpy as np

from tpss.kernel import plain
from tpss.record import copy_of_records
from tpss.sources.kinds import SourceKind, is_plausible, set_unloaded, unloaded

if TYPE_CHECKING:
    from continuation import Complexes, Equations, Floats

MOST_POINTS = 3000
FIRST_ARC, LONGEST_ARC, SHORTEST_ARC = 0.01, 0.1, 1e-9
LARGEST_CORRECTION, AT_A_KNEE = 0.3, 1e-4
"""How far a point may be from its prediction, of the arc; where a demand's slope jumps, of 1."""

MOST_ITERATIONS = 10
CREEPING, SPENT = 1e-6, 5e-3
"""A machine is at its end if arcs are shorter than the one, and less than the other is left of the
triangle of its load angle, without load 1: the slope of the angle is then hundreds of times as large,
and so is the rounding of a current. [1]"""

LOWEST, HIGHEST = 0.1, 3.0
"""Voltages at which a path is left alone. [p.u.]"""


class End(Enum):
    """Where a path has led."""

    WHOLE = "the whole of what it raises"
    BACK = "back to nothing of it, past a turn"
    FAR_OFF = "past a turn, to voltages far off"
    ASTRAY = "voltages far off, without a turn"
    OUT_OF_STEP = "a machine whose load angle has no triangle left"
    LOST = "no further, and why is not known"


@dataclass(frozen=True)
class Found:
    """The end of a path, and the voltages at it. [p.u.]"""

    end: End
    voltage: "Complexes | None" = None


class Homotopy:
    """A path over the share t of the loads.

    The direction of t along the arc is that of the determinant: it turns where the sign changes, be it
    smoothly or at the knee of a demand.
    """

    def __init__(self, equations: "Equations") -> None:
        self.equations = equations

    def at(self, t: float) -> "tuple[Equations, float]":
        """Equations and share of the loads."""
        return self.equations, t

    def residual(self, voltage: "Complexes", t: float) -> "Complexes":
        equations, share = self.at(t)
        return equations.residual(voltage, share)

    def slopes(self, voltage: "Complexes", t: float) -> "tuple[Floats, Floats]":
        """Jacobian over the voltages, and derivative over t by a difference."""
        equations, share = self.at(t)
        step = 1e-6
        by_t = self.residual(voltage, t + step) - self.residual(voltage, t - step)
        by_t = by_t / (2 * step)
        return equations.jacobian(voltage, share), np.concatenate([by_t.real, by_t.imag])

    def tangent(self, voltage: "Complexes", t: float) -> "tuple[Floats, float]":
        """Unit tangent towards growing arcs, and sign of the determinant.

        NaN where a law ends: types of one station that find no way to share a load.
        """
        jacobian, by_t = self.slopes(voltage, t)
        if not (np.isfinite(jacobian).all() and np.isfinite(by_t).all()):
            return np.full(by_t.size + 1, np.nan), math.nan
        sign = float(np.linalg.slogdet(jacobian)[0])
        found = np.append(-np.linalg.solve(jacobian, by_t), 1.0)
        return sign * found / np.linalg.norm(found), sign

    def correct(self, point: "Floats", tangent: "Floats") -> "Floats | None":
        """Newton's method in the plane across the tangent; None if it does not converge."""
        begun, whole = point, np.empty((point.size, point.size))
        for _ in range(MOST_ITERATIONS):
            voltage, t = split(point)
            with np.errstate(all="ignore"):
                left = self.residual(voltage, t)
            if not np.isfinite(left).all():
                return None
            across = tangent @ (point - begun)
            if np.abs(left).max() < self.equations.converged:
                return point
            jacobian, by_t = self.slopes(voltage, t)
            whole[:-1, :-1], whole[:-1, -1], whole[-1] = jacobian, by_t, tangent
            if not np.isfinite(whole).all():
                return None
            right = np.concatenate([left.real, left.imag, [across]])
            point = point - np.linalg.solve(whole, right)
        return None

    def follow(self, voltage: "Complexes") -> Found:
        """Follow the path from t = 0 to t = 1, or to where it ends."""
        point = np.concatenate([voltage.real, voltage.imag, [0.0]])
        tangent, begun = self.tangent(voltage, 0.0)
        if math.isnan(begun):
            return Found(End.LOST)
        tangent, arc, farthest = tangent * begun, FIRST_ARC, 0.0
        for _ in range(MOST_POINTS):
            found = self.correct(point + arc * tangent, tangent)
            off = np.inf if found is None else np.linalg.norm(found - point - arc * tangent)
            if found is None or off > max(LARGEST_CORRECTION * arc, AT_A_KNEE):
                arc /= 2.0
                if arc < CREEPING and self.is_spent(*split(point)):
                    return Found(End.OUT_OF_STEP)
                if arc < SHORTEST_ARC:
                    break
                continue
            voltage, t = split(found)
            if t >= 1.0:
                whole = self.at(1.0)[0].correct(voltage, self.at(1.0)[1])
                return Found(End.LOST if whole is None else End.WHOLE, whole)
            if t < 0.0:
                return Found(End.BACK)
            if np.abs(voltage).min() < LOWEST or np.abs(voltage).max() > HIGHEST:
                return Found(End.FAR_OFF if t < farthest else End.ASTRAY)
            tangent, _ = self.tangent(voltage, t)
            if not np.isfinite(tangent).all():
                break
            tangent, point, farthest = tangent * begun, found, max(farthest, t)
            arc = min(LONGEST_ARC, 1.5 * arc)
        return Found(End.LOST)

    def is_spent(self, voltage: "Complexes", t: float) -> bool:
        """Whether a machine is at the end of what its law admits."""
        return bool(triangles_left(self.at(t)[0], voltage).min(initial=1.0) < SPENT)


class SourceHomotopy(Homotopy):
    """The stations are brought apart from like ones, at a share of the loads."""

    def __init__(self, equations: "Equations", share: float) -> None:
        super().__init__(equations)
        self.share = share

    def at(self, t: float) -> "tuple[Equations, float]":
        return apart(self.equations, t), self.share


def split(point: "Floats") -> "tuple[Complexes, float]":
    """Voltages and parameter of a point."""
    half = point.size // 2
    return point[:half] + 1j * point[half:-1], float(point[-1])


def mean_phasor(equations: "Equations") -> complex:
    """Voltage of the mean station without load. [V]"""
    polar = [plain(unloaded)(source) for source in equations.network.sources]
    angle = cmath.phase(sum(cmath.rect(1.0, angle) for _, angle in polar))
    return cmath.rect(sum(magnitude_v for magnitude_v, _ in polar) / len(polar), angle)


def apart(equations: "Equations", t: float) -> "Equations":
    """Equations whose stations differ from the mean one by a share t of what they do."""
    mean_v, mean_angle = cmath.polar(mean_phasor(equations))
    sources = copy_of_records(equations.network.sources)
    for source in sources:
        magnitude_v, angle = plain(unloaded)(source)
        off = (angle - mean_angle + np.pi) % (2.0 * np.pi) - np.pi
        magnitude_v = mean_v + t * (magnitude_v - mean_v)
        plain(set_unloaded)(magnitude_v, mean_angle + t * off, source)
    return replace(equations, network=equations.network._replace(sources=sources))


def alike_without_load(equations: "Equations") -> "Complexes | None":
    """State of like stations without load."""
    begin = np.full(equations.buses, mean_phasor(equations) / equations.system.base_voltage_v)
    return apart(equations, 0.0).correct(begin, 0.0)


def loads_last(equations: "Equations") -> Found:
    """The stations are brought apart without load, then the loads are raised.

    Where that path ends, the state without load may still be the one next to base voltage.
    """
    alike = alike_without_load(equations)
    brought = Found(End.LOST)
    if alike is not None:
        brought = SourceHomotopy(equations, 0.0).follow(alike)
    state = brought.voltage
    if state is None:
        state = equations.correct(np.ones(equations.buses, dtype=complex), 0.0)
    return brought if state is None else Homotopy(equations).follow(state)


def sources_last(equations: "Equations") -> Found:
    """The loads are raised while the stations are alike, then these are brought apart."""
    alike = alike_without_load(equations)
    if alike is None:
        return Found(End.LOST)
    loaded = Homotopy(apart(equations, 0.0)).follow(alike)
    if loaded.voltage is None:
        return loaded
    return SourceHomotopy(equations, 1.0).follow(loaded.voltage)


def is_sound(equations: "Equations", voltage: "Complexes") -> bool:
    """Whether a state with the whole load is within the band, stable, and all machines in step."""
    size_v = np.abs(voltage) * equations.system.base_voltage_v
    low_v, high_v = equations.system.lowest_voltage_v, equations.system.highest_voltage_v
    if size_v.min() < low_v or size_v.max() > high_v or not are_in_step(equations, voltage):
        return False
    return bool(np.linalg.slogdet(equations.jacobian(voltage, 1.0))[0] == stable_sign(equations))


def stable_sign(equations: "Equations") -> float:
    """Sign of the determinant where like stations are without load, which the stable branch keeps."""
    begin = np.full(equations.buses, mean_phasor(equations) / equations.system.base_voltage_v)
    state = alike_without_load(equations)
    # Elsewhere, even at base voltage, the sign may be another one: machines have reactances.
    return float(
        np.linalg.slogdet(apart(equations, 0.0).jacobian(begin if state is None else state, 0.0))[0]
    )


def are_in_step(equations: "Equations", voltage: "Complexes") -> bool:
    """Whether no machine's load angle is beyond 90 degrees, nor its voltage turned."""
    own_v, _, along = sides(equations, voltage)
    return bool((own_v > 0.0).all() and (along > 0.0).all()) and others_are_in_step(
        equations, voltage
    )


def others_are_in_step(equations: "Equations", voltage: "Complexes") -> bool:
    """The same of stations with a law of another kind, as that says it."""
    sources, base_v = equations.network.sources, equations.system.base_voltage_v
    fed = equations.admittance @ voltage * equations.system.base_power_va / base_v
    return all(
        plain(is_plausible)(base_v * voltage[source.node], fed[source.node], units.running, source)
        for source, units in zip(sources, equations.running, strict=True)
        if source.kind != SourceKind.CONVERTER
    )


def triangles_left(equations: "Equations", voltage: "Complexes") -> "Floats":
    """Size of each machine's triangle of the load angle, to that without load. [1]"""
    own_v, across, along = sides(equations, voltage)
    return np.asarray(np.hypot(across, along) / own_v**2)


def sides(equations: "Equations", voltage: "Complexes") -> "tuple[Floats, Floats, Floats]":
    """Of all machines, their voltage [V] and the sides X P and U² + X Q of the triangle [V²]."""
    sources = equations.network.sources
    fed_va = voltage * np.conj(equations.admittance @ voltage) * equations.system.base_power_va
    share_va = fed_va[sources.node] / equations.running.running
    law, machines = sources.converter, sources.kind == SourceKind.CONVERTER
    own_v = law.no_load_voltage_v - law.droop_v_per_var * share_va.imag
    across = law.generator_reactance_ohm * share_va.real
    along = own_v**2 + law.generator_reactance_ohm * share_va.imag
    return own_v[machines], across[machines], along[machines]
