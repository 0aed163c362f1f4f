"""Slow, obvious twins of the kernels: the definition, written down once more without a trick."""

import math
from collections.abc import Callable, Mapping
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from scipy.optimize import linprog

Array = npt.NDArray[np.float64]


def central_difference(function: Callable[[float], float], at: float, reach: float) -> float:
    """Slope of a function by its values on either side."""
    return (function(at + reach) - function(at - reach)) / (2.0 * reach)


def pair_by_differences(
    function: Callable[[complex], complex], at: complex, reach: float
) -> tuple[complex, complex]:
    """Derivatives over z and over its conjugate, by differences along both axes."""
    along, across = (
        (function(at + reach * unit) - function(at - reach * unit)) / (2.0 * reach)
        for unit in (1.0, 1j)
    )
    return (along - 1j * across) / 2.0, (along + 1j * across) / 2.0


def climb(position_m: float, way_m: float, from_m: Array, gradient: Array) -> float:
    """Altitude difference over a way: each stair's gradient times the part of the way on it."""
    begins = np.concatenate([[-math.inf], from_m[1:]])
    ends = np.concatenate([from_m[1:], [math.inf]])
    on_stair = np.minimum(ends, position_m + way_m) - np.maximum(begins, position_m)
    return float(gradient @ np.maximum(0.0, on_stair))


def exact_bridge_sine(motor_v: Array, locomotive_v: Array) -> Array:
    """The sin(arccos(...)) of two half-controlled bridges, [Boullanger2009]_, eq. (3.1)."""
    opening = math.pi * motor_v / (math.sqrt(2.0) * locomotive_v)  # 0 shut, 2 one open, 4 both open
    cosine = np.where(opening >= 2.0, opening - 3.0, opening - 1.0)
    return np.sin(np.arccos(np.minimum(1.0, cosine)))


def full_braking(speed: float, lowest: float, retardation: float, step_s: float) -> list[float]:
    """Speeds at the ends of steps, braking fully but never below standstill, until at `lowest`."""
    speeds = [speed]
    while speeds[-1] > lowest + 1e-9:
        speeds.append(max(0.0, speeds[-1] - retardation * step_s))
    return speeds


def positions(speeds: list[float], step_s: float) -> list[float]:
    """Positions at the ends of steps of constant acceleration, from 0."""
    places = [0.0]
    for before, after in pairwise(speeds):
        places.append(places[-1] + step_s * (before + after) / 2.0)
    return places


def way_of_full_braking(speed: float, lowest: float, retardation: float, step_s: float) -> float:
    """Way that full braking in whole steps takes until the train is at `lowest` or below."""
    return positions(full_braking(speed, lowest, retardation, step_s), step_s)[-1]


def least_remaining_distances(
    speed: float, distance: float, retardation: float, step_s: float, steps: int
) -> float | None:
    """Objective of the braking program, [Boullanger2009]_, eq. (2.26)-(2.33); None: infeasible.

    Unknowns are the acceleration of each step, and the speed and the remaining distance at the
    beginning and at the end of each; in units of the step and of the highest retardation.
    """
    speed, distance = speed / (retardation * step_s), distance / (retardation * step_s**2)
    a, v, dist = np.split(np.eye(3 * steps + 2), [steps, 2 * steps + 1])
    rows = [v[0], dist[0], v[steps], dist[steps]]
    values = [speed, distance, 0.0, 0.0]
    for t in range(steps):
        rows += [v[t + 1] - v[t] - a[t], dist[t + 1] - dist[t] + v[t] + a[t] / 2.0]
        values += [0.0, 0.0]
    bounds = [(-1.0, 0.0)] * steps + [(0.0, None)] * (steps + 1) + [(None, None)] * (steps + 1)
    result = linprog(
        dist.sum(axis=0), A_eq=np.array(rows), b_eq=values, bounds=bounds, method="highs"
    )
    return float(result.fun) * retardation * step_s**2 if result.status == 0 else None


def fastest_run(
    limit_m_s: Array, gradient: Array, piece_m: float, train: Mapping[str, float]
) -> tuple[float, float, Array]:
    """Running time [s], energy at the pantograph [J] and speeds [m/s] of the fastest run of a train.

    The line is cut into short pieces, each with a limit and a gradient.  First the limits are lowered
    so that the highest retardation suffices between them, from the end backwards; then the train
    takes the highest acceleration that force, power, comfort and these limits allow.

    Parameters
    ----------
    limit_m_s, gradient : Array, shape (n,)
        At the pieces' beginnings; the train stands at the end of the last piece.
    train : mapping
        ``mass_kg``, ``rotating`` (share of the mass), ``force_n``, ``power_w``, ``a``, ``b``, ``c`` of
        the running resistance, ``acceleration``, ``retardation``, ``efficiency``.
    """
    highest = np.append(np.minimum(limit_m_s, np.append(limit_m_s[1:], np.inf)) ** 2, 0.0)
    for i in range(limit_m_s.size - 1, -1, -1):
        highest[i] = min(highest[i], highest[i + 1] + 2.0 * train["retardation"] * piece_m)
    inertia = train["mass_kg"] * (1.0 + train["rotating"])
    squares, energy, time = np.zeros(highest.size), 0.0, 0.0
    for i in range(limit_m_s.size):
        v = max(math.sqrt(squares[i]), 1e-3)
        resistance = train["a"] + train["b"] * v + train["c"] * v * v
        resistance += train["mass_kg"] * 9.81 * gradient[i]
        force = min(train["force_n"], train["power_w"] / v)
        most = min(train["acceleration"], (force - resistance) / inertia)
        squares[i + 1] = min(squares[i] + 2.0 * most * piece_m, highest[i + 1])
        force = inertia * (squares[i + 1] - squares[i]) / (2.0 * piece_m) + resistance
        energy += max(0.0, force) * piece_m / train["efficiency"]
        time += 2.0 * piece_m / (math.sqrt(squares[i]) + math.sqrt(squares[i + 1]))
    return time, energy, np.sqrt(squares)
